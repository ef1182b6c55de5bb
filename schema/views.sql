-- Views for people. They show the points that the sweep contains.

CREATE VIEW points AS
SELECT p.place, p.label, p.hash, p.settings, p.suspect, p.priority, p.cancelled,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'done')        AS done,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'failed')      AS failed,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'quarantined') AS quarantined,
       (SELECT count(*) FROM realisation r WHERE r.point_id = p.point_id AND r.state = 'running')     AS running,
       (SELECT sum(cpu_seconds) FROM realisation r WHERE r.point_id = p.point_id)                     AS cpu_seconds
FROM point p WHERE p.place IS NOT NULL ORDER BY p.place;

CREATE VIEW realisations AS
SELECT p.place, p.label, p.hash, r.seed, r.state, r.cause, CAST(json_extract(n.numbers, '$[0]') AS REAL) AS value,
       CAST(json_extract(n.numbers, '$[1]') AS REAL) AS control, r.timestep, r.equilibration_steps, r.production_steps,
       r.production_strain, r.statistical_inefficiency, r.largest_overlap,
       CAST(json_extract(n.numbers, '$[2]') AS REAL) AS first_quarter,
       CAST(json_extract(n.numbers, '$[3]') AS REAL) AS first_half, r.cpu_seconds, r.wall_seconds, r.final_state_sha256, e.identity AS engine, d.document AS result,
       t.text AS dictionary
FROM realisation r
JOIN point p USING (point_id)
LEFT JOIN engine e USING (engine_id)
LEFT JOIN result d USING (point_id, seed)
LEFT JOIN numbers n USING (point_id, seed)
LEFT JOIN dictionary t USING (point_id)
WHERE p.place IS NOT NULL ORDER BY p.place, r.seed;

CREATE VIEW files AS
SELECT p.place, p.label, p.hash, f.seed, e.identity AS engine, f.name, f.bytes, f.sha256, f.kept,
       CASE WHEN f.kept
            THEN printf('files/%s-%d/%06d/%s', substr(p.hash, 1, 16), p.point_id, f.seed, f.name) END AS path
FROM file f
JOIN point p USING (point_id)
JOIN realisation r USING (point_id, seed)
LEFT JOIN engine e USING (engine_id)
WHERE p.place IS NOT NULL ORDER BY p.place, f.seed, f.name;

-- The last stop test of each point for the campaign's present target.
CREATE VIEW estimates AS
SELECT p.place, p.label, p.hash, t.observable, json_extract(t.criterion, '$.relative_tolerance') AS relative_tolerance,
       json_extract(t.criterion, '$.absolute_tolerance') AS absolute_tolerance, t.confidence, l.seeds, l.lost, l.count,
       l.mean, l.standard_error, l.half_width, l.plain_mean, l.plain_standard_error, l.plain_half_width,
       l.skewness, l.transient, l.verdict
FROM stop_test l
JOIN campaign c USING (target_id)
JOIN target t USING (target_id)
JOIN point p USING (point_id)
WHERE p.place IS NOT NULL
  AND l.seeds = (SELECT max(m.seeds) FROM stop_test m WHERE m.point_id = l.point_id AND m.target_id = l.target_id)
ORDER BY p.place;
