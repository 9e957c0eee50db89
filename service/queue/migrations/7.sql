-- The inputs of echo jobs may be large: they leave the rows that lists and the scheduler read. `bytes` stands before them, so that
-- a sum reads none of them. Those of dismissed jobs go.
CREATE TABLE echo_inputs (
  job INTEGER PRIMARY KEY REFERENCES jobs (number) ON DELETE CASCADE,
  bytes INTEGER NOT NULL,
  inputs TEXT NOT NULL
) STRICT;
INSERT INTO echo_inputs
  SELECT number, length(CAST(json_extract(inputs, '$.inputs') AS BLOB)), json_extract(inputs, '$.inputs')
  FROM jobs WHERE process = 'echo' AND state != 'dismissed' AND json_extract(inputs, '$.inputs') IS NOT NULL;
UPDATE jobs SET inputs = json_remove(inputs, '$.inputs') WHERE process = 'echo';
