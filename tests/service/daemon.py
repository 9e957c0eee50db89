"""A talusd for one test, and a client for it; standard library only."""
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

TALUSD, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
TALUS = pathlib.Path(os.environ.get("TALUS") or pathlib.Path(TALUSD).with_name("talus"))
SANITIZED = not {"dev", "tsan"}.isdisjoint(pathlib.Path(TALUSD).parts)


def case(spacing=1.0, end=0.5, **changes):
    """The illustrative slope, coarse and short: a run takes some hundredths of a second."""
    document = json.loads((SOURCE / "solver/cases/illustrative.json").read_text())
    document.update(particle_spacing_m=spacing, time={"end_s": end}, **changes)
    return document


def study(realizations=6, seed=7, spacing=1.0, end=0.5, **inputs):
    return {"inputs": {"case": case(spacing, end), "realizations": realizations, "seed": seed, **inputs}}


class Reply:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    @property
    def json(self):
        return json.loads(self.body)


class Daemon:
    def __init__(self, data, *options, workers=2, wait=True, environment=None, program=None):
        self.data = pathlib.Path(data)
        self.log = open(self.data.parent / "talusd.log", "ab")
        memory = ["--memory", "-1"] if SANITIZED else []
        self.process = subprocess.Popen(
            [str(program or TALUSD), "--data", str(data), "--listen", "127.0.0.1:0", "--workers", str(workers), *memory,
             *([] if "--talus" in options else ["--talus", str(TALUS)]),
             *([] if "--min-disk" in options else ["--min-disk", "0"]),
             *map(str, options)], stdout=subprocess.PIPE, stderr=self.log, text=True, env=environment)
        if wait:
            line = self.process.stdout.readline()
            found = re.search(r"listens on (http://127\.0\.0\.1:(\d+))", line)
            if not found:
                raise AssertionError(f"talusd did not start: {line!r} {self.log_text()}")
            self.url, self.port = found[1], int(found[2])

    def log_text(self):
        return (self.data.parent / "talusd.log").read_text()[-2000:]

    def request(self, method, path, body=None, headers=None, token=None, timeout=60):
        headers = dict(headers or {})
        if token:
            headers["Authorization"] = f"Bearer {token}"
        if body is not None and not isinstance(body, (bytes, str)):
            body = json.dumps(body)
            headers.setdefault("Content-Type", "application/json")
        if path.startswith(self.url):
            path = path[len(self.url):]
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            connection.request(method, path, body=body, headers=headers)
            answer = connection.getresponse()
            return Reply(answer.status, answer.headers, answer.read())
        finally:
            connection.close()

    def get(self, path, **options):
        return self.request("GET", path, **options)

    def post(self, path, body=None, **options):
        return self.request("POST", path, body, **options)

    def submit(self, body=None, **options):
        reply = self.post("/processes/influence-zone/execution", body or study(), **options)
        assert reply.status == 201, reply.body
        return reply.json["jobID"]

    def wait_for(self, job, states=("successful", "failed", "dismissed"), seconds=100, **options):
        deadline = time.monotonic() + seconds
        while True:
            info = self.get(f"/jobs/{job}", **options).json
            if info["status"] in states:
                return info
            if time.monotonic() > deadline:
                raise AssertionError(f"waited {seconds} s for {states}: {info}")
            time.sleep(0.03)

    def raw(self, data, seconds=5):
        """Bytes as they are, and all that comes back until the other side closes or the time is up."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=seconds) as s:
            answer = b""
            try:
                s.sendall(data)
                while chunk := s.recv(65536):
                    answer += chunk
            except (TimeoutError, ConnectionError):
                pass
            return answer

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.close()

    def stop(self, seconds=60):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(seconds)
        self.close()
        return code

    def close(self):
        self.process.stdout.close()
        self.log.close()


def workers_of(data):
    """Process ids of the runs that work in a data directory."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                command = (entry / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if b"run" in command[:2] and any(str(data).encode() in part for part in command):
                found.append(int(entry.name))
    return found


class ServiceTest(unittest.TestCase):
    options = ()
    workers = 2

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="talus-service-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)
        self.daemon = None

    def tearDown(self):
        if self.daemon and self.daemon.process.poll() is None:
            self.daemon.kill()
        log = self.dir / "talusd.log"
        if log.exists():
            said = log.read_text(errors="replace")
            self.assertNotIn("Sanitizer", said, said[said.find("Sanitizer") - 100 :][:5000])

    def start(self, *options, workers=None, **more):
        self.daemon = Daemon(self.dir / "data", *self.options, *options, workers=workers or self.workers, **more)
        return self.daemon

    def problem(self, reply, status, type_end=None):
        self.assertEqual(reply.status, status, reply.body)
        self.assertIn(reply.headers["Content-Type"], ("application/json", "application/problem+json"))
        document = reply.json
        self.assertEqual(document["status"], status)
        self.assertTrue(document["type"])
        if type_end:
            self.assertTrue(document["type"].endswith(type_end), document)
        return document


def digests(data, job):
    """Index to digest of every realization in the records on disk."""
    found = {}
    for path in sorted((pathlib.Path(data) / "jobs" / job / "runs").glob("[0-9]*.json")):
        if not path.name.endswith(".failed.json"):
            found[path.stem] = json.loads(path.read_text())["digest"]
    return found


def main(groups):
    """usage: FILE TALUSD SOURCE_DIR GROUP [unittest arguments]"""
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(groups[sys.argv[3]])
    wanted = sys.argv[4:]
    if wanted:
        suite = unittest.TestSuite(test for test in suite if any(w in test.id() for w in wanted))
    if suite.countTestCases() == 0:
        sys.exit("no test of this name")
    sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
