#!/usr/bin/env python3
"""Clients that take what they can, and how the operator fares meanwhile: attacks.py TALUSD SOURCE [SECONDS] prints a table.

/healthz is asked ten times a second over new connections, and as often /readyz and /metrics in turn; what is not answered
with 200 within 10 s counts as 10 s. The clients run in a process of their own.
"""

import asyncio
import contextlib
import http.client
import multiprocessing
import pathlib
import sys
import tempfile
import time

HEAD = b"Host: localhost\r\n"
MIB = 1 << 20
PATIENCE = 10.0


async def held(port, request, pause, reads=True):
    """One connection that sends `request` each `pause` seconds for ever, and connects again when it is closed."""
    while True:
        with contextlib.suppress(OSError):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            try:
                while True:
                    writer.write(request)
                    await writer.drain()
                    if reads and await asyncio.wait_for(reader.read(65536), 60) == b"":
                        break
                    await asyncio.sleep(pause)
            except TimeoutError:
                pass
            finally:
                writer.close()
        await asyncio.sleep(0.05)


async def dripping(port, begun, pause=1.0):
    """One connection that sends the beginning of a request and then a byte each `pause` seconds."""
    while True:
        with contextlib.suppress(OSError):
            _, writer = await asyncio.open_connection("127.0.0.1", port)
            try:
                writer.write(begun)
                while not writer.is_closing():
                    await writer.drain()
                    await asyncio.sleep(pause)
                    writer.write(b"a")
            finally:
                writer.close()
        await asyncio.sleep(0.05)


async def silent(port):
    """One connection that sends nothing."""
    while True:
        with contextlib.suppress(OSError):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            await reader.read(1)
            writer.close()
        await asyncio.sleep(0.05)


async def flooding(port, request):
    """One connection at a time that sends a request, does not wait for the answer, and leaves."""
    while True:
        with contextlib.suppress(OSError):
            _, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(request)
            await writer.drain()
            await asyncio.sleep(0.2)
            writer.transport.abort()


async def patient(port, request):
    """One connection that sends a request and waits for the answer, again and again."""
    while True:
        with contextlib.suppress(OSError, asyncio.IncompleteReadError):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(request)
            with contextlib.suppress(OSError):
                await writer.drain()
            while await reader.read(65536):
                pass
            writer.close()
        await asyncio.sleep(0.05)


def get(path):
    return b"GET " + path.encode() + b" HTTP/1.1\r\n" + HEAD + b"\r\n"


def post(path, body, announced=None):
    length = len(body) if announced is None else announced
    head = b"POST %s HTTP/1.1\r\n%sContent-Type: application/json\r\nConnection: close\r\nContent-Length: %d\r\n\r\n"
    return head % (path.encode(), HEAD, length) + body


ECHO = "/processes/echo/execution"
EMPTY_OBJECTS, MANY_EMPTY_OBJECTS = (b"[" + b",".join([b"{}"] * number) + b"]" for number in (100_000, 1_398_000))
LONG_STRING = b'{"inputs": {"s": "' + b"a" * (4 * MIB - 100) + b'"}}'

SLOW_HEAD = b"GET / HTTP/1.1\r\nHost: localhost\r\nX: "
PAUSE = b'{"inputs": {"s": "a", "pause": 60}}'

#: name -> (number of clients, what one does, given the port and a job that has ended)
ATTACKS = {
    "none": (0, None),
    "keep-alive, a request each 3 s": (256, lambda port, job: held(port, get("/healthz"), 3)),
    "half a head, then a byte a second": (300, lambda port, job: dripping(port, SLOW_HEAD)),
    "a slow body": (300, lambda port, job: dripping(port, post(ECHO, b"{", 100_000))),
    "connections that send nothing": (300, lambda port, job: silent(port)),
    "answers that are not read": (300, lambda port, job: held(port, get("/api") * 50, 1, reads=False)),
    "connect, ask, leave": (300, lambda port, job: flooding(port, get("/jobs"))),
    "bodies of 300 kB of {}, gone at once": (300, lambda port, job: flooding(port, post("/ModelInfo", EMPTY_OBJECTS))),
    "synchronous waits of 60 s": (300, lambda port, job: patient(port, post(ECHO, PAUSE))),
    "event streams that are not read": (300, lambda port, job: held(port, get(f"/jobs/{job}/events"), 1, reads=False)),
    "the profile of a run": (300, lambda port, job: patient(port, get(f"/jobs/{job}/realizations/0/profile"))),
    "bodies of 4 MiB of {}": (200, lambda port, job: patient(port, post("/ModelInfo", MANY_EMPTY_OBJECTS))),
    "bodies of 4 MiB": (200, lambda port, job: patient(port, post(ECHO, LONG_STRING))),
}


def attack(name, port, job):
    async def run():
        number, client = ATTACKS[name]
        await asyncio.gather(*(client(port, job) for _ in range(number)))

    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(run())


@contextlib.contextmanager
def under(name, port, job):
    """While the body runs, the attack goes on."""
    attacker = multiprocessing.Process(target=attack, args=(name, port, job), daemon=True)
    attacker.start()
    try:
        time.sleep(1.0)
        yield
    finally:
        attacker.kill()
        attacker.join()


def asked(port, path="/healthz", patience=PATIENCE):
    """@return how long the answer took [s], and what is wrong with it or None"""
    begin = time.monotonic()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=patience)
    try:
        connection.request("GET", path)
        answer = connection.getresponse()
        body = answer.read()
        wrong = None if answer.status == 200 else f"{path}: {answer.status} {body[:300]}"
    except (OSError, http.client.HTTPException) as e:
        wrong = f"{path}: {e!r}"
    finally:
        connection.close()
    return time.monotonic() - begin, wrong


def ask(port, path="/healthz", patience=PATIENCE):
    """@return how long the answer took [s]; at least `patience` where it was none"""
    took, wrong = asked(port, path, patience)
    return max(took, patience) if wrong else took


def peak_memory(pid):
    """Largest resident memory of a process so far [MB]."""
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 1000
    return 0.0


def measure(port, seconds):
    """@return sorted times [s] of /healthz, and of /readyz and /metrics"""
    health, others, end = [], [], time.monotonic() + seconds
    while time.monotonic() < end:
        health.append(ask(port))
        others.append(ask(port, ("/readyz", "/metrics")[len(others) % 2]))
        time.sleep(0.1)
    return sorted(health), sorted(others)


def table(daemon_class, study, seconds):
    print("| clients | what they do | /healthz p50, p99 [ms] | /readyz, /metrics p50, p99 [ms] | asked | peak memory [MB] |")
    print("|---|---|---|---|---|---|")
    for name, (number, _) in ATTACKS.items():
        with tempfile.TemporaryDirectory() as directory:
            daemon = daemon_class(pathlib.Path(directory) / "data")
            job = daemon.submit(study(1))
            daemon.wait_for(job)
            with under(name, daemon.port, job) if number else contextlib.nullcontext():
                health, others = measure(daemon.port, seconds)
            quantiles = [
                f"{1000 * times[round(share * (len(times) - 1))]:.0f}" for times in (health, others) for share in (0.5, 0.99)
            ]
            memory = peak_memory(daemon.process.pid)
            print(f"| {number} | {name} | {quantiles[0]}, {quantiles[1]} | {quantiles[2]}, {quantiles[3]} | {len(health)} |"
                  f" {memory:.0f} |", flush=True)
            daemon.kill()


if __name__ == "__main__":
    from daemon import Daemon, study

    table(Daemon, study, float(sys.argv[3]) if len(sys.argv) > 3 else 20.0)
