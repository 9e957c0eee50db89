"""What can go wrong, as exceptions that say where and what to do next."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Fault:
    """One fault of a case or a request."""

    pointer: str
    """JSON pointer ("/material/density_kg_m3"), file:line:column of a syntax error, or "?name" of a query parameter."""
    message: str

    def __str__(self) -> str:
        return f"{self.pointer}: {self.message}"


class TalusError(Exception):
    """Base of all errors of this package.

    Attributes:
        faults: every fault with its pointer; empty where the error has no place in a case
        exit_code: of the program, negative for a signal; None where no program ran
        log: the last lines that the program printed on standard error
    """

    def __init__(
        self, message: str, *, faults: Sequence[Fault] = (), exit_code: int | None = None, log: str = ""
    ) -> None:
        super().__init__(message)
        self.faults = tuple(faults)
        self.exit_code = exit_code
        self.log = log


class InternalError(TalusError):
    """Exit code 1: a defect of Talus."""


class UsageError(TalusError):
    """Exit code 2: an option that the program does not know, or a value that it does not take."""


class CaseError(TalusError):
    """Exit code 3: the case is not valid; `faults` has every fault."""


class DivergedError(TalusError):
    """Exit code 4: the run diverged; the message names step, time and particle."""


class FileError(TalusError):
    """Exit code 5, or a directory that does not hold what was asked for."""


class StoppedError(TalusError):
    """Exit code 6: stopped with a checkpoint; the same call continues."""


class TooManyFailedError(TalusError):
    """Exit code 7: too many realizations failed; `talus.open` still reads the study."""


class KilledError(TalusError):
    """The program was ended by a signal (`exit_code` is its negative number); the same call continues."""


class TimeLimitError(TalusError, TimeoutError):
    """The time that the caller gave is over; the same call continues."""


class ProgramNotFoundError(TalusError, FileNotFoundError):
    """The program `talus` is not installed, or not where it was looked for."""

    def __str__(self) -> str:  # FileNotFoundError has its own
        return str(self.args[0])


class ConnectError(TalusError, ConnectionError):
    """No answer from talusd: it does not run there, or the connection broke."""


class ServiceError(TalusError):
    """talusd answered with an error.

    Attributes:
        status: HTTP status
        problem: the RFC 9457 problem document; empty where the answer was none
        retry_after_s: seconds after which the server suggests another try; None where it does not
    """

    def __init__(
        self,
        message: str,
        *,
        status: int,
        problem: dict[str, Any],
        faults: Sequence[Fault] = (),
        retry_after_s: float | None = None,
    ) -> None:
        super().__init__(message, faults=faults)
        self.status = status
        self.problem = problem
        self.retry_after_s = retry_after_s


class JobFailedError(TalusError):
    """The job ended as failed or dismissed; the message has talusd's reason."""


_BY_EXIT_CODE: dict[int, type[TalusError]] = {
    1: InternalError,
    2: UsageError,
    3: CaseError,
    4: DivergedError,
    5: FileError,
    6: StoppedError,
    7: TooManyFailedError,
}
_FAULT = re.compile(r"^(/\S*|\S+:\d+:\d+): (.+)$")
LOG_LINES = 20


def faults_in(log: str, output: str = "") -> list[Fault]:
    """The faults in the JSON that the program printed on standard output, else among its lines "POINTER: MESSAGE"."""
    if output.startswith("{"):
        return [Fault(fault["pointer"], fault["message"]) for fault in json.loads(output).get("faults", ())]
    return [Fault(found[1], found[2]) for line in log.splitlines() if (found := _FAULT.match(line))]


def error_of_exit(exit_code: int, log: str, output: str = "") -> TalusError:
    """The exception for an exit code that is not 0 (negative: a signal) and for what the program printed."""
    tail = "\n".join(log.strip().splitlines()[-LOG_LINES:])
    if exit_code < 0:
        text = f"talus was ended by signal {-exit_code}; the same call continues where it was"
        return KilledError(f"{text}\n{tail}".strip(), exit_code=exit_code, log=tail)
    faults = faults_in(log, output) if exit_code == 3 else []
    message = "\n".join(map(str, faults)) or tail or f"talus ended with exit code {exit_code}"
    return _BY_EXIT_CODE.get(exit_code, TalusError)(message, faults=faults, exit_code=exit_code, log=tail)
