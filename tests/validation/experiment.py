"""An experiment is a module with TITLE, SOURCE and three functions.

measure(work, coarse)     runs what is missing in the directory `work` and returns numbers (JSON); `coarse` takes at most a few minutes
criteria(numbers)         list of Criterion
section(numbers, figures) Markdown for the report; writes its figures into the directory `figures`

NOT_MET maps the beginning of a criterion that is known to fail to a value that it must not exceed all the same, or to two that it must lie between; REMARKS explain why.
"""

import csv
import pathlib
from typing import NamedTuple

SET_BEFORE = "set before the runs"
DATA = pathlib.Path(__file__).resolve().parent / "data"


class Criterion(NamedTuple):
    """value must lie in [low, high]; one of them may be None. `why`: where the bounds come from."""

    what: str
    value: float
    low: float | None
    high: float | None
    why: str

    @property
    def met(self):
        return (self.low is None or self.value >= self.low) and (self.high is None or self.value <= self.high)


def at_most(what, value, high, why=SET_BEFORE):
    return Criterion(what, float(value), None, high, why)


def at_least(what, value, low, why=SET_BEFORE):
    return Criterion(what, float(value), low, None, why)


def within(what, value, low, high, why=SET_BEFORE):
    return Criterion(what, float(value), low, high, why)


def read_table(name):
    """Rows of data/name as dictionaries."""
    with open(DATA / name, newline="") as file:
        return list(csv.DictReader(file))


def table(header, rows):
    """Markdown table; floats with three significant digits."""
    def text(cell):
        return f"{cell:.3g}" if isinstance(cell, float) else str(cell)
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(text, row)) + " |" for row in rows]) + "\n"


def order_of_convergence(spacings, errors):
    """Observed order between the coarsest and the finest: log(e1/en)/log(dx1/dxn)."""
    import math
    return math.log(errors[0] / errors[-1]) / math.log(spacings[0] / spacings[-1])
