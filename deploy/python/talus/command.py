"""The subcommands validate, run and study of talus as functions."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from talus.program import Case, call, case_file, options
from talus.results import Run, Study


def validate(case: Case, *, changes: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Checks a case.

    Args:
        case: path of a case, or its content (which cannot name CSV files)
        changes: keys to set, such as {"particle_spacing_m": 0.4}
    Returns:
        the report of `talus validate --json`: particles, steps, memory, ground, warnings; units are in its keys
    Raises:
        CaseError: with all faults
    """
    with case_file(case) as path:
        report: dict[str, Any] = json.loads(call(["validate", path, *options(changes), "--json"]))
    return report


def run(
    case: Case,
    out: str | os.PathLike[str],
    *,
    realization: int | None = None,
    seed: int | None = None,
    changes: Mapping[str, Any] | None = None,
    threads: int | None = None,
    resume: bool = False,
    timeout_s: float | None = None,
) -> Run:
    """Runs one realization, or continues it. Blocks until it has ended.

    Args:
        case: path of a case, or its content (which cannot name CSV files)
        out: directory of the results; created, empty, or holding this run
        realization: index from 0; None: the median run
        seed: of the random field, 0 to 2^53 - 1; None: the case's, else a random one, which the result records
        changes: keys to set, such as {"particle_spacing_m": 0.4}
        threads: OpenMP threads; results do not depend on them
        resume: take a finished run as it is; with a later time.end_s continue one that still moved
        timeout_s: wall-clock limit [s]; the run then leaves a checkpoint
    Raises:
        CaseError, DivergedError, FileError, TimeLimitError, KilledError, ProgramNotFoundError
    """
    with case_file(case) as path:
        arguments = options(changes, out=out, realization=realization, seed=seed, threads=threads, resume=resume)
        call(["run", path, *arguments], timeout_s=timeout_s)
    return Run(out)


def study(
    case: Case,
    out: str | os.PathLike[str],
    *,
    realizations: int | None = None,
    seed: int | None = None,
    workers: int | None = None,
    changes: Mapping[str, Any] | None = None,
    first_last: tuple[int, int] | None = None,
    figures: bool = True,
    resume: bool = False,
    retry_failed: bool = False,
    time_limit_s: int | None = None,
    timeout_s: float | None = None,
) -> Study:
    """Runs a Monte Carlo study, or continues it: no finished realization is repeated. Blocks until it has ended.

    Args:
        case: path of a case, or its content (which cannot name CSV files)
        out: directory of the results; created, empty, or holding this study
        realizations: 1 to 1e9; None: the case's
        seed: of the random fields; None: the case's, else a random one, which is recorded
        workers: processes at a time; None: one per core
        changes: keys to set, such as {"particle_spacing_m": 0.4}
        first_last: run only these realizations here, both included; `talus stats` merges the parts
        figures: draw the figures at the end (needs gnuplot)
        resume: also continue a study of an earlier time.end_s
        retry_failed: run the failed realizations again
        time_limit_s: of a realization, which fails beyond it [s]
        timeout_s: wall-clock limit of the whole call [s]
    Raises:
        CaseError, FileError, TimeLimitError, KilledError, ProgramNotFoundError;
        TooManyFailedError: `talus.open(out)` still reads what there is
    """
    with case_file(case) as path:
        arguments = options(
            changes,
            out=out,
            realizations=realizations,
            seed=seed,
            workers=workers,
            range=first_last,
            resume=resume,
            retry_failed=retry_failed,
            no_figures=not figures,
            time_limit=time_limit_s,
        )
        call(["study", path, *arguments], timeout_s=timeout_s)
    return Study(out)
