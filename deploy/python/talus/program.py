"""The program `talus`: where it is, one call of it, and what its exit codes mean."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from talus.errors import ProgramNotFoundError, TimeLimitError, error_of_exit

Case = str | os.PathLike[str] | Mapping[str, Any]
"""A case: the path of its JSON file, or its content."""

GRACE_S = 30.0
"""How long a program that was asked to stop may take to write its checkpoint before it is killed [s]."""


def find_program() -> str:
    """Path of `talus`: $TALUS where it is set, else the one on $PATH.

    Raises:
        ProgramNotFoundError: there is none; says what to do
    """
    given = os.environ.get("TALUS")
    found = shutil.which(given or "talus")
    if found:
        return found
    where = f"$TALUS is {given}, which is not a program" if given else "there is no program talus on $PATH"
    raise ProgramNotFoundError(
        f"{where}: install the Debian package, or set TALUS to build/release/bin/talus of a built tree"
    )


def call(arguments: Sequence[str], *, timeout_s: float | None = None) -> str:
    """Runs `talus ARGUMENTS` and returns its standard output. Thread-safe.

    The program has its own process group. Where the time is over, or on Ctrl-C, it gets SIGTERM and GRACE_S to write
    its checkpoint, and is then killed with its workers.

    Args:
        timeout_s: wall-clock limit [s], > 0; None: none
    Raises:
        ProgramNotFoundError, TimeLimitError, and the errors of its exit codes: see talus.errors
    """
    if timeout_s is not None and not timeout_s > 0:
        raise ValueError(f"timeout_s is {timeout_s}; allowed: > 0")
    process = subprocess.Popen(
        [find_program(), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
    )
    try:
        output, log = process.communicate(timeout=timeout_s)
    except subprocess.TimeoutExpired:
        output, log = _stop(process)
        if process.returncode == 0:  # it ended just now
            return output
        error = error_of_exit(process.returncode, log)
        raise TimeLimitError(
            f"talus {arguments[0]} did not end within {timeout_s:g} s and was stopped; the same call continues",
            exit_code=error.exit_code,
            log=error.log,
        ) from None
    except BaseException:
        _stop(process)
        raise
    if process.returncode != 0:
        raise error_of_exit(process.returncode, log, output)
    return output


def _stop(process: subprocess.Popen[str]) -> tuple[str, str]:
    """Ends the program and its workers. Returns what it printed on standard output and standard error."""
    with contextlib.suppress(ProcessLookupError):
        process.send_signal(signal.SIGTERM)
    try:
        return process.communicate(timeout=GRACE_S)
    except subprocess.TimeoutExpired:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        return process.communicate()


@contextlib.contextmanager
def case_file(case: Case) -> Iterator[str]:
    """The path of a case; one given by its content is written to a temporary directory, where no CSV file lies beside
    it."""
    if not isinstance(case, Mapping):
        yield os.fspath(case)
        return
    with tempfile.TemporaryDirectory(prefix="talus-") as directory:
        path = pathlib.Path(directory, "case.json")
        path.write_text(json.dumps(case), encoding="utf-8")
        yield str(path)


def options(changes: Mapping[str, Any] | None, **values: Any) -> list[str]:
    """Command-line options: `changes` as --set KEY=JSON; name=value as --name value, True as --name; None and False
    leave it out."""
    found: list[str] = []
    for name, value in values.items():
        if value is None or value is False:
            continue
        found.append("--" + name.replace("_", "-"))
        if value is not True:
            found.extend(
                map(str, value)
                if isinstance(value, tuple)
                else [os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
            )
    for key, value in (changes or {}).items():
        found += ["--set", f"{key}={json.dumps(value)}"]
    return found
