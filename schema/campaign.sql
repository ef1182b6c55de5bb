-- The database of one campaign; its views are in views.sql. One process writes it (the one that holds
-- campaign.lock); everybody else opens it read-only. schema/README.md explains the tables and views to pandas
-- users. A program refuses a database of another version: changed tables need another number.
--
-- Times ending in _at are wall-clock times in UTC, for people to look at: no decision is made from them.

PRAGMA application_id = 1346587724;  -- "PCLL" as a big-endian integer
PRAGMA user_version = 1;

-- What a verdict was reached for. Old targets stay, with the stop tests that were made for them.
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

-- Where results come from, stored once. Two rows of equal identity differ in the machine only.
CREATE TABLE engine (
  engine_id  INTEGER PRIMARY KEY,
  identity   TEXT    NOT NULL,         -- version, binary hash and instruction set
  provenance TEXT    NOT NULL UNIQUE CHECK (json_valid(provenance))
) STRICT;

-- What the engine that ran last calls the keys of scenes and the numbers that follow from them: one row at most.
CREATE TABLE vocabulary (
  document TEXT NOT NULL CHECK (json_valid(document))
) STRICT;

CREATE TABLE point (
  point_id        INTEGER PRIMARY KEY,
  hash            TEXT    NOT NULL,         -- SHA-256 of the canonical scene
  scene           TEXT    NOT NULL CHECK (json_valid(scene)),
  settings        TEXT    NOT NULL CHECK (json_valid(settings)),
  label           TEXT    NOT NULL,
  place           INTEGER UNIQUE,           -- in the sweep; NULL when the sweep no longer contains the point
  engine_identity TEXT,                     -- of its first result, or accepted by name; every result must have the same
  suspect         INTEGER NOT NULL DEFAULT 0 CHECK (suspect IN (0, 1)),  -- a seed gave two different results
  priority        INTEGER NOT NULL DEFAULT 0,  -- points of a higher one are served first
  cancelled       INTEGER NOT NULL DEFAULT 0 CHECK (cancelled IN (0, 1)),  -- gets no more seeds
  -- Results of an engine that another one has replaced by name; the scene's own row is the one of 0.
  set_aside      INTEGER NOT NULL DEFAULT 0 CHECK (set_aside IN (0, 1)),
  UNIQUE (hash, engine_identity),
  CHECK (set_aside = 0 OR (place IS NULL AND engine_identity IS NOT NULL))
) STRICT;

CREATE UNIQUE INDEX point_by_hash ON point (hash) WHERE set_aside = 0;

-- One seed at one point: its state, and what belongs to it apart from the numbers that it has measured.
CREATE TABLE realisation (
  point_id                 INTEGER NOT NULL REFERENCES point,
  seed                     INTEGER NOT NULL CHECK (seed >= 0 AND seed < 1000000),  -- /realisations/maximum at most
  state                    TEXT    NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'quarantined')),
  cause                    TEXT,     -- of its ending: completed, overlap, ..., or why it is quarantined
  timestep                 REAL,
  equilibration_steps      INTEGER,
  production_steps         INTEGER,
  production_strain        REAL,
  statistical_inefficiency REAL,
  largest_overlap          REAL,
  cpu_seconds              REAL,
  wall_seconds             REAL,
  final_state_sha256       TEXT,
  content_sha256           TEXT,     -- of the canonical result without its cost: what repetitions must share
  engine_id                INTEGER REFERENCES engine,
  PRIMARY KEY (point_id, seed),
  CHECK ((state IN ('done', 'failed')) = (content_sha256 IS NOT NULL)),
  CHECK ((state IN ('done', 'failed', 'quarantined')) = (cause IS NOT NULL))
) STRICT, WITHOUT ROWID;

CREATE INDEX realisation_by_state ON realisation (state, point_id);

-- The result of the first realisation of a point that completed, against which all results of the point are deflated.
-- It stays for good.
CREATE TABLE dictionary (
  point_id INTEGER PRIMARY KEY REFERENCES point,
  text     TEXT NOT NULL CHECK (json_valid(text))
) STRICT;

-- The whole result as the engine wrote it, without the white space between its parts: deflated (zlib) with the point's
-- dictionary, if the stream asks for one.
CREATE TABLE result (
  point_id INTEGER NOT NULL,
  seed     INTEGER NOT NULL,
  document BLOB    NOT NULL,
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;

-- Which numbers of results are in the table `numbers`, and in which order: {"observables": ["relative_viscosity"],
-- "quantities": {...}}. First stand four numbers for each of the target's observables, the leading one first: value,
-- control variate of mean zero, value + control over the first quarter of the window and over its first half. Then come
-- the other quantities that are no larger than a tensor, described as results describe their "quantities", in the order
-- of their names: of a mean its elements, then those of its control variate of mean zero; of a ratio its numerators,
-- then its denominators. A quantity that is one of the observables is not repeated.
CREATE TABLE number_layout (
  layout_id INTEGER PRIMARY KEY,
  layout    TEXT NOT NULL UNIQUE CHECK (json_valid(layout))
) STRICT;

-- The numbers of each completed result as a JSON array, null for what does not exist. So looks, and the means of a
-- point, are made without inflating results.
CREATE TABLE numbers (
  point_id  INTEGER NOT NULL,
  seed      INTEGER NOT NULL,
  layout_id INTEGER NOT NULL REFERENCES number_layout,
  numbers   TEXT    NOT NULL CHECK (json_valid(numbers)),
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

-- A file that a realisation left beside its result. Kept ones are in files/, in the folder of point and seed; others
-- were thrown away as the campaign asked for. Their engine is that of the realisation.
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

-- Every time a worker was given a seed. blamed: counts against the seed, unless it was pardoned since.
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
  step        INTEGER NOT NULL DEFAULT 0,  -- the last one it reported
  exit_status INTEGER,
  signal      INTEGER,
  message     TEXT,
  pardoned    INTEGER NOT NULL DEFAULT 0 CHECK (pardoned IN (0, 1)),  -- before the seed was retried
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;

CREATE INDEX attempt_by_seed ON attempt (point_id, seed);

-- Who runs a seed now and how far it is; refreshed every few seconds.
CREATE TABLE lease (
  point_id   INTEGER NOT NULL,
  seed       INTEGER NOT NULL,
  attempt_id INTEGER NOT NULL REFERENCES attempt,
  worker     INTEGER NOT NULL,
  phase      TEXT    NOT NULL,
  step       INTEGER NOT NULL,
  steps      INTEGER NOT NULL,  -- the engine's estimate of the total
  strain     REAL    NOT NULL,
  renewed_at TEXT    NOT NULL,
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

-- What the closed cohort of the first `seeds` seeds said. NULL: does not exist for so few values.
CREATE TABLE stop_test (
  point_id                    INTEGER NOT NULL REFERENCES point,
  target_id                   INTEGER NOT NULL REFERENCES target,
  seeds                       INTEGER NOT NULL,
  lost                        INTEGER NOT NULL,
  count                       INTEGER NOT NULL,
  mean                        REAL,     -- of value + control: the estimate that decides
  standard_error              REAL,
  half_width                  REAL,
  plain_mean           REAL,     -- of the values alone
  plain_standard_error REAL,
  plain_half_width     REAL,
  verdict                     TEXT    NOT NULL CHECK (verdict IN ('more', 'converged', 'converged-with-losses',
                                'capped', 'failed', 'complete', 'complete-with-losses')),
  made_at                     TEXT    NOT NULL,
  skewness                    REAL,     -- of the values that decide
  transient                   INTEGER NOT NULL DEFAULT 0 CHECK (transient IN (0, 1)),  -- the window is too early
  observables                 TEXT CHECK (observables IS NULL OR json_valid(observables)),  -- each, if several
  PRIMARY KEY (point_id, target_id, seeds)
) STRICT, WITHOUT ROWID;

-- What the first seeds of a point let expect, for one target.
CREATE TABLE prediction (
  point_id    INTEGER NOT NULL REFERENCES point,
  target_id   INTEGER NOT NULL REFERENCES target,
  made_at     TEXT    NOT NULL,
  pilot       INTEGER NOT NULL,  -- seeds that it was made from
  seeds       INTEGER NOT NULL,  -- of the deciding stop test, as expected
  lower       INTEGER NOT NULL,  -- and the range that should hold it 95 % of the time
  upper       INTEGER NOT NULL,
  cpu_seconds REAL    NOT NULL,  -- of one seed
  PRIMARY KEY (point_id, target_id)
) STRICT, WITHOUT ROWID;

-- What a person may want to know afterwards.
CREATE TABLE event (
  event_id INTEGER PRIMARY KEY,
  at       TEXT    NOT NULL,
  kind     TEXT    NOT NULL,
  point_id INTEGER REFERENCES point,
  seed     INTEGER,
  message  TEXT    NOT NULL,
  request  TEXT               -- the request that caused it, which so is carried out once; NULL: none did
) STRICT;

CREATE UNIQUE INDEX event_by_request ON event (request) WHERE request IS NOT NULL;

-- Seeds in the hands of a batch system (Slurm ...). A bundle is one job array, called by the job's name.
CREATE TABLE bundle (
  bundle_id    INTEGER PRIMARY KEY,
  name         TEXT    NOT NULL UNIQUE,
  shared       TEXT    NOT NULL,  -- the folder that owner and nodes see
  tasks        INTEGER NOT NULL,
  job          TEXT,              -- the batch system's number; NULL until an answer to the submission is known
  made_at      TEXT    NOT NULL,
  submitted_at TEXT,
  closed_at    TEXT               -- all of its seeds and tasks have ended
) STRICT;

-- A seed without an outcome is handed over: it is queued, but nobody else may run it.
CREATE TABLE bundle_seed (
  bundle_id INTEGER NOT NULL REFERENCES bundle,
  place     INTEGER NOT NULL,  -- in the manifest
  task      INTEGER NOT NULL,
  point_id  INTEGER NOT NULL,
  seed      INTEGER NOT NULL,
  outcome   TEXT,              -- of its attempt, or returned: its task ended without it
  PRIMARY KEY (bundle_id, place),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT, WITHOUT ROWID;

CREATE UNIQUE INDEX handed_over_once ON bundle_seed (point_id, seed) WHERE outcome IS NULL;
