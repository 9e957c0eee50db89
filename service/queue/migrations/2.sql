ALTER TABLE runs ADD COLUMN captured_variance REAL;
