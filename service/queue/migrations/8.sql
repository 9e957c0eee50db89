-- What a run did to the targets of its case: the list of its result.json, as JSON; NULL where the case has none.
ALTER TABLE runs ADD COLUMN targets TEXT;
