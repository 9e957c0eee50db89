#pragma once
// The tables of the queue, as steps from one version to the next. A step that has been released is never edited.

namespace talus::service {

inline constexpr const char* migrations[] = {
    R"sql(
CREATE TABLE jobs (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  process TEXT NOT NULL,
  subject TEXT NOT NULL,
  title TEXT NOT NULL,
  inputs TEXT NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('accepted', 'running', 'successful', 'failed', 'dismissed')),
  message TEXT NOT NULL DEFAULT '',
  seed INTEGER NOT NULL,
  planned INTEGER NOT NULL CHECK (planned >= 0),
  floor INTEGER NOT NULL CHECK (floor >= 0),
  max_failed_share REAL NOT NULL,
  may_stop_early INTEGER NOT NULL,
  case_hash TEXT NOT NULL,
  particles REAL NOT NULL,
  steps REAL NOT NULL,
  created INTEGER NOT NULL,
  updated INTEGER NOT NULL,
  started INTEGER,
  finished INTEGER,
  done INTEGER NOT NULL DEFAULT 0,
  failed INTEGER NOT NULL DEFAULT 0,
  floor_made INTEGER NOT NULL DEFAULT 0,
  version INTEGER NOT NULL DEFAULT 1,
  served INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE INDEX jobs_by_state ON jobs (state, number);

CREATE TABLE runs (
  job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE,
  floor INTEGER NOT NULL CHECK (floor IN (0, 1)),
  idx INTEGER NOT NULL CHECK (idx >= 0),
  rank INTEGER NOT NULL,
  state TEXT NOT NULL DEFAULT 'queued' CHECK (state IN ('queued', 'leased', 'done', 'failed')),
  attempt INTEGER NOT NULL DEFAULT 0,
  crashes INTEGER NOT NULL DEFAULT 0,
  lease_until INTEGER NOT NULL DEFAULT 0,
  influence_zone_m REAL,
  front_connected_m REAL,
  front_mass_99_m REAL,
  front_mass_999_m REAL,
  centre_of_mass_x_m REAL,
  mean_friction_angle_deg REAL,
  steps INTEGER,
  wall_clock_s REAL,
  digest TEXT,
  reason TEXT,
  exit_code INTEGER,
  signal INTEGER,
  log_tail TEXT,
  PRIMARY KEY (job, floor, idx)
) STRICT, WITHOUT ROWID;
CREATE INDEX runs_queued ON runs (job, rank) WHERE state = 'queued';
CREATE INDEX runs_leased ON runs (job) WHERE state = 'leased';

CREATE TABLE remembered (
  subject TEXT NOT NULL,
  key TEXT NOT NULL,
  body_hash TEXT NOT NULL,
  status INTEGER NOT NULL,
  location TEXT NOT NULL,
  body TEXT NOT NULL,
  created INTEGER NOT NULL,
  PRIMARY KEY (subject, key)
) STRICT, WITHOUT ROWID;
)sql",
    "ALTER TABLE runs ADD COLUMN captured_variance REAL;",
    // The key of a run becomes {level, kind, index}; a primary key cannot be altered, so the table is copied. kind: 0
    // realization, 1 replicate of realization 0 (RunKind).
    R"sql(
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
)sql",
};

}  // namespace talus::service
