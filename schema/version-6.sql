-- From version 5 of the tables to version 6: files that realisations leave beside their results.

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
