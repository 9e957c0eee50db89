"""Client and AsyncClient: studies on a talusd. Both send the requests of talus.api."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import httpx
import pandas as pd

from talus import api
from talus.api import JobStatus, Request
from talus.errors import ConnectError, JobFailedError, ServiceError, TimeLimitError
from talus.program import Case

T = TypeVar("T")

TIMEOUT_S = 60.0
TRIES = 6
_LOOPBACK = ("127.0.0.1", "localhost", "[::1]")


def _settings(url: str | None, token: str | None) -> dict[str, Any]:
    """What httpx needs. Redirects are not followed: they could lead the token elsewhere. Proxies are not for this
    machine."""
    address = url or os.environ.get("TALUS_SERVER") or "http://127.0.0.1:8080"
    secret = token or os.environ.get("TALUS_TOKEN")
    host = httpx.URL(address).netloc.decode().rsplit("@", 1)[-1].rsplit(":", 1)[0]
    return {
        "base_url": address,
        "timeout": TIMEOUT_S,
        "headers": {"Authorization": f"Bearer {secret}"} if secret else {},
        "trust_env": host not in _LOOPBACK,
        "follow_redirects": False,
    }


def _arguments(request: Request[Any]) -> dict[str, Any]:
    return {
        "method": request.method,
        "url": request.path,
        "params": dict(request.query),
        "headers": dict(request.headers),
        "json": request.body,
    }


def _unreachable(url: httpx.URL, error: httpx.TransportError) -> ConnectError:
    return ConnectError(f"no answer from {url}: {error or type(error).__name__}; does talusd run there?")


def _worth_another(attempt: int, error: ServiceError | httpx.TransportError) -> float | None:
    """Seconds to wait before the request is sent again; None: it is not."""
    if attempt + 1 >= TRIES or (isinstance(error, ServiceError) and error.status not in api.RETRIED):
        return None
    return api.pause(attempt, error.retry_after_s if isinstance(error, ServiceError) else None)


def _checked(status: JobStatus) -> JobStatus:
    """Raises JobFailedError for a job that ended without results."""
    if status.state in ("failed", "dismissed"):
        raise JobFailedError(f"job {status.id} {status.state}: {status.message or 'no reason given'}")
    return status


def _late(job: str, timeout_s: float) -> TimeLimitError:
    return TimeLimitError(f"job {job} has not ended within {timeout_s:g} s; it goes on, and wait() can be called again")


class Client:
    """A talusd. Requests that fail for want of room or of a connection are sent again, with growing pauses, TRIES
    times in all; a submission carries an Idempotency-Key, so that it makes one job. Thread-safe.

    Args:
        url: of talusd; None: $TALUS_SERVER, else http://127.0.0.1:8080
        token: sent as Authorization: Bearer; None: $TALUS_TOKEN. Over http:// anyone on the way can read it: use
            https://
    All methods raise ServiceError (an answer of 400 or more, with the faults of the request) and ConnectError.
    """

    def __init__(self, url: str | None = None, *, token: str | None = None) -> None:
        self._http = httpx.Client(**_settings(url, token))

    def __repr__(self) -> str:
        return f"<talus.Client {self._http.base_url}>"

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the connections."""
        self._http.close()

    def send(self, request: Request[T]) -> T:
        """Sends a request of talus.api and reads its answer."""
        attempt = 0
        while True:
            try:
                reply = self._http.request(**_arguments(request))
                return request.read(api.interpret(reply.status_code, reply.headers, reply.text))
            except (ServiceError, httpx.TransportError) as error:
                wait = _worth_another(attempt, error)
                if wait is None:
                    raise (
                        error if isinstance(error, ServiceError) else _unreachable(self._http.base_url, error)
                    ) from error
            time.sleep(wait)
            attempt += 1

    def submit(self, case: Case, *, realizations: int | None = None, seed: int | None = None, **inputs: Any) -> Job:
        """Submits a study. Of a case that names CSV files the local `talus` makes one that holds them.

        Args:
            realizations, seed: as for `talus.study`; None: the case's
            inputs: others of the process influence-zone: quantity, noise_floor_replicates, max_failed_share,
                histogram_edges_m
        """
        status = self.send(api.submit(case, realizations, seed, inputs))
        return Job(self, status.id)

    def jobs(self, status: str | None = None) -> list[JobStatus]:
        """The newest studies, at most 1000; `status` such as "running" selects."""
        return self.send(api.jobs(status))

    def job(self, id: str) -> Job:
        """The job of an id; nothing is sent."""
        return Job(self, id)


class Job:
    """A study on a talusd. Made by Client.submit and Client.job."""

    def __init__(self, client: Client, id: str) -> None:
        self._client, self.id = client, id

    def __repr__(self) -> str:
        return f"<talus.Job {self.id}>"

    @property
    def status(self) -> JobStatus:
        """The state now."""
        return self._client.send(api.status(self.id))

    def wait(self, *, timeout_s: float | None = None, progress: Callable[[JobStatus], None] | None = None) -> JobStatus:
        """Waits until the job has ended: talusd answers at its next change; where it has no room for that, it is asked
        with growing pauses.

        Args:
            timeout_s: None: for ever
            progress: called with every new status
        Raises:
            JobFailedError: it failed or was dismissed; TimeLimitError: it goes on
        """
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        status, attempt = self.status, 0
        while True:
            if progress:
                progress(status)
            if status.ended:
                return _checked(status)
            left = None if deadline is None else deadline - time.monotonic()
            if timeout_s is not None and left is not None and left <= 0.0:
                raise _late(self.id, timeout_s)
            if left is None or left > api.LONG_POLL_S:
                status = self._client.send(api.next_status(self.id, status.version))
            else:
                time.sleep(min(left, api.pause(attempt)))
                status, attempt = self.status, attempt + 1

    def results(self) -> dict[str, Any]:
        """The outputs `histogram` and `summary` (study.json). Of a job that has not ended ServiceError 404."""
        return self._client.send(api.results(self.id))

    def histogram(
        self, quantity: str | None = None, *, bins: int | None = None, edges: Sequence[float] | None = None
    ) -> dict[str, Any]:
        """Histogram and statistics of the realizations done so far; `edges` in the unit of the quantity."""
        return self._client.send(api.histogram(self.id, quantity, bins, edges))

    def exceedance(self, x: float | None = None, *, quantity: str | None = None) -> dict[str, Any]:
        """Probability that the quantity is beyond x, or that the target is reached, with its 95 % interval."""
        return self._client.send(api.exceedance(self.id, x, quantity))

    def realizations(self) -> pd.DataFrame:
        """All realizations, indexed by `realization`: `state`, measures [m], digest, verdict, reason."""
        rows: list[dict[str, Any]] = []
        while page := self._client.send(api.realizations(self.id, rows[-1]["index"] if rows else -1)):
            rows += page
        return api.realization_table(rows)

    def realization(self, index: int) -> dict[str, Any]:
        """One realization, with the command that repeats it."""
        return self._client.send(api.realization(self.id, index))

    def field(self, index: int) -> pd.DataFrame:
        """The friction angles [deg] of a realization before failure, a row per soil particle."""
        return self._client.send(api.particles(self.id, index, "field"))

    def profile(self, index: int) -> pd.DataFrame:
        """The deposit of a realization, a row per soil particle; talusd repeats the run for it."""
        return self._client.send(api.particles(self.id, index, "profile"))

    def extend(self, more: int) -> JobStatus:
        """Adds realizations; the existing ones are kept."""
        return self._client.send(api.extend(self.id, more))

    def retry(self) -> JobStatus:
        """Requeues the failed realizations."""
        return self._client.send(api.retry(self.id))

    def dismiss(self) -> JobStatus:
        """Stops the job if it runs, and removes it with its files."""
        return self._client.send(api.dismiss(self.id))


class AsyncClient:
    """Client for asyncio: the same methods, to be awaited. For one event loop."""

    def __init__(self, url: str | None = None, *, token: str | None = None) -> None:
        self._http = httpx.AsyncClient(**_settings(url, token))

    def __repr__(self) -> str:
        return f"<talus.AsyncClient {self._http.base_url}>"

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    async def close(self) -> None:
        """Closes the connections."""
        await self._http.aclose()

    async def send(self, request: Request[T]) -> T:
        """Sends a request of talus.api and reads its answer."""
        attempt = 0
        while True:
            try:
                reply = await self._http.request(**_arguments(request))
                return request.read(api.interpret(reply.status_code, reply.headers, reply.text))
            except (ServiceError, httpx.TransportError) as error:
                wait = _worth_another(attempt, error)
                if wait is None:
                    raise (
                        error if isinstance(error, ServiceError) else _unreachable(self._http.base_url, error)
                    ) from error
            await asyncio.sleep(wait)
            attempt += 1

    async def submit(
        self, case: Case, *, realizations: int | None = None, seed: int | None = None, **inputs: Any
    ) -> AsyncJob:
        """As Client.submit."""
        request = await asyncio.to_thread(api.submit, case, realizations, seed, inputs)  # may call `talus`
        return AsyncJob(self, (await self.send(request)).id)

    async def jobs(self, status: str | None = None) -> list[JobStatus]:
        """As Client.jobs."""
        return await self.send(api.jobs(status))

    def job(self, id: str) -> AsyncJob:
        """The job of an id; nothing is sent."""
        return AsyncJob(self, id)


class AsyncJob:
    """Job for asyncio: the same methods, to be awaited; `status` is one, too."""

    def __init__(self, client: AsyncClient, id: str) -> None:
        self._client, self.id = client, id

    def __repr__(self) -> str:
        return f"<talus.AsyncJob {self.id}>"

    async def status(self) -> JobStatus:
        """The state now."""
        return await self._client.send(api.status(self.id))

    async def wait(
        self, *, timeout_s: float | None = None, progress: Callable[[JobStatus], None] | None = None
    ) -> JobStatus:
        """As Job.wait."""

        async def follow() -> JobStatus:
            status = await self.status()
            while True:
                if progress:
                    progress(status)
                if status.ended:
                    return _checked(status)
                status = await self._client.send(api.next_status(self.id, status.version))

        try:
            return await asyncio.wait_for(follow(), timeout_s)
        except asyncio.TimeoutError:
            raise _late(self.id, timeout_s or 0.0) from None

    async def results(self) -> dict[str, Any]:
        """As Job.results."""
        return await self._client.send(api.results(self.id))

    async def histogram(
        self, quantity: str | None = None, *, bins: int | None = None, edges: Sequence[float] | None = None
    ) -> dict[str, Any]:
        """As Job.histogram."""
        return await self._client.send(api.histogram(self.id, quantity, bins, edges))

    async def exceedance(self, x: float | None = None, *, quantity: str | None = None) -> dict[str, Any]:
        """As Job.exceedance."""
        return await self._client.send(api.exceedance(self.id, x, quantity))

    async def realizations(self) -> pd.DataFrame:
        """As Job.realizations."""
        rows: list[dict[str, Any]] = []
        while page := await self._client.send(api.realizations(self.id, rows[-1]["index"] if rows else -1)):
            rows += page
        return api.realization_table(rows)

    async def realization(self, index: int) -> dict[str, Any]:
        """As Job.realization."""
        return await self._client.send(api.realization(self.id, index))

    async def field(self, index: int) -> pd.DataFrame:
        """As Job.field."""
        return await self._client.send(api.particles(self.id, index, "field"))

    async def profile(self, index: int) -> pd.DataFrame:
        """As Job.profile."""
        return await self._client.send(api.particles(self.id, index, "profile"))

    async def extend(self, more: int) -> JobStatus:
        """As Job.extend."""
        return await self._client.send(api.extend(self.id, more))

    async def retry(self) -> JobStatus:
        """As Job.retry."""
        return await self._client.send(api.retry(self.id))

    async def dismiss(self) -> JobStatus:
        """As Job.dismiss."""
        return await self._client.send(api.dismiss(self.id))
