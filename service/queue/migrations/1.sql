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
