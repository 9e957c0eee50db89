"""test_validation.py TALUS EXPERIMENT: the coarse version of an experiment; every criterion must be met, those that the experiment names as not
met within the limit that it gives for them.

The page and its figures are written as well, so that a report that cannot be written is found here.
"""

import importlib
import os
import pathlib
import sys
import tempfile

os.environ["TALUS"] = sys.argv[1]

import report


def excused(criterion, not_met):
    """Too large, but at most the limit, or within a pair of limits; what is too small is excused by a pair only."""
    def within(limit):
        low, high = limit if isinstance(limit, tuple) else (criterion.low, limit)
        return (low is None or criterion.value >= low) and criterion.value <= high
    return any(criterion.what.startswith(start) and within(limit) for start, limit in not_met.items())


def main(name):
    module = importlib.import_module(name)
    with tempfile.TemporaryDirectory() as directory:
        numbers = report.measure(name, pathlib.Path(directory), coarse=True)
        report.page({name: numbers}, pathlib.Path(directory))
    failed = [c.what for c in module.criteria(numbers) if not c.met and not excused(c, getattr(module, "NOT_MET", {}))]
    if failed:
        sys.exit("not met: " + "; ".join(failed))


main(sys.argv[2])
