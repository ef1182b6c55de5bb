-- The database of one campaign; its views are in views.sql. Only the process that holds campaign.lock writes it; others
-- open it read-only. schema/README.md explains the tables and views to pandas users. Programs refuse a database of
-- another version: a changed table needs a new user_version.
--
-- Columns ending in _at are wall-clock times in UTC for people; no decision depends on them.

PRAGMA application_id = 1346587724;  -- "PCLL" as a big-endian integer
PRAGMA user_version = 1;

-- Targets of verdicts. Old targets stay, with their stop tests.
CREATE TABLE target (
  target_id          INTEGER PRIMARY KEY,
  observable         TEXT    NOT NULL,
  criterion          TEXT    NOT NULL CHECK (json_valid(criterion)),  -- {"relative_tolerance":0.05}
  confidence         REAL    NOT NULL,
  minimum            INTEGER NOT NULL,
  maximum            INTEGER NOT NULL,
  UNIQUE (observable, criterion, confidence, minimum, maximum)
) STRICT;

-- The campaign as last run: exactly one row.
CREATE TABLE campaign (
  campaign_id INTEGER PRIMARY KEY CHECK (campaign_id = 1),
  name        TEXT    NOT NULL,
  document    TEXT    NOT NULL CHECK (json_valid(document)),
  target_id   INTEGER NOT NULL REFERENCES target,
  created_at  TEXT    NOT NULL,
  updated_at  TEXT    NOT NULL
) STRICT;

-- Engines of results. Two rows of equal identity differ in the machine only.
CREATE TABLE engine (
  engine_id  INTEGER PRIMARY KEY,
  identity   TEXT    NOT NULL,         -- version, binary hash and instruction set
  provenance TEXT    NOT NULL UNIQUE CHECK (json_valid(provenance))
) STRICT;

-- Titles, symbols and units of scene keys and derived numbers, from the engine that ran last: one row at most.
CREATE TABLE vocabulary (
  document TEXT NOT NULL CHECK (json_valid(document))
) STRICT;

CREATE TABLE point (
  point_id        INTEGER PRIMARY KEY,
  hash            TEXT    NOT NULL,         -- SHA-256 of the canonical scene
  scene           TEXT    NOT NULL CHECK (json_valid(scene)),
  settings        TEXT    NOT NULL CHECK (json_valid(settings)),
  label           TEXT    NOT NULL,
  place           INTEGER UNIQUE,           -- in the sweep; NULL if the sweep no longer contains the point
  engine_identity TEXT,                     -- of the first result, or accepted by name; all results must share it
  suspect         INTEGER NOT NULL DEFAULT 0 CHECK (suspect IN (0, 1)),  -- a seed gave two different results
  priority        INTEGER NOT NULL DEFAULT 0,  -- points of higher priority are served first
  cancelled       INTEGER NOT NULL DEFAULT 0 CHECK (cancelled IN (0, 1)),  -- gets no more seeds
  -- 1: holds the results of an engine that was replaced by name. The row with 0 is the present point of the scene.
  set_aside       INTEGER NOT NULL DEFAULT 0 CHECK (set_aside IN (0, 1)),
  UNIQUE (hash, engine_identity),
  CHECK (set_aside = 0 OR (place IS NULL AND engine_identity IS NOT NULL))
) STRICT;

CREATE UNIQUE INDEX point_by_hash ON point (hash) WHERE set_aside = 0;

-- One seed of one point: its state, its course and its cost; measured numbers are in other tables.
CREATE TABLE realisation (
  point_id                 INTEGER NOT NULL REFERENCES point,
  seed                     INTEGER NOT NULL CHECK (seed >= 0 AND seed < 1000000),  -- /realisations/maximum at most
  state                    TEXT    NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'quarantined')),
  cause                    TEXT,     -- cause of the ending (completed, overlap, ...), or why it is quarantined
  timestep                 REAL,
  equilibration_steps      INTEGER,
  production_steps         INTEGER,
  production_strain        REAL,
  statistical_inefficiency REAL,
  largest_overlap          REAL,
  cpu_seconds              REAL,
  wall_seconds             REAL,
  final_state_sha256       TEXT,
  content_sha256           TEXT,     -- hash of the canonical result without its cost; equal for repetitions
  engine_id                INTEGER REFERENCES engine,
  PRIMARY KEY (point_id, seed),
  CHECK ((state IN ('done', 'failed')) = (content_sha256 IS NOT NULL)),
  CHECK ((state IN ('done', 'failed', 'quarantined')) = (cause IS NOT NULL))
) STRICT, WITHOUT ROWID;

CREATE INDEX realisation_by_state ON realisation (state, point_id);

-- Preset dictionary of a point: its first completed result, against which its results are deflated. It never changes.
CREATE TABLE dictionary (
  point_id INTEGER PRIMARY KEY REFERENCES point,
  text     TEXT NOT NULL CHECK (json_valid(text))
) STRICT;

-- The whole result as the engine wrote it, without white space between its parts, deflated (zlib). If the stream asks
-- for a dictionary, it is the point's.
CREATE TABLE result (
  point_id INTEGER NOT NULL,
  seed     INTEGER NOT NULL,
  document BLOB    NOT NULL,
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;

-- Contents and order of the arrays in table `numbers`: {"observables": ["relative_viscosity"], "quantities": {...}}.
-- First come four numbers for each observable of the target, the leading one first: value, control variate of mean
-- zero, value + control over the first quarter of the window, and over its first half. Then come the other quantities
-- up to the size of a tensor, sorted by name and described as in "quantities" of results: for a mean its elements, then
-- those of its control variate of mean zero; for a ratio its numerators, then its denominators.
CREATE TABLE number_layout (
  layout_id INTEGER PRIMARY KEY,
  layout    TEXT NOT NULL UNIQUE CHECK (json_valid(layout))
) STRICT;

-- Numbers of each completed result as a JSON array, with null for undefined ones: stop tests, and the means of a point, need
-- no result to be inflated.
CREATE TABLE numbers (
  point_id  INTEGER NOT NULL,
  seed      INTEGER NOT NULL,
  layout_id INTEGER NOT NULL REFERENCES number_layout,
  numbers   TEXT    NOT NULL CHECK (json_valid(numbers)),
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

-- Files beside the result of a realisation, from the same engine. Kept files are in files/, in the folder of point and
-- seed; the others were removed, as the campaign asks.
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

-- Attempts: one row for every time a worker was given a seed. A blamed attempt counts against its seed unless pardoned.
CREATE TABLE attempt (
  attempt_id  INTEGER PRIMARY KEY,
  point_id    INTEGER NOT NULL,
  seed        INTEGER NOT NULL,
  worker      INTEGER NOT NULL,
  process     INTEGER NOT NULL,
  host        TEXT    NOT NULL,
  engine_id   INTEGER NOT NULL REFERENCES engine,
  started_at  TEXT    NOT NULL,
  ended_at    TEXT,
  outcome     TEXT    NOT NULL DEFAULT 'running' CHECK (outcome IN
                ('running', 'result', 'crashed', 'hung', 'garbled', 'refused', 'drained', 'killed', 'abandoned')),
  blamed      INTEGER NOT NULL DEFAULT 0 CHECK (blamed IN (0, 1)),
  step        INTEGER NOT NULL DEFAULT 0,  -- last step reported
  exit_status INTEGER,
  signal      INTEGER,
  message     TEXT,
  pardoned    INTEGER NOT NULL DEFAULT 0 CHECK (pardoned IN (0, 1)),  -- before the seed was retried
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;

CREATE INDEX attempt_by_seed ON attempt (point_id, seed);

-- Leases of running seeds: worker and progress, renewed every few seconds.
CREATE TABLE lease (
  point_id   INTEGER NOT NULL,
  seed       INTEGER NOT NULL,
  attempt_id INTEGER NOT NULL REFERENCES attempt,
  worker     INTEGER NOT NULL,
  phase      TEXT    NOT NULL,
  step       INTEGER NOT NULL,
  steps      INTEGER NOT NULL,  -- total, as estimated by the engine
  strain     REAL    NOT NULL,
  renewed_at TEXT    NOT NULL,
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

-- Stop tests: statistics of the first `seeds` seeds, all of which have ended. NULL: not defined for this
-- number of values.
CREATE TABLE stop_test (
  point_id                    INTEGER NOT NULL REFERENCES point,
  target_id                   INTEGER NOT NULL REFERENCES target,
  seeds                       INTEGER NOT NULL,
  lost                        INTEGER NOT NULL,
  count                       INTEGER NOT NULL,
  mean                        REAL,     -- of value + control, the estimate that decides
  standard_error              REAL,
  half_width                  REAL,
  plain_mean                  REAL,     -- of the values alone
  plain_standard_error        REAL,
  plain_half_width            REAL,
  verdict                     TEXT    NOT NULL CHECK (verdict IN ('more', 'converged', 'converged-with-losses',
                                'capped', 'failed', 'complete', 'complete-with-losses')),
  made_at                     TEXT    NOT NULL,
  skewness                    REAL,     -- of value + control
  transient                   INTEGER NOT NULL DEFAULT 0 CHECK (transient IN (0, 1)),  -- the window begins too early
  observables                 TEXT CHECK (observables IS NULL OR json_valid(observables)),  -- one by one, if several
  PRIMARY KEY (point_id, target_id, seeds)
) STRICT, WITHOUT ROWID;

-- Predictions from the first seeds of a point, for one target.
CREATE TABLE prediction (
  point_id    INTEGER NOT NULL REFERENCES point,
  target_id   INTEGER NOT NULL REFERENCES target,
  made_at     TEXT    NOT NULL,
  pilot       INTEGER NOT NULL,  -- number of seeds used
  seeds       INTEGER NOT NULL,  -- expected seeds of the deciding stop test
  lower       INTEGER NOT NULL,  -- 95 % interval of these seeds
  upper       INTEGER NOT NULL,
  cpu_seconds REAL    NOT NULL,  -- of one seed
  PRIMARY KEY (point_id, target_id)
) STRICT, WITHOUT ROWID;

-- Events for people.
CREATE TABLE event (
  event_id INTEGER PRIMARY KEY,
  at       TEXT    NOT NULL,
  kind     TEXT    NOT NULL,
  point_id INTEGER REFERENCES point,
  seed     INTEGER,
  message  TEXT    NOT NULL,
  request  TEXT               -- the request that caused it, so that it is carried out once; NULL: no request
) STRICT;

CREATE UNIQUE INDEX event_by_request ON event (request) WHERE request IS NOT NULL;

-- Bundles of seeds handed over to a batch system (Slurm ...). A bundle is one job array; its name is the job's.
CREATE TABLE bundle (
  bundle_id    INTEGER PRIMARY KEY,
  name         TEXT    NOT NULL UNIQUE,
  shared       TEXT    NOT NULL,  -- the folder that owner and nodes see
  tasks        INTEGER NOT NULL,
  job          TEXT,              -- the batch system's number; NULL until it has confirmed the submission
  made_at      TEXT    NOT NULL,
  submitted_at TEXT,
  closed_at    TEXT               -- when all seeds and tasks had ended
) STRICT;

-- Seeds of bundles. A seed without an outcome is handed over: it is queued, but only the bundle may run it.
CREATE TABLE bundle_seed (
  bundle_id INTEGER NOT NULL REFERENCES bundle,
  place     INTEGER NOT NULL,  -- position in the manifest
  task      INTEGER NOT NULL,
  point_id  INTEGER NOT NULL,
  seed      INTEGER NOT NULL,
  outcome   TEXT,              -- outcome of its attempt, or "returned": its task ended without it
  PRIMARY KEY (bundle_id, place),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

CREATE UNIQUE INDEX handed_over_once ON bundle_seed (point_id, seed) WHERE outcome IS NULL;
