-- Keys of the measures of a run that are lower bounds, separated by blanks; NULL in runs recorded before.
ALTER TABLE runs ADD COLUMN lower_bounds TEXT;
