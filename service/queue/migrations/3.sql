-- The key of a run becomes {level, kind, index}. A primary key cannot be altered, so the table is copied.
-- kind: 0 realization, 1 replicate of realization 0 (RunKind).
ALTER TABLE jobs RENAME COLUMN floor TO replicates;
ALTER TABLE jobs RENAME COLUMN floor_made TO replicates_ended;
ALTER TABLE remembered RENAME TO stored_responses;

CREATE TABLE new_runs (
  job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE,
  level INTEGER NOT NULL DEFAULT 0 CHECK (level >= 0),
  kind INTEGER NOT NULL CHECK (kind IN (0, 1)),
  idx INTEGER NOT NULL CHECK (idx >= 0),
  rank INTEGER NOT NULL,
  state TEXT NOT NULL DEFAULT 'queued' CHECK (state IN ('queued', 'leased', 'done', 'failed')),
  attempt INTEGER NOT NULL DEFAULT 0, crashes INTEGER NOT NULL DEFAULT 0, lease_until INTEGER NOT NULL DEFAULT 0,
  influence_zone_m REAL, front_connected_m REAL, front_mass_99_m REAL, front_mass_999_m REAL, centre_of_mass_x_m REAL,
  mean_friction_angle_deg REAL, captured_variance REAL, steps INTEGER, wall_clock_s REAL, digest TEXT,
  reason TEXT, exit_code INTEGER, signal INTEGER, log_tail TEXT,
  PRIMARY KEY (job, level, kind, idx)
) STRICT, WITHOUT ROWID;
INSERT INTO new_runs
  SELECT job, 0, floor, idx, rank, state, attempt, crashes, lease_until, influence_zone_m, front_connected_m,
         front_mass_99_m, front_mass_999_m, centre_of_mass_x_m, mean_friction_angle_deg, captured_variance, steps,
         wall_clock_s, digest, reason, exit_code, signal, log_tail
  FROM runs;
DROP TABLE runs;
ALTER TABLE new_runs RENAME TO runs;
CREATE INDEX runs_queued ON runs (job, rank) WHERE state = 'queued';
CREATE INDEX runs_leased ON runs (job) WHERE state = 'leased';
