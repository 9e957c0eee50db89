-- FNV-1a hash of the key and the record of a run that is done, see checksum_of(); NULL in runs recorded before.
ALTER TABLE runs ADD COLUMN checksum TEXT;
