-- A small campaign as version 1 of the tables kept it: four seeds of one point, one of them lost. What migration must
-- bring to the present version.
PRAGMA application_id = 1346587724;
PRAGMA user_version = 1;
BEGIN TRANSACTION;
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
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;
INSERT INTO "attempt" VALUES(1,1,0,0,18593,'host',1,'2026-11-21T23:52:48Z','2026-11-21T23:52:48Z','result',0,0,NULL,NULL,NULL);
INSERT INTO "attempt" VALUES(2,1,1,0,18593,'host',1,'2026-11-21T23:52:48Z','2026-11-21T23:52:48Z','result',0,0,NULL,NULL,NULL);
INSERT INTO "attempt" VALUES(3,1,2,0,18593,'host',1,'2026-11-21T23:52:48Z','2026-11-21T23:52:48Z','result',0,0,NULL,NULL,NULL);
INSERT INTO "attempt" VALUES(4,1,3,0,18593,'host',1,'2026-11-21T23:52:48Z','2026-11-21T23:52:48Z','result',0,0,NULL,NULL,NULL);
CREATE TABLE campaign (
  campaign_id INTEGER PRIMARY KEY CHECK (campaign_id = 1),
  name        TEXT    NOT NULL,
  document    TEXT    NOT NULL CHECK (json_valid(document)),
  target_id   INTEGER NOT NULL REFERENCES target,
  created_at  TEXT    NOT NULL,
  updated_at  TEXT    NOT NULL
) STRICT;
INSERT INTO "campaign" VALUES(1,'old','{"engine":["fake_engine"],"name":"old","realisations":{"maximum":4,"minimum":2},"scene":{"fluid":{"viscosity":0.1}},"sweep":[],"target":{"confidence":0.95,"observable":"relative_viscosity","relative_tolerance":0.05}}',1,'2026-11-21T23:52:47Z','2026-11-21T23:52:47Z');
CREATE TABLE engine (
  engine_id  INTEGER PRIMARY KEY,
  identity   TEXT    NOT NULL,         -- version, binary hash and instruction set
  provenance TEXT    NOT NULL UNIQUE CHECK (json_valid(provenance))
) STRICT;
INSERT INTO "engine" VALUES(1,'0.0.0 (none) sha256 b5d54c39e66671c9731b9f471e585d8262cd4f54963f0c93082d8dcf334d4c78','{"binary_sha256":"b5d54c39e66671c9731b9f471e585d8262cd4f54963f0c93082d8dcf334d4c78","build_type":"none","compiler":"none","cpu":"none","flags":"","git_commit":"unknown","git_dirty":null,"instruction_set":"none","version":"0.0.0"}');
CREATE TABLE event (
  event_id INTEGER PRIMARY KEY,
  at       TEXT    NOT NULL,
  kind     TEXT    NOT NULL,
  point_id INTEGER REFERENCES point,
  seed     INTEGER,
  message  TEXT    NOT NULL
) STRICT;
INSERT INTO "event" VALUES(1,'2026-11-21T23:52:47Z','campaign',NULL,NULL,'old: 1 points, relative_viscosity to 5 % at 0.95 confidence, 2 to 4 seeds');
INSERT INTO "event" VALUES(2,'2026-11-21T23:52:48Z','decided',1,NULL,'capped after 4 seeds');
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
CREATE TABLE look (
  point_id                  INTEGER NOT NULL REFERENCES point,
  target_id                 INTEGER NOT NULL REFERENCES target,
  seeds                     INTEGER NOT NULL,
  lost                      INTEGER NOT NULL,
  count                     INTEGER NOT NULL,
  mean                      REAL,
  standard_error            REAL,
  half_width                REAL,
  controlled_mean           REAL,
  controlled_standard_error REAL,
  controlled_half_width     REAL,
  verdict                   TEXT    NOT NULL CHECK (verdict IN
                              ('more', 'converged', 'converged-with-losses', 'capped', 'failed')),
  made_at                   TEXT    NOT NULL,
  PRIMARY KEY (point_id, target_id, seeds)
) STRICT, WITHOUT ROWID;
INSERT INTO "look" VALUES(1,1,2,0,2,9.59812534953086249345e+00,7.92139948796185322521e-01,1.00650923691072691212e+01,9.59812534953086249345e+00,7.92139948796185322521e-01,1.00650923691072691212e+01,'more','2026-11-21T23:52:48Z');
INSERT INTO "look" VALUES(1,1,3,1,2,9.59812534953086249345e+00,7.92139948796185322521e-01,1.00650923691072691212e+01,9.59812534953086249345e+00,7.92139948796185322521e-01,1.00650923691072691212e+01,'more','2026-11-21T23:52:48Z');
INSERT INTO "look" VALUES(1,1,4,1,3,9.33374596167268322233e+00,0.528259746921159,2.27291824210708437448e+00,9.33374596167268322233e+00,0.528259746921159,2.27291824210708437448e+00,'capped','2026-11-21T23:52:48Z');
CREATE TABLE point (
  point_id        INTEGER PRIMARY KEY,
  hash            TEXT    NOT NULL UNIQUE,  -- SHA-256 of the canonical scene
  scene           TEXT    NOT NULL CHECK (json_valid(scene)),
  settings        TEXT    NOT NULL CHECK (json_valid(settings)),
  label           TEXT    NOT NULL,
  place           INTEGER UNIQUE,           -- in the sweep; NULL when the sweep no longer contains the point
  engine_identity TEXT,                     -- of its first result; every other result must have the same
  suspect         INTEGER NOT NULL DEFAULT 0 CHECK (suspect IN (0, 1))  -- a seed gave two different results
) STRICT;
INSERT INTO "point" VALUES(1,'6d766e83069f817ca2b9631c875cf1008702785ef1b42ee8a9c01bf1db231668','{"fluid":{"viscosity":0.1}}','{}','old',0,'0.0.0 (none) sha256 b5d54c39e66671c9731b9f471e585d8262cd4f54963f0c93082d8dcf334d4c78',0);
CREATE TABLE realisation (
  point_id                 INTEGER NOT NULL REFERENCES point,
  seed                     INTEGER NOT NULL CHECK (seed >= 0),
  state                    TEXT    NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'quarantined')),
  cause                    TEXT,     -- of its ending: completed, overlap, ..., or why it is quarantined
  value                    REAL,     -- of the target's observable; NULL without one
  control                  REAL,     -- of the control variate; NULL without one
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
INSERT INTO "realisation" VALUES(1,0,'done','completed',8.80598540073467717093e+00,NULL,0.001,0,10,1.0,1.0,0.0,6.329e-06,6.329e-06,'e319306b5530ce658aeefb7a9127dd359b40136792fb6db1f411d43a36028bbc','1ea4742e5f12eb51c3283454720158812e1d497cfa5f518e12926b19ce7e3b93',1);
INSERT INTO "realisation" VALUES(1,1,'done','completed',1.03902652983270478155e+01,NULL,0.001,0,10,1.0,1.0,0.0,5.358e-06,5.358e-06,'3254d06835f891f4d791bf0b1b20a68412f013e0fdf1738560193dd775cf57f3','3504d34a3d0cad790a12c85a923d40428aa5e358c2e565bc9c471ff4ee4b7ab9',1);
INSERT INTO "realisation" VALUES(1,2,'failed','overlap',NULL,NULL,0.001,0,10,1.0,1.0,0.0,5.899e-06,5.899e-06,'b6c1014d051ae3aaae071ec36910a9f3e8e6821405ec07b6ac4488ac01595e17','6289dc63cf3dc329cdb566e1e6b59286f7639cc61af95ec69c64ce5efc25f634',1);
INSERT INTO "realisation" VALUES(1,3,'done','completed',8.80498718595632290373e+00,NULL,0.001,0,10,1.0,1.0,0.0,5.859e-06,5.859e-06,'63753d478beeae80f159f31f5a6b74f974ba461622849262295c2aba536cbde9','d2c0fb6c2095e778009d0b300ed06c081e14da37c4431a86658ba351ce84b124',1);
CREATE TABLE result (
  point_id INTEGER NOT NULL,
  seed     INTEGER NOT NULL,
  document TEXT    NOT NULL CHECK (json_valid(document)),
  PRIMARY KEY (point_id, seed),
  FOREIGN KEY (point_id, seed) REFERENCES realisation
) STRICT;
INSERT INTO "result" VALUES(1,0,'{"blocks":{"relative_viscosity":[8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677,8.805985400734677]},"cost":{"cpu_seconds":6.329e-06,"wall_seconds":6.329e-06},"derived":{},"ending":{"cause":"completed","message":"","state":null,"step":10},"final_state_sha256":"e319306b5530ce658aeefb7a9127dd359b40136792fb6db1f411d43a36028bbc","gate":null,"largest_overlap":0,"mean":{"control_variates":{"brownian_pairwise":null},"relative_viscosity":8.805985400734677},"method":"explicit","point":"6d766e83069f817ca2b9631c875cf1008702785ef1b42ee8a9c01bf1db231668","schema_version":1,"seed":0,"statistical_inefficiency":1,"steps":{"equilibration":0,"production":10},"strain":{"equilibration":0,"production":1.0},"time":{"equilibration":0,"production":0.01},"timestep":0.001,"units":"scene","warnings":[]}');
INSERT INTO "result" VALUES(1,1,'{"blocks":{"relative_viscosity":[10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048,10.390265298327048]},"cost":{"cpu_seconds":5.358e-06,"wall_seconds":5.358e-06},"derived":{},"ending":{"cause":"completed","message":"","state":null,"step":10},"final_state_sha256":"3254d06835f891f4d791bf0b1b20a68412f013e0fdf1738560193dd775cf57f3","gate":null,"largest_overlap":0,"mean":{"control_variates":{"brownian_pairwise":null},"relative_viscosity":10.390265298327048},"method":"explicit","point":"6d766e83069f817ca2b9631c875cf1008702785ef1b42ee8a9c01bf1db231668","schema_version":1,"seed":1,"statistical_inefficiency":1,"steps":{"equilibration":0,"production":10},"strain":{"equilibration":0,"production":1.0},"time":{"equilibration":0,"production":0.01},"timestep":0.001,"units":"scene","warnings":[]}');
INSERT INTO "result" VALUES(1,2,'{"blocks":null,"cost":{"cpu_seconds":5.899e-06,"wall_seconds":5.899e-06},"derived":{},"ending":{"cause":"overlap","message":"as asked","state":null,"step":10},"final_state_sha256":"b6c1014d051ae3aaae071ec36910a9f3e8e6821405ec07b6ac4488ac01595e17","gate":null,"largest_overlap":0,"mean":null,"method":"explicit","point":"6d766e83069f817ca2b9631c875cf1008702785ef1b42ee8a9c01bf1db231668","schema_version":1,"seed":2,"statistical_inefficiency":1,"steps":{"equilibration":0,"production":10},"strain":{"equilibration":0,"production":1.0},"time":{"equilibration":0,"production":0.01},"timestep":0.001,"units":"scene","warnings":[]}');
INSERT INTO "result" VALUES(1,3,'{"blocks":{"relative_viscosity":[8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323,8.804987185956323]},"cost":{"cpu_seconds":5.859e-06,"wall_seconds":5.859e-06},"derived":{},"ending":{"cause":"completed","message":"","state":null,"step":10},"final_state_sha256":"63753d478beeae80f159f31f5a6b74f974ba461622849262295c2aba536cbde9","gate":null,"largest_overlap":0,"mean":{"control_variates":{"brownian_pairwise":null},"relative_viscosity":8.804987185956323},"method":"explicit","point":"6d766e83069f817ca2b9631c875cf1008702785ef1b42ee8a9c01bf1db231668","schema_version":1,"seed":3,"statistical_inefficiency":1,"steps":{"equilibration":0,"production":10},"strain":{"equilibration":0,"production":1.0},"time":{"equilibration":0,"production":0.01},"timestep":0.001,"units":"scene","warnings":[]}');
CREATE TABLE target (
  target_id          INTEGER PRIMARY KEY,
  observable         TEXT    NOT NULL,
  relative_tolerance REAL    NOT NULL,
  confidence         REAL    NOT NULL,
  minimum            INTEGER NOT NULL,
  maximum            INTEGER NOT NULL,
  UNIQUE (observable, relative_tolerance, confidence, minimum, maximum)
) STRICT;
INSERT INTO "target" VALUES(1,'relative_viscosity',0.05,0.95,2,4);
CREATE INDEX realisation_by_state ON realisation (state, point_id);
CREATE INDEX attempt_by_seed ON attempt (point_id, seed);
CREATE VIEW points AS
SELECT p.place, p.label, p.hash, p.settings, p.suspect,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'done')        AS done,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'failed')      AS failed,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'quarantined') AS quarantined,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'running')     AS running,
       (SELECT sum(cpu_seconds) FROM realisation r WHERE r.point_id = p.point_id)                     AS cpu_seconds
FROM point p WHERE p.place IS NOT NULL ORDER BY p.place;
CREATE VIEW realisations AS
SELECT p.place, p.label, p.hash, r.seed, r.state, r.cause, r.value, r.control, r.timestep, r.equilibration_steps,
       r.production_steps, r.production_strain, r.statistical_inefficiency, r.largest_overlap, r.cpu_seconds,
       r.wall_seconds, r.final_state_sha256, e.identity AS engine, d.document AS result
FROM realisation r
JOIN point p USING (point_id)
LEFT JOIN engine e USING (engine_id)
LEFT JOIN result d USING (point_id, seed)
WHERE p.place IS NOT NULL ORDER BY p.place, r.seed;
CREATE VIEW estimates AS
SELECT p.place, p.label, p.hash, t.observable, t.relative_tolerance, t.confidence, l.seeds, l.lost, l.count, l.mean,
       l.standard_error, l.half_width, l.controlled_mean, l.controlled_standard_error, l.controlled_half_width,
       l.verdict
FROM look l
JOIN campaign c USING (target_id)
JOIN target t USING (target_id)
JOIN point p USING (point_id)
WHERE p.place IS NOT NULL
  AND l.seeds = (SELECT max(m.seeds) FROM look m WHERE m.point_id = l.point_id AND m.target_id = l.target_id)
ORDER BY p.place;
COMMIT;
