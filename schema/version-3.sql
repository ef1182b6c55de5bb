-- From version 2 of the tables to version 3: which request caused an event, attempts that no longer count against
-- their seed, results of another engine kept apart, and what is expected of a point.
--
-- SQLite cannot take a UNIQUE from a column: the table of points is made again. Requires foreign keys to be off and
-- the views, which name the table, to be gone.

ALTER TABLE event ADD COLUMN request TEXT;
CREATE UNIQUE INDEX event_by_request ON event (request) WHERE request IS NOT NULL;

ALTER TABLE attempt ADD COLUMN pardoned INTEGER NOT NULL DEFAULT 0 CHECK (pardoned IN (0, 1));

CREATE TABLE new_point (
  point_id        INTEGER PRIMARY KEY,
  hash            TEXT    NOT NULL,
  scene           TEXT    NOT NULL CHECK (json_valid(scene)),
  settings        TEXT    NOT NULL CHECK (json_valid(settings)),
  label           TEXT    NOT NULL,
  place           INTEGER UNIQUE,
  engine_identity TEXT,
  suspect         INTEGER NOT NULL DEFAULT 0 CHECK (suspect IN (0, 1)),
  priority        INTEGER NOT NULL DEFAULT 0,
  cancelled       INTEGER NOT NULL DEFAULT 0 CHECK (cancelled IN (0, 1)),
  kept_apart      INTEGER NOT NULL DEFAULT 0 CHECK (kept_apart IN (0, 1)),
  UNIQUE (hash, engine_identity),
  CHECK (kept_apart = 0 OR (place IS NULL AND engine_identity IS NOT NULL))
) STRICT;
INSERT INTO new_point (point_id, hash, scene, settings, label, place, engine_identity, suspect, priority, cancelled)
SELECT point_id, hash, scene, settings, label, place, engine_identity, suspect, priority, cancelled FROM point;
DROP TABLE point;
ALTER TABLE new_point RENAME TO point;
CREATE UNIQUE INDEX point_by_hash ON point (hash) WHERE kept_apart = 0;

CREATE TABLE prediction (
  point_id    INTEGER NOT NULL REFERENCES point,
  target_id   INTEGER NOT NULL REFERENCES target,
  made_at     TEXT    NOT NULL,
  pilot       INTEGER NOT NULL,
  seeds       INTEGER NOT NULL,
  lower       INTEGER NOT NULL,
  upper       INTEGER NOT NULL,
  cpu_seconds REAL    NOT NULL,
  PRIMARY KEY (point_id, target_id)
) STRICT, WITHOUT ROWID;

PRAGMA user_version = 3;
