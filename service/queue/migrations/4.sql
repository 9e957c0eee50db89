-- The verdict on the result of a run; NULL in runs recorded before, which were not assessed. `sound`, `doubtful` and `invalid` count the
-- realizations of a job.
ALTER TABLE runs ADD COLUMN verdict TEXT;
ALTER TABLE runs ADD COLUMN verdict_reasons TEXT;
ALTER TABLE jobs ADD COLUMN sound INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN doubtful INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN invalid INTEGER NOT NULL DEFAULT 0;
