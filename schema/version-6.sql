-- From version 5 of the tables to version 6: how narrow intervals must be is a document, there is room for what is
-- known of a target's observables beside the leading one, and for files that realisations leave beside their results.
--
-- SQLite cannot change a UNIQUE: the table is made again. Requires foreign keys to be off and the views, which name it,
-- to be gone. Where a program between two releases wrote the document already, it is in the column of the number.

CREATE TABLE new_target (
  target_id          INTEGER PRIMARY KEY,
  observable         TEXT    NOT NULL,
  criterion          TEXT    NOT NULL CHECK (json_valid(criterion)),
  confidence         REAL    NOT NULL,
  minimum            INTEGER NOT NULL,
  maximum            INTEGER NOT NULL,
  rule               INTEGER NOT NULL,
  UNIQUE (observable, criterion, confidence, minimum, maximum, rule)
) STRICT;
INSERT INTO new_target (target_id, observable, criterion, confidence, minimum, maximum, rule)
SELECT target_id, observable,
       CASE typeof(relative_tolerance) WHEN 'text' THEN relative_tolerance
                                       ELSE json_object('relative_tolerance', relative_tolerance) END,
       confidence, minimum, maximum, rule
FROM target;
DROP TABLE target;
ALTER TABLE new_target RENAME TO target;

ALTER TABLE realisation ADD COLUMN further TEXT CHECK (further IS NULL OR json_valid(further));
ALTER TABLE look ADD COLUMN observables TEXT CHECK (observables IS NULL OR json_valid(observables));

CREATE TABLE file (
  point_id INTEGER NOT NULL,
  seed     INTEGER NOT NULL,
  name     TEXT    NOT NULL,
  bytes    INTEGER NOT NULL,
  sha256   TEXT    NOT NULL,
  kept     INTEGER NOT NULL CHECK (kept IN (0, 1)),
  PRIMARY KEY (point_id, seed, name),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

PRAGMA user_version = 6;
