#!/usr/bin/env python3
"""talusd against bad clients and bad days.  usage: test_hardening.py TALUSD SOURCE_DIR GROUP [test names]"""
import ctypes
import json
import os
import pathlib
import re
import shutil
import socket
import sqlite3
import subprocess
import threading
import time

from daemon import SOURCE, TALUS, TALUSD, Daemon, ServiceTest, main, study, workers_of

HEAD = b"Host: localhost\r\n"


class Probes(ServiceTest):
    """What Debian 12's cpp-httplib 0.11.4 takes by itself, fired over a raw socket."""

    options = ("--max-body", "0.01")

    def setUp(self):
        super().setUp()
        self.start()

    def tearDown(self):
        self.assertIsNone(self.daemon.process.poll(), "talusd is gone")
        self.assertEqual(self.daemon.get("/healthz").status, 200)
        super().tearDown()

    def status(self, data):
        answer = self.daemon.raw(data)
        self.assertTrue(answer.startswith(b"HTTP/1.1 "), answer[:200])
        self.assertEqual(len(re.findall(rb"(?:^|\n)HTTP/1.1 \d", answer)), 1, "more than one answer: a request was smuggled")
        return int(answer.split()[1])

    def test_chunked_bodies_beyond_the_limit(self):
        chunk = b"4000\r\n" + b"a" * 0x4000 + b"\r\n"
        self.assertEqual(self.status(b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + b"Transfer-Encoding: chunked\r\n\r\n" + chunk * 4 + b"0\r\n\r\n"), 411)

    def test_content_length_together_with_chunked(self):
        smuggled = b"GET /healthz HTTP/1.1\r\n" + HEAD + b"\r\n"
        for lines in (b"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", b"Transfer-Encoding: chunked\r\nContent-Length: 5\r\n"):
            self.assertEqual(self.status(b"POST / HTTP/1.1\r\n" + HEAD + lines + b"\r\n0\r\n\r\n" + smuggled), 400)

    def test_two_lengths(self):
        self.assertEqual(self.status(b"POST / HTTP/1.1\r\n" + HEAD + b"Content-Length: 5\r\nContent-Length: 0\r\n\r\nhello"), 400)

    def test_thousands_of_ranges(self):
        ranges = b"Range: bytes=" + b",".join(b"0-" for _ in range(3000)) + b"\r\n"
        answer = self.daemon.raw(b"GET /api HTTP/1.1\r\n" + HEAD + ranges + b"Connection: close\r\n\r\n")
        self.assertTrue(answer.startswith(b"HTTP/1.1 200 "), answer[:100])
        self.assertLess(len(answer), 10 * len(self.daemon.get("/api").body))
        self.assertEqual(self.status(b"GET /api HTTP/1.1\r\n" + HEAD + b"Range: bytes=0-0\r\nConnection: close\r\n\r\n"), 200)

    def test_line_breaks_hidden_in_header_values(self):
        answer = self.daemon.raw(b"GET / HTTP/1.1\r\n" + HEAD + b"X-Request-Id: a%0d%0aSet-Cookie:%20b=c\r\nConnection: close\r\n\r\n")
        self.assertTrue(answer.startswith(b"HTTP/1.1 400 "), answer[:100])
        self.assertNotIn(b"\r\nSet-Cookie", answer)
        for value in (b"localhost%0d%0aX: y", b"localhost\r\n X: y"):
            self.assertEqual(self.status(b"GET / HTTP/1.1\r\nHost: " + value + b"\r\n\r\n"), 400)

    def test_numbers_and_sizes_of_headers(self):
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"X: y\r\n" * 5000 + b"\r\n"), 431)
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"X: y\r\n" * 100 + b"\r\n"), 431)
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"X: " + b"y" * 20000), 431)
        self.assertEqual(self.status(b"GET /" + b"a" * 5000 + b" HTTP/1.1\r\n" + HEAD + b"\r\n"), 414)

    def test_bodies_beyond_the_limit(self):
        self.assertEqual(self.status(b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + b"Content-Length: 99999999\r\n\r\n"), 413)
        self.assertEqual(self.status(b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + b"Content-Length: 99999999999999999999999\r\n\r\n"), 413)

    def test_deep_and_long_json(self):
        for body in (b"[" * 9000, b'{"a":' * 1500, b'{"inputs":{"s":"' + b"a" * 9000 + b'"}}'):
            self.problem(self.daemon.post("/processes/echo/execution", body, headers={"Content-Type": "application/json"}), 400)

    def test_what_is_no_http(self):
        for data in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + os.urandom(200) + b"\r\n\r\n", b"hello\r\n\r\n", b"GET / HTTP/1.1\nHost: a\n\n\r\n\r\n",
                     b"GET / HTTP/9.9\r\n\r\n", b"GET / HTTP/1.1\r\n\r\n", b"\0\r\n\r\n"):
            self.assertIn(self.status(data), (400, 505), data[:20])

    def test_several_requests_on_one_connection(self):
        one = b"GET /healthz HTTP/1.1\r\n" + HEAD
        answer = self.daemon.raw((one + b"\r\n") * 3 + one + b"Connection: close\r\n\r\n")
        self.assertEqual(answer.count(b"HTTP/1.1 200 OK"), 4)

    def test_expect_continue(self):
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=5) as s:
            s.sendall(b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + b"Content-Length: 22\r\nExpect: 100-continue\r\nConnection: close\r\n\r\n")
            self.assertEqual(s.recv(100), b"HTTP/1.1 100 Continue\r\n\r\n")
            s.sendall(b'{"inputs": {"s": "a"}}')
            self.assertTrue(s.recv(1000).startswith(b"HTTP/1.1 200 "))

    def test_names_that_are_not_loopback(self):
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), 403)
        self.assertEqual(self.status(b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + b"Origin: http://evil.example\r\nContent-Length: 0\r\n\r\n"), 403)

    def test_nothing_from_a_request_reaches_a_command_line(self):
        seen = self.dir / "seen"
        fake = self.dir / "talus"
        fake.write_text(f'#!/bin/sh\nfor a in "$@"; do printf "%s\\n" "$a" >> {seen}; done\nenv >> {seen}\nexec {TALUS} "$@"\n')
        fake.chmod(0o755)
        self.daemon.stop()
        self.daemon = Daemon(self.dir / "data", "--talus", fake, environment=dict(os.environ, SECRET_OF_THE_SERVER="s3cr3t"))
        body = study(1)
        body["inputs"]["case"]["title"] = "POISON $(touch /tmp/x) --out /etc"
        job = self.daemon.submit(body)
        self.daemon.wait_for(job)
        self.daemon.get(f"/jobs/{job}/histogram?bins=3&quantity=POISON")
        self.daemon.get(f"/jobs/{job}/realizations/POISON/field")
        self.daemon.get(f"/jobs/{job}/realizations/0/field")
        text = seen.read_text()
        self.assertIn("--realization", text)
        self.assertNotIn("POISON", text)
        self.assertNotIn("s3cr3t", text)

    def test_files_of_the_server_cannot_be_named(self):
        for change in ({"terrain": {"bed_csv": "/etc/passwd"}}, {"terrain": {"bed_csv": "talus-output.json"}},
                       {"slide": {"outlines": [{"outline_csv": "x.csv"}]}}):
            body = study(1)
            body["inputs"]["case"].update(change)
            document = self.problem(self.daemon.post("/processes/influence-zone/execution", body), 400)
            self.assertIn("names a file", document["errors"][0]["message"])

    def test_no_path_leads_out(self):
        for path in ("/jobs/../../etc/passwd", "/jobs/..%2f..%2fqueue.sqlite", "/jobs/%2e%2e/results", "/processes/..%2f..", "/jobs/%00"):
            self.assertIn(self.daemon.get(path).status, (400, 404))


class SlowClients(ServiceTest):
    def test_200_slow_clients(self):
        self.start()
        sockets, stop = [], threading.Event()
        for _ in range(200):
            s = socket.create_connection(("127.0.0.1", self.daemon.port), timeout=10)
            s.sendall(b"POST /processes/echo/execution HTTP/1.1\r\nHost: localhost\r\nContent-Le")
            sockets.append(s)

        def drip():
            while not stop.wait(0.5):
                for s in sockets:
                    try:
                        s.send(b"a")
                    except OSError:
                        pass

        thread = threading.Thread(target=drip)
        thread.start()
        try:
            slowest = 0.0
            for _ in range(10):
                begin = time.monotonic()
                self.assertEqual(self.daemon.get("/healthz", timeout=5).status, 200)
                slowest = max(slowest, time.monotonic() - begin)
                time.sleep(0.1)
            print(f"\n/healthz with 200 slow clients: at most {1000 * slowest:.0f} ms", flush=True)
            self.assertLess(slowest, 1.0)
        finally:
            stop.set()
            thread.join()
            for s in sockets:
                s.close()

    def test_a_slow_request_is_cut_off(self):
        """Dripping bytes keeps no place for longer than the whole request may take."""
        self.start()
        begin = time.monotonic()
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=30) as s:
            s.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ")
            s.settimeout(0.5)
            answer = b""
            while time.monotonic() - begin < 25 and not answer:
                try:
                    s.send(b"a")
                    answer = s.recv(1000)
                except TimeoutError:
                    pass
        self.assertTrue(answer.startswith(b"HTTP/1.1 408 "), answer[:100])
        self.assertLess(time.monotonic() - begin, 20)

    def test_waiting_for_events_is_capped(self):
        self.start("--max-streams", 3)
        reply = self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a", "pause": 30}}, headers={"Prefer": "respond-async"})
        path = f"/jobs/{reply.json['jobID']}/events"
        held = []
        for _ in range(3):
            s = socket.create_connection(("127.0.0.1", self.daemon.port), timeout=5)
            s.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
            self.assertTrue(s.recv(4096).startswith(b"HTTP/1.1 200 "))
            held.append(s)
        reply = self.daemon.get(path + "?wait=1")
        self.problem(reply, 503)
        self.assertIn("Retry-After", reply.headers)
        for s in held:
            s.close()
        deadline = time.monotonic() + 15
        while self.daemon.get(path + "?wait=0").status != 200 and time.monotonic() < deadline:
            time.sleep(0.2)
        self.assertEqual(self.daemon.get(path + "?wait=0").status, 200)


class Authorisation(ServiceTest):
    """Who may do what: tokens of two subjects and two roles, and none."""

    def setUp(self):
        super().setUp()
        self.tokens, lines = {}, []
        for name, role, subject in (("anna", "submit", "anna"), ("anna-reads", "read", "anna"), ("ben", "submit", "ben")):
            out = subprocess.run([TALUSD, "--new-token", role, subject], capture_output=True, text=True, check=True).stdout.splitlines()
            self.tokens[name] = out[0].split()[-1]
            lines.append(out[1].split(": ", 1)[1])
        (self.dir / "tokens").write_text("\n".join(lines) + "\n")
        self.start("--tokens", self.dir / "tokens")

    def test_matrix(self):
        job = self.daemon.submit(study(2), token=self.tokens["anna"])
        self.daemon.wait_for(job, token=self.tokens["anna"])
        execution = ("POST", "/processes/echo/execution", {"inputs": {"s": "a"}})
        own, submit, anyone = (401, 200, 200, 404), (401, 200, 403, 404), (401, 200, 200, 200)
        table = [
            (("GET", "/", None), anyone), (("GET", "/processes/echo", None), anyone), (("GET", "/metrics", None), anyone),
            (("GET", "/jobs", None), anyone), (("GET", "/nothing", None), (401, 404, 404, 404)),
            (("GET", "/healthz", None), (200, 200, 200, 200)), (("GET", "/readyz", None), (200, 200, 200, 200)),
            (execution, (401, 200, 403, 200)),
            (("GET", f"/jobs/{job}", None), own), (("GET", f"/jobs/{job}/results", None), own),
            (("GET", f"/jobs/{job}/histogram", None), own), (("GET", f"/jobs/{job}/realizations", None), own),
            (("GET", f"/jobs/{job}/realizations/0", None), own), (("GET", f"/jobs/{job}/realizations/0/field", None), own),
            (("GET", f"/jobs/{job}/realizations/0/profile", None), own), (("GET", f"/jobs/{job}/events?wait=0", None), own),
            (("POST", f"/jobs/{job}/retry", None), submit), (("POST", f"/jobs/{job}/extend", {"realizations": 1}), submit),
            (("POST", "/Evaluate", {"name": "x"}), (401, 400, 403, 400)), (("GET", "/Info", None), anyone),
        ]
        for (method, path, body), expected in table + [(("DELETE", f"/jobs/{job}", None), (401, None, 403, 404))]:
            for who, status in zip((None, "anna", "anna-reads", "ben"), expected):
                if status is None:
                    continue
                reply = self.daemon.request(method, path, body, token=self.tokens.get(who))
                self.assertEqual(reply.status, status, (method, path, who, reply.body))
                if status == 401:
                    self.assertEqual(reply.headers["WWW-Authenticate"], "Bearer")
        self.assertEqual(self.daemon.get("/jobs", token=self.tokens["ben"]).json["jobs"], [])
        self.assertEqual([j["jobID"] for j in self.daemon.get("/jobs", token=self.tokens["anna-reads"]).json["jobs"]], [job])
        self.assertEqual(self.daemon.request("DELETE", f"/jobs/{job}", token=self.tokens["anna"]).status, 200)

    def test_keys_of_two_subjects_do_not_meet(self):
        headers = {"Idempotency-Key": "same", "Prefer": "respond-async"}
        for who, text in (("anna", "a"), ("ben", "b")):
            reply = self.daemon.post("/processes/echo/execution", {"inputs": {"s": text}}, headers=headers, token=self.tokens[who])
            self.assertEqual(reply.status, 201)

    def test_no_token_is_logged(self):
        self.daemon.get("/jobs", token=self.tokens["anna"])
        self.daemon.get("/jobs", token="wrong-and-secret")
        time.sleep(0.1)
        log = (self.dir / "talusd.log").read_text()
        for secret in (*self.tokens.values(), "wrong-and-secret"):
            self.assertNotIn(secret, log)
        for line in log.splitlines():
            if line.startswith("{"):
                json.loads(line)
        self.assertIn('"request_id"', log)

    def test_other_addresses_demand_tokens(self):
        done = subprocess.run([TALUSD, "--data", str(self.dir / "other"), "--listen", "0.0.0.0:0"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--tokens", done.stderr)


class BadDays(ServiceTest):
    """Full disks, files that cannot be written, clocks that jump."""

    def on_small_disk(self, mebibytes):
        """A file system of its own; skips where mounting is not allowed."""
        place = self.dir / "disk"
        place.mkdir()
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={mebibytes}m", "tmpfs", str(place)], capture_output=True, text=True)
        if done.returncode != 0:
            self.skipTest("cannot mount a small file system here: " + done.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "-l", str(place)], capture_output=True)
        return place

    def test_a_full_disk(self):
        place = self.on_small_disk(48)
        self.daemon = Daemon(place / "data", workers=2)
        job = self.daemon.submit(study(40, spacing=0.8, end=1.5))
        while self.daemon.get(f"/jobs/{job}").json["realizations"]["done"] < 3:
            time.sleep(0.02)
        statuses = set()
        for _ in range(10):
            with open(place / "ballast", "ab", buffering=0) as ballast:
                try:
                    while True:
                        ballast.write(b"x" * 4096)
                except OSError:
                    pass
            statuses.add(self.daemon.post("/processes/influence-zone/execution", study(3)).status)
            self.assertEqual(self.daemon.get("/healthz").status, 200)
            time.sleep(0.1)
        # A run that ends makes room again, so one may get in.
        self.assertTrue(statuses <= {201, 503, 507} and statuses & {503, 507}, statuses)
        self.assertEqual(self.daemon.get(f"/jobs/{job}").status, 200)
        self.assertIsNone(self.daemon.process.poll())
        (place / "ballast").unlink()
        info = self.daemon.wait_for(job)
        self.assertEqual((info["status"], info["realizations"]["done"]), ("successful", 40))
        self.assertEqual(self.daemon.stop(), 0)

    def test_a_database_that_cannot_be_written(self):
        """The file turns read-only while talusd runs (chattr +i, which holds for root and for open files too)."""
        self.start(workers=1)
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        files = [str(p) for p in self.daemon.data.glob("queue.sqlite*")]
        done = subprocess.run(["chattr", "+i", *files], capture_output=True, text=True)
        self.addCleanup(subprocess.run, ["chattr", "-i", *files], capture_output=True)
        if done.returncode != 0:
            self.skipTest("no chattr +i here: " + done.stderr.strip())
        echo = {"inputs": {"s": "a"}}
        reply = self.daemon.post("/processes/echo/execution", echo, headers={"Prefer": "respond-async"})
        document = self.problem(reply, reply.status)
        self.assertIn(reply.status, (503, 507))
        self.assertIn("cannot be written", document["detail"])
        self.assertEqual(self.daemon.get(f"/jobs/{job}").status, 200)
        self.assertIsNone(self.daemon.process.poll())
        subprocess.run(["chattr", "-i", *files], check=True)
        self.assertEqual(self.daemon.post("/processes/echo/execution", echo, headers={"Prefer": "respond-async"}).status, 201)

    def test_a_data_directory_of_someone_else(self):
        data = self.dir / "data"
        self.start()
        self.daemon.stop()
        if os.getuid() != 0 or not shutil.which("setpriv"):
            self.skipTest("needs root and setpriv to become somebody else")
        for path in (self.dir, data, *data.iterdir()):
            path.chmod(0o755 if path.is_dir() else 0o644)
        done = subprocess.run(["setpriv", "--reuid=65534", "--clear-groups", TALUSD, "--data", str(data), "--listen", "127.0.0.1:0"],
                              capture_output=True, text=True, timeout=20)
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn(str(data), done.stderr)

    def test_a_database_that_is_none_of_ours(self):
        data = self.dir / "data"
        self.start()
        self.daemon.stop()
        connection = sqlite3.connect(data / "queue.sqlite")
        connection.execute("PRAGMA user_version = 99")
        connection.commit()
        connection.close()
        refused = Daemon(data, wait=False)
        self.assertEqual(refused.process.wait(10), 5)
        self.assertIn("newer", refused.said())
        refused.close()
        (data / "queue.sqlite").write_bytes(b"this is no database" * 100)
        refused = Daemon(data, wait=False)
        self.assertEqual(refused.process.wait(10), 5)
        self.assertIn("talusd:", refused.said())
        refused.close()

    def test_the_clock_jumps(self):
        """With a clock of its own that a file shifts: an hour ahead, then back by two."""
        source = self.dir / "clock.c"
        source.write_text('''
            #define _GNU_SOURCE
            #include <dlfcn.h>
            #include <stdio.h>
            #include <stdlib.h>
            #include <time.h>
            int clock_gettime(clockid_t id, struct timespec *t) {
              static int (*real)(clockid_t, struct timespec *);
              if (!real) real = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
              int result = real(id, t);
              if (id != CLOCK_REALTIME) return result;
              FILE *f = fopen(getenv("CLOCK_SHIFT"), "r");
              long shift = 0;
              if (f) { if (fscanf(f, "%ld", &shift) != 1) shift = 0; fclose(f); }
              t->tv_sec += shift;
              return result;
            }''')
        library = self.dir / "clock.so"
        done = subprocess.run(["cc", "-shared", "-fPIC", "-o", str(library), str(source), "-ldl"], capture_output=True, text=True)
        if done.returncode != 0:
            self.skipTest("no C compiler: " + done.stderr)
        shift = self.dir / "shift"  # replaced by rename, so that it is never empty
        shift.write_text("0")
        self.start("--lease", 3, environment=dict(os.environ, LD_PRELOAD=str(library), CLOCK_SHIFT=str(shift)))
        job = self.daemon.submit(study(30, spacing=0.5, end=1.0))
        for value in (3600, -3600, 86400, 0):
            time.sleep(0.7)
            (self.dir / "next").write_text(str(value))
            (self.dir / "next").rename(shift)
        info = self.daemon.wait_for(job)
        self.assertEqual(info["realizations"], {"planned": 30, "done": 30, "failed": 0})
        attempts = [self.daemon.get(f"/jobs/{job}/realizations/{i}").json["attempt"] for i in range(30)]
        self.assertEqual(set(attempts), {1}, "a jump of the clock took a lease from a worker that was alive")


class Load(ServiceTest):
    """Reads while a study runs: no error; the times are printed."""

    def test_reads_while_a_study_runs(self):
        self.start()
        job = self.daemon.submit(study(2000, spacing=0.8, end=1.5))
        self.daemon.wait_for(job, ("running",))
        times, errors = [], []

        def read(seconds):
            import http.client
            connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=20)
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                begin = time.monotonic()
                try:
                    connection.request("GET", f"/jobs/{job}")
                    answer = connection.getresponse()
                    answer.read()
                    if answer.status != 200:
                        errors.append(answer.status)
                except OSError as e:
                    errors.append(e)
                    connection.close()
                times.append(time.monotonic() - begin)

        threads = [threading.Thread(target=read, args=(4,)) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        times.sort()
        p = lambda share: 1000 * times[int(share * (len(times) - 1))]
        print(f"\n{len(times) / 4:.0f} reads a second beside a running study: p50 {p(0.5):.1f} ms, p99 {p(0.99):.1f} ms, "
              f"slowest {p(1):.1f} ms", flush=True)
        self.assertEqual(errors, [])
        self.assertGreater(self.daemon.get(f"/jobs/{job}").json["realizations"]["done"], 0)


if __name__ == "__main__":
    main({"Probes": Probes, "SlowClients": SlowClients, "Authorisation": Authorisation, "BadDays": BadDays, "Load": Load})
