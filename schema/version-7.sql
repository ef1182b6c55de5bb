-- From version 6 of the tables to version 7: the few numbers of each result stand beside it, so that the means of every
-- quantity are made without inflating results. The program takes them from the results that are there.

CREATE TABLE number_layout (
  layout_id  INTEGER PRIMARY KEY,
  quantities TEXT NOT NULL UNIQUE CHECK (json_valid(quantities))
) STRICT;

CREATE TABLE numbers (
  point_id  INTEGER NOT NULL,
  seed      INTEGER NOT NULL,
  layout_id INTEGER NOT NULL REFERENCES number_layout,
  numbers   BLOB    NOT NULL,
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

-- What the engine that ran last calls the keys of scenes and the numbers that follow from them: one row at most.
CREATE TABLE vocabulary (
  document TEXT NOT NULL CHECK (json_valid(document))
) STRICT;

PRAGMA user_version = 7;
