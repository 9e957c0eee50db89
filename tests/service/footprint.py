#!/usr/bin/env python3
"""What many or large requests cost talusd: footprint.py TALUSD SOURCE prints a table of times, memory and disk."""
import collections
import concurrent.futures
import os
import pathlib
import resource
import subprocess
import tempfile
import time

from daemon import TALUS, Daemon, study

MB = 1_000_000
REPEATS = 20
ECHO = {"inputs": {"s": "x", "pause": 60, "o": {"a": ["y" * 4000] * 1000}}}  # 4 MB
ASYNC = {"Prefer": "respond-async"}


def objects(count):
    return "[" + ",".join(["{}"] * count) + "]"


def row(what, value):
    print(f"| {what} | {value} |", flush=True)


def memory(daemon, name="VmHWM"):
    """Peak (or VmRSS: present) memory in MB."""
    status = pathlib.Path(f"/proc/{daemon.process.pid}/status").read_text()
    return int(status.split(name + ":")[1].split()[0]) * 1024 / MB


def seconds(action):
    begin = time.monotonic()
    action()
    return time.monotonic() - begin


def cpu(daemon):
    """CPU time used so far, in seconds."""
    fields = pathlib.Path(f"/proc/{daemon.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def at_once(count, action):
    """How often which status came back; "refused" where the connection was closed before the body was sent."""
    def status(_):
        try:
            return str(action().status)
        except OSError:
            return "refused"

    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        counts = collections.Counter(pool.map(status, range(count)))
    return ", ".join(f"{counts[status]} x {status}" for status in sorted(counts))


def documents(place):
    text = objects(333_333)
    daemon = Daemon(place / "documents")
    for path in ("/ModelInfo", "/processes/echo/execution"):
        used = cpu(daemon)
        for _ in range(REPEATS):
            daemon.post(path, text)
        row(f"1 MB of `[{{}},{{}},...]` to POST {path}: CPU time", f"{1000 * (cpu(daemon) - used) / REPEATS:.0f} ms")
    file = place / "objects.json"
    file.write_text('{"x":' + text + "}")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for _ in range(REPEATS):
        subprocess.run([TALUS, "validate", file], capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    row("the same in a case, `talus validate`: CPU time", f"{1000 * used / REPEATS:.0f} ms")
    replies = at_once(133, lambda: daemon.post("/processes/echo/execution", objects(1_390_000), timeout=300))
    row("133 bodies of 4 MB of objects at once", f"{replies}; peak {memory(daemon):.0f} MB")
    daemon.kill()


def profiles(place):
    runs = place / "runs"
    talus = place / "talus"
    talus.write_text(f'#!/bin/sh\ncase "$*" in run*scratch*) echo run >> {runs};; esac\nexec {TALUS} "$@"\n')
    talus.chmod(0o755)
    daemon = Daemon(place / "profiles", "--talus", talus)
    job = daemon.submit(study(1, spacing=0.2, end=3))
    daemon.wait_for(job, seconds=600)
    path = f"/jobs/{job}/realizations/0/profile"
    replies = at_once(300, lambda: daemon.get(path, timeout=300))
    row("300 requests for one profile", f"{len(runs.read_text().split())} run; {replies}")
    daemon.kill()


def echo(place):
    daemon = Daemon(place / "echo")
    alone = seconds(lambda: daemon.wait_for(daemon.submit(study(6))))
    jobs = [daemon.post("/processes/echo/execution", ECHO, headers=ASYNC).json["jobID"] for _ in range(84)]
    used, begin = cpu(daemon), time.monotonic()
    time.sleep(10)
    row("cores in use while 84 echo jobs of 4 MB wait", f"{(cpu(daemon) - used) / (time.monotonic() - begin):.3f}")
    beside = seconds(lambda: daemon.wait_for(daemon.submit(study(6))))
    row("a study of 6 runs alone, and beside them", f"{alone:.1f} s, {beside:.1f} s")
    before = memory(daemon, "VmRSS")
    pathlib.Path(f"/proc/{daemon.process.pid}/clear_refs").write_text("5")  # resets the peak
    replies = at_once(20, lambda: daemon.get("/jobs?limit=1000"))
    row("20 x GET /jobs?limit=1000 at once", f"{replies}; {before:.0f} MB before, peak {memory(daemon):.0f} MB")
    size = (daemon.data / "queue.sqlite").stat().st_size / MB
    for job in jobs:
        daemon.request("DELETE", f"/jobs/{job}")
    deadline = time.monotonic() + 120
    while (daemon.data / "queue.sqlite").stat().st_size > 10 * MB and time.monotonic() < deadline:
        time.sleep(0.1)
    rest = sum(path.stat().st_size for path in daemon.data.glob("queue.sqlite*")) / MB
    row("queue.sqlite with them; and once they are deleted, with its log", f"{size:.0f} MB; {rest:.0f} MB")
    daemon.kill()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="talus-footprint-") as directory:
        print("| what | measured |\n|---|---|")
        for part in (documents, profiles, echo):
            part(pathlib.Path(directory))
