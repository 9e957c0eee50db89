"""Talus from Python: run cases and studies with the program `talus`, read what it wrote as pandas and xarray, and use
a talusd.

    study = talus.study("road-slope.json", "road", realizations=200, seed=1)
    study.measures["front_mass_99_m"].describe()
    study.exceedance([45.0])

No statistics are computed here: they are those of talus.
"""

from talus.client import AsyncClient, AsyncJob, Client, Job
from talus.api import JobStatus
from talus.command import run, study, validate
from talus.ensemble import history_ensemble, snapshot_ensemble
from talus.errors import (
    CaseError,
    ConnectError,
    DivergedError,
    Fault,
    FileError,
    InternalError,
    JobFailedError,
    KilledError,
    ProgramNotFoundError,
    ServiceError,
    StoppedError,
    TalusError,
    TimeLimitError,
    TooManyFailedError,
    UsageError,
)
from talus.results import Run, Study
from talus.results import open_results as open
from talus.snapshots import read_snapshots

__version__ = "0.1.0"

__all__ = [
    "AsyncClient",
    "AsyncJob",
    "CaseError",
    "Client",
    "ConnectError",
    "DivergedError",
    "Fault",
    "FileError",
    "InternalError",
    "Job",
    "JobFailedError",
    "JobStatus",
    "KilledError",
    "ProgramNotFoundError",
    "Run",
    "ServiceError",
    "StoppedError",
    "Study",
    "TalusError",
    "TimeLimitError",
    "TooManyFailedError",
    "UsageError",
    "history_ensemble",
    "open",
    "read_snapshots",
    "run",
    "snapshot_ensemble",
    "study",
    "validate",
]
