-- From version 1 of the tables to version 2: priorities, cancelled points,
-- seeds in the hands of a batch system, and what the looks need to see a transient or a skewed population.

ALTER TABLE point ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;
ALTER TABLE point ADD COLUMN cancelled INTEGER NOT NULL DEFAULT 0 CHECK (cancelled IN (0, 1));

ALTER TABLE realisation ADD COLUMN first_quarter REAL;
ALTER TABLE realisation ADD COLUMN first_half REAL;

ALTER TABLE look ADD COLUMN skewness REAL;
ALTER TABLE look ADD COLUMN transient INTEGER NOT NULL DEFAULT 0 CHECK (transient IN (0, 1));

CREATE TABLE bundle (
  bundle_id    INTEGER PRIMARY KEY,
  name         TEXT    NOT NULL UNIQUE,
  shared       TEXT    NOT NULL,
  tasks        INTEGER NOT NULL,
  job          TEXT,
  made_at      TEXT    NOT NULL,
  submitted_at TEXT,
  closed_at    TEXT
) STRICT;

CREATE TABLE bundle_seed (
  bundle_id INTEGER NOT NULL REFERENCES bundle,
  place     INTEGER NOT NULL,
  task      INTEGER NOT NULL,
  point_id  INTEGER NOT NULL,
  seed      INTEGER NOT NULL,
  outcome   TEXT,
  PRIMARY KEY (bundle_id, place),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

CREATE UNIQUE INDEX handed_over_once ON bundle_seed (point_id, seed) WHERE outcome IS NULL;

PRAGMA user_version = 2;
