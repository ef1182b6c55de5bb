-- From version 3 of the tables to version 4: the texts of results are deflated. Those that are there stay as they are.
--
-- SQLite cannot change the type of a column: the table of results is made again. Requires foreign keys to be off and
-- the views, which name the table, to be gone.

CREATE TABLE dictionary (
  point_id INTEGER PRIMARY KEY REFERENCES point,
  text     TEXT NOT NULL CHECK (json_valid(text))
) STRICT;

CREATE TABLE new_result (
  point_id INTEGER NOT NULL,
  seed     INTEGER NOT NULL,
  document ANY     NOT NULL CHECK (typeof(document) = 'blob' OR json_valid(document)),
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;
INSERT INTO new_result (point_id, seed, document) SELECT point_id, seed, document FROM result;
DROP TABLE result;
ALTER TABLE new_result RENAME TO result;

PRAGMA user_version = 4;
