-- From version 4 of the tables to version 5: the rule by which looks decide is part of the target, there is a verdict
-- for points that the maximum is too near to, and the numbers without the control variate have names that say so.
--
-- SQLite cannot change a CHECK or a UNIQUE: both tables are made again. Requires foreign keys to be off and the views,
-- which name them, to be gone.

CREATE TABLE new_target (
  target_id          INTEGER PRIMARY KEY,
  observable         TEXT    NOT NULL,
  relative_tolerance REAL    NOT NULL,
  confidence         REAL    NOT NULL,
  minimum            INTEGER NOT NULL,
  maximum            INTEGER NOT NULL,
  rule               INTEGER NOT NULL,
  UNIQUE (observable, relative_tolerance, confidence, minimum, maximum, rule)
) STRICT;
INSERT INTO new_target (target_id, observable, relative_tolerance, confidence, minimum, maximum, rule)
SELECT target_id, observable, relative_tolerance, confidence, minimum, maximum, 1 FROM target;
DROP TABLE target;
ALTER TABLE new_target RENAME TO target;

CREATE TABLE new_look (
  point_id                    INTEGER NOT NULL REFERENCES point,
  target_id                   INTEGER NOT NULL REFERENCES target,
  seeds                       INTEGER NOT NULL,
  lost                        INTEGER NOT NULL,
  count                       INTEGER NOT NULL,
  mean                        REAL,
  standard_error              REAL,
  half_width                  REAL,
  uncontrolled_mean           REAL,
  uncontrolled_standard_error REAL,
  uncontrolled_half_width     REAL,
  verdict                     TEXT    NOT NULL CHECK (verdict IN ('more', 'converged', 'converged-with-losses',
                                'converged-near-maximum', 'capped', 'failed', 'complete', 'complete-with-losses')),
  made_at                     TEXT    NOT NULL,
  skewness                    REAL,
  transient                   INTEGER NOT NULL DEFAULT 0 CHECK (transient IN (0, 1)),
  PRIMARY KEY (point_id, target_id, seeds)
) STRICT, WITHOUT ROWID;
INSERT INTO new_look (point_id, target_id, seeds, lost, count, mean, standard_error, half_width, uncontrolled_mean,
                      uncontrolled_standard_error, uncontrolled_half_width, verdict, made_at, skewness, transient)
SELECT point_id, target_id, seeds, lost, count, controlled_mean, controlled_standard_error, controlled_half_width, mean,
       standard_error, half_width, verdict, made_at, skewness, transient FROM look;
DROP TABLE look;
ALTER TABLE new_look RENAME TO look;

PRAGMA user_version = 5;
