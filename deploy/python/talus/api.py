"""The requests of talusd and what their answers mean, for both clients: nothing here opens a connection."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import random
import tempfile
import uuid
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, TypeVar

import pandas as pd

from talus.errors import CaseError, Fault, ServiceError
from talus.program import Case, call
from talus.records import read_document

T = TypeVar("T")

PROCESS = "influence-zone"
PAGE = 1000
LONG_POLL_S = 20
FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.25, 10.0
RETRIED = frozenset({429, 502, 503, 504})
ENDED = frozenset({"successful", "failed", "dismissed"})


@dataclasses.dataclass(frozen=True)
class Request(Generic[T]):
    """A request, and how its answer becomes a value. One that fails may be sent again: it changes nothing, or carries
    a key by which talusd knows it."""

    method: str
    path: str
    read: Callable[[Any], T]
    query: Mapping[str, str] = dataclasses.field(default_factory=dict)
    body: Any = None
    headers: Mapping[str, str] = dataclasses.field(default_factory=dict)


@dataclasses.dataclass(frozen=True)
class JobStatus:
    """The state of a job."""

    id: str
    state: str
    """accepted, running, successful, failed or dismissed."""
    progress: int
    """Per cent."""
    planned: int
    done: int
    failed: int
    """Realizations."""
    message: str
    version: int
    """Grows with every change."""
    document: Mapping[str, Any]
    """The whole answer of talusd: seed, quality, times, links."""

    @property
    def ended(self) -> bool:
        return self.state in ENDED


def pause(attempt: int, retry_after_s: float | None = None) -> float:
    """Seconds to wait before try `attempt` + 1 (from 0): twice as long each time, up to LONGEST_PAUSE_S, or what the
    server says; at random up to a half more, so that many clients do not return together."""
    base = retry_after_s if retry_after_s is not None else min(FIRST_PAUSE_S * 2**attempt, LONGEST_PAUSE_S)
    return base * (1.0 + 0.5 * random.random())


def interpret(status: int, headers: Mapping[str, str], text: str) -> Any:
    """The JSON of an answer. Raises ServiceError for a status of 400 or more."""
    try:
        document = json.loads(text) if text else {}
    except ValueError:
        document = {}
    if status < 400:
        return document
    problem = document if isinstance(document, dict) else {}
    faults = [Fault(fault.get("pointer", ""), fault.get("message", "")) for fault in problem.get("errors", ())]
    said = [str(problem.get("detail") or problem.get("title") or text[:200] or "no reason given"), *map(str, faults)]
    after = headers.get("Retry-After", "")
    raise ServiceError(
        f"talusd answered {status}: " + "\n".join(said),
        status=status,
        problem=problem,
        faults=faults,
        retry_after_s=float(after) if after.isdigit() else None,
    )


def inlined(case: Case) -> dict[str, Any]:
    """The content of a case as talusd takes it, without names of files.

    A case that names CSV files is resolved by the local `talus`. Raises CaseError, ProgramNotFoundError, FileError.
    """
    if isinstance(case, Mapping):
        document = dict(case)
    else:
        with open(case, encoding="utf-8") as file:
            try:
                document = json.load(file)
            except ValueError as error:
                raise CaseError(
                    f"{os.fspath(case)} is not JSON: {error}", faults=[Fault(os.fspath(case), str(error))]
                ) from error
    if not _names_files(document):
        return document
    if isinstance(case, Mapping):
        raise CaseError("a case given by its content cannot name CSV files: give its path")
    with tempfile.TemporaryDirectory(prefix="talus-") as directory:
        call(["study", os.fspath(case), "--prepare", "--out", directory])
        return read_document(pathlib.Path(directory, "case.resolved.json"))


def _names_files(value: Any) -> bool:
    if isinstance(value, Mapping):
        return any(name.endswith("_csv") or _names_files(member) for name, member in value.items())
    return isinstance(value, list) and any(map(_names_files, value))


def status_of(document: Any) -> JobStatus:
    counts = document.get("realizations", {})
    return JobStatus(
        document["jobID"],
        document["status"],
        int(document.get("progress", 0)),
        counts.get("planned", 0),
        counts.get("done", 0),
        counts.get("failed", 0),
        document.get("message", ""),
        document.get("version", 0),
        document,
    )


def _as_is(document: Any) -> Any:
    return document


def submit(case: Case, realizations: int | None, seed: int | None, inputs: Mapping[str, Any]) -> Request[JobStatus]:
    given = {"realizations": realizations, "seed": seed, **inputs}
    body = {"inputs": {"case": inlined(case)} | {name: value for name, value in given.items() if value is not None}}
    return Request("POST", f"/processes/{PROCESS}/execution", status_of, body=body, headers=_key())


def _key() -> dict[str, str]:
    return {"Idempotency-Key": str(uuid.uuid4())}


def jobs(status: str | None) -> Request[list[JobStatus]]:
    query = {"limit": str(PAGE), "processID": PROCESS} | ({"status": status} if status else {})
    return Request("GET", "/jobs", lambda page: [status_of(job) for job in page["jobs"]], query)


def status(job: str) -> Request[JobStatus]:
    return Request("GET", f"/jobs/{job}", status_of)


def next_status(job: str, since: int) -> Request[JobStatus]:
    return Request("GET", f"/jobs/{job}/events", status_of, {"wait": str(LONG_POLL_S), "since": str(since)})


def results(job: str) -> Request[dict[str, Any]]:
    return Request(
        "GET", f"/jobs/{job}/results", lambda found: {name: output["value"] for name, output in found.items()}
    )


def histogram(
    job: str, quantity: str | None, bins: int | None, edges: Sequence[float] | None
) -> Request[dict[str, Any]]:
    joined = None if edges is None else ",".join(map(str, edges))
    return Request("GET", f"/jobs/{job}/histogram", _as_is, _query(quantity=quantity, bins=bins, edges=joined))


def exceedance(job: str, x: float | None, quantity: str | None) -> Request[dict[str, Any]]:
    return Request("GET", f"/jobs/{job}/exceedance", _as_is, _query(quantity=quantity, x=x))


def realizations(job: str, after: int) -> Request[list[dict[str, Any]]]:
    """A page of at most PAGE realizations with an index above `after`."""
    return Request(
        "GET",
        f"/jobs/{job}/realizations",
        lambda page: list(page["realizations"]),
        {"after": str(after), "limit": str(PAGE)},
    )


def realization(job: str, index: int) -> Request[dict[str, Any]]:
    return Request("GET", f"/jobs/{job}/realizations/{index}", _as_is)


def particles(job: str, index: int, what: str) -> Request[pd.DataFrame]:
    """Arrays of a realization, "field" or "profile", a row per soil particle."""
    return Request("GET", f"/jobs/{job}/realizations/{index}/{what}", _particle_table, {"format": "json"})


def _particle_table(document: Any) -> pd.DataFrame:
    arrays = {name: values for name, values in document.items() if isinstance(values, list) and name != "xi"}
    return pd.DataFrame({name: values for name, values in arrays.items() if len(values) == document["particles"]})


def extend(job: str, more: int) -> Request[JobStatus]:
    return Request("POST", f"/jobs/{job}/extend", status_of, body={"realizations": more}, headers=_key())


def retry(job: str) -> Request[JobStatus]:
    return Request("POST", f"/jobs/{job}/retry", status_of, headers=_key())


def dismiss(job: str) -> Request[JobStatus]:
    return Request("DELETE", f"/jobs/{job}", status_of)


def realization_table(pages: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Realizations as a table, indexed by `realization`; the numbers of `measures` are columns, as in
    Study.measures."""
    rows = [
        {"realization": row["index"]}
        | {k: v for k, v in row.items() if k not in ("index", "measures", "links", "href")}
        | dict(row.get("measures", {}))
        for row in pages
    ]
    return pd.DataFrame(rows, columns=None if rows else ["realization", "state"]).set_index("realization")


def _query(**values: Any) -> dict[str, str]:
    return {name: str(value) for name, value in values.items() if value is not None}
