#!/usr/bin/env python3
"""Malformed and malicious requests, and slow clients."""

import concurrent.futures
import datetime
import email
import email.utils
import json
import os
import re
import socket
import threading
import time

from daemon import TALUS, Daemon, ServiceTest, main, study

HEAD = b"Host: localhost\r\n"


class Probes(ServiceTest):
    """What some HTTP servers take, fired over a raw socket."""

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
        self.assertEqual(
            len(re.findall(rb"(?:^|\n)HTTP/1.1 \d", answer)), 1, "more than one answer: a request was smuggled"
        )
        return int(answer.split()[1])

    def test_chunked_bodies_beyond_the_limit(self):
        chunk = b"4000\r\n" + b"a" * 0x4000 + b"\r\n"
        self.assertEqual(
            self.status(
                b"POST /processes/echo/execution HTTP/1.1\r\n"
                + HEAD
                + b"Transfer-Encoding: chunked\r\n\r\n"
                + chunk * 4
                + b"0\r\n\r\n"
            ),
            411,
        )

    def test_content_length_together_with_chunked(self):
        smuggled = b"GET /healthz HTTP/1.1\r\n" + HEAD + b"\r\n"
        for lines in (
            b"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n",
            b"Transfer-Encoding: chunked\r\nContent-Length: 5\r\n",
        ):
            self.assertEqual(self.status(b"POST / HTTP/1.1\r\n" + HEAD + lines + b"\r\n0\r\n\r\n" + smuggled), 400)

    def test_two_lengths(self):
        self.assertEqual(
            self.status(b"POST / HTTP/1.1\r\n" + HEAD + b"Content-Length: 5\r\nContent-Length: 0\r\n\r\nhello"), 400
        )

    def test_thousands_of_ranges(self):
        ranges = b"Range: bytes=" + b",".join(b"0-" for _ in range(3000)) + b"\r\n"
        answer = self.daemon.raw(b"GET /api HTTP/1.1\r\n" + HEAD + ranges + b"Connection: close\r\n\r\n")
        self.assertTrue(answer.startswith(b"HTTP/1.1 200 "), answer[:100])
        self.assertLess(len(answer), 10 * len(self.daemon.get("/api").body))
        self.assertEqual(
            self.status(b"GET /api HTTP/1.1\r\n" + HEAD + b"Range: bytes=0-0\r\nConnection: close\r\n\r\n"), 200
        )

    def test_line_breaks_hidden_in_header_values(self):
        answer = self.daemon.raw(
            b"GET / HTTP/1.1\r\n" + HEAD + b"X-Request-Id: a%0d%0aSet-Cookie:%20b=c\r\nConnection: close\r\n\r\n"
        )
        self.assertTrue(answer.startswith(b"HTTP/1.1 400 "), answer[:100])
        self.assertNotIn(b"\r\nSet-Cookie", answer)
        for code in (b"%u000d%u000a", b"%0D%0A", b"%00", b"%7f"):
            self.assertEqual(
                self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"Idempotency-Key: a" + code + b"b\r\n\r\n"), 400
            )
        for value in (b"localhost%0d%0aX: y", b"localhost\r\n X: y"):
            self.assertEqual(self.status(b"GET / HTTP/1.1\r\nHost: " + value + b"\r\n\r\n"), 400)

    def test_numbers_and_sizes_of_headers(self):
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"X: y\r\n" * 5000 + b"\r\n"), 431)
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"X: y\r\n" * 100 + b"\r\n"), 431)
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\n" + HEAD + b"X: " + b"y" * 20000), 431)
        self.assertEqual(self.status(b"GET /" + b"a" * 5000 + b" HTTP/1.1\r\n" + HEAD + b"\r\n"), 414)

    def test_bodies_beyond_the_limit(self):
        self.assertEqual(
            self.status(b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + b"Content-Length: 99999999\r\n\r\n"),
            413,
        )
        self.assertEqual(
            self.status(
                b"POST /processes/echo/execution HTTP/1.1\r\n"
                + HEAD
                + b"Content-Length: 99999999999999999999999\r\n\r\n"
            ),
            413,
        )

    def test_deep_and_long_json(self):
        for body in (b"[" * 9000, b'{"a":' * 1500, b'{"inputs":{"s":"' + b"a" * 9000 + b'"}}'):
            self.problem(
                self.daemon.post("/processes/echo/execution", body, headers={"Content-Type": "application/json"}), 400
            )

    def test_what_is_no_http(self):
        for data in (
            b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + os.urandom(200) + b"\r\n\r\n",
            b"hello\r\n\r\n",
            b"GET / HTTP/1.1\nHost: a\n\n\r\n\r\n",
            b"GET / HTTP/9.9\r\n\r\n",
            b"GET / HTTP/1.1\r\n\r\n",
            b"\0\r\n\r\n",
        ):
            self.assertIn(self.status(data), (400, 505), data[:20])

    def test_several_requests_on_one_connection(self):
        one = b"GET /healthz HTTP/1.1\r\n" + HEAD
        answer = self.daemon.raw((one + b"\r\n") * 3 + one + b"Connection: close\r\n\r\n")
        self.assertEqual(answer.count(b"HTTP/1.1 200 OK"), 4)

    def test_empty_lines_before_a_request(self):  # RFC 9112 2.2
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=5) as s:
            for part in (b"\r\n", b"\r", b"\n\r\n", b"GET /healthz HTTP/1.1\r\n" + HEAD + b"\r\n"):
                s.sendall(part)
                time.sleep(0.05)
            self.assertTrue(s.recv(1000).startswith(b"HTTP/1.1 200 "))

    def test_targets_in_absolute_form(self):
        here = b"http://localhost:%d" % self.daemon.port

        def answer(target, host=HEAD, method=b"GET"):
            head = method + b" " + target + b" HTTP/1.1\r\n" + host + b"Connection: close\r\n\r\n"
            return self.daemon.raw(head)

        got = answer(here + b"/processes?limit=1")
        self.assertTrue(got.startswith(b"HTTP/1.1 200 "), got[:200])
        document = json.loads(got.partition(b"\r\n\r\n")[2])
        self.assertEqual(document["links"][0]["href"], f"{here.decode()}/processes?limit=1")
        self.assertTrue(answer(here).startswith(b"HTTP/1.1 200 "))
        self.assertTrue(answer(here + b"/nothing").startswith(b"HTTP/1.1 404 "))
        for target in (b"http://evil.example/", b"http://localhost.evil.example/"):
            self.assertTrue(answer(target).startswith(b"HTTP/1.1 403 "), target)
        self.assertTrue(answer(here + b"/", b"Host: evil.example\r\n").startswith(b"HTTP/1.1 403 "))
        for target in (b"http:///jobs", b"http://user@localhost/", b"https://localhost/", b"ftp://localhost/", b"*"):
            self.assertTrue(answer(target).startswith(b"HTTP/1.1 400 "), target)
        one = b"GET " + here + b"/healthz HTTP/1.1\r\n" + HEAD
        self.assertEqual(self.daemon.raw(one + b"\r\n" + one + b"Connection: close\r\n\r\n").count(b"200 OK"), 2)

    def test_options_of_the_server(self):
        for target in (b"*", b"http://localhost"):
            answer = self.daemon.raw(b"OPTIONS " + target + b" HTTP/1.1\r\n" + HEAD + b"Connection: close\r\n\r\n")
            self.assertTrue(answer.startswith(b"HTTP/1.1 204 "), answer[:200])
            self.assertIn(b"\r\nAllow: GET, HEAD, POST, DELETE, OPTIONS\r\n", answer)

    def test_heads_say_when_and_how_long(self):  # RFC 9110 6.6.1 and 8.6
        def head(line, more=b""):
            answer = self.daemon.raw(line + b" HTTP/1.1\r\n" + HEAD + more + b"Connection: close\r\n\r\n")
            status, _, rest = answer.partition(b"\r\n")
            headers = email.message_from_bytes(rest)
            age = datetime.datetime.now(datetime.timezone.utc) - email.utils.parsedate_to_datetime(headers["Date"])
            self.assertLess(abs(age.total_seconds()), 10)
            self.assertTrue(headers["Date"].endswith(" GMT"))
            return int(status.split()[1]), headers

        body = b'{"inputs": {"s": "a", "pause": 9}}'
        headers = b"Prefer: respond-async\r\nContent-Length: %d\r\n" % len(body)
        post = b"POST /processes/echo/execution HTTP/1.1\r\n" + HEAD + headers + b"Connection: close\r\n\r\n" + body
        job = json.loads(self.daemon.raw(post).partition(b"\r\n\r\n")[2])["jobID"].encode()
        length = str(len(self.daemon.get("/api").body))
        for line, more, status, expected in (
            (b"GET /api", b"", 200, length),
            (b"HEAD /api", b"", 200, length),
            (b"GET /api", b"If-None-Match: *\r\n", 304, None),
            (b"OPTIONS /api", b"", 204, None),
            (b"HEAD /jobs/" + job + b"/events", b"", 200, None),  # a stream has no length
        ):
            got, headers = head(line, more)
            self.assertEqual((got, headers["Content-Length"]), (status, expected), line)
        self.assertEqual((headers["Content-Type"], headers["ETag"]), ("text/event-stream", None))
        for line, more, status in ((b"GET /nothing", b"", 404), (b"GET nothing", b"", 400)):
            got, headers = head(line, more)
            self.assertEqual(got, status)
            self.assertGreater(int(headers["Content-Length"]), 0)

    def test_request_ids_are_given_back_if_they_are_fit_for_a_log(self):
        def given_back(value):
            return self.daemon.get("/", headers={"X-Request-Id": value}).headers["X-Request-Id"]

        self.assertEqual(given_back("Job-7_a.b"), "Job-7_a.b")
        for value in ("a b", '"},{"', "a" * 65, "<script>"):
            self.assertRegex(given_back(value), "^[0-9a-f]{16}$")
        self.assertRegex(self.daemon.get("/").headers["X-Request-Id"], "^[0-9a-f]{16}$")

    def test_refusals_are_logged(self):
        self.status(b"POST / HTTP/1.1\r\n" + HEAD + b"Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n")
        lines = [json.loads(line) for line in self.daemon.log_text().splitlines() if line.startswith("{")]
        self.assertIn(411, [line["status"] for line in lines if line["event"] == "refused"])

    def test_expect_continue(self):
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=5) as s:
            s.sendall(
                b"POST /processes/echo/execution HTTP/1.1\r\n"
                + HEAD
                + b"Content-Length: 22\r\nExpect: 100-continue\r\nConnection: close\r\n\r\n"
            )
            self.assertEqual(s.recv(100), b"HTTP/1.1 100 Continue\r\n\r\n")
            s.sendall(b'{"inputs": {"s": "a"}}')
            self.assertTrue(s.recv(1000).startswith(b"HTTP/1.1 200 "))

    def test_names_that_are_not_loopback(self):
        self.assertEqual(self.status(b"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), 403)
        self.assertEqual(
            self.status(
                b"POST /processes/echo/execution HTTP/1.1\r\n"
                + HEAD
                + b"Origin: http://evil.example\r\nContent-Length: 0\r\n\r\n"
            ),
            403,
        )

    def test_nothing_from_a_request_reaches_a_command_line(self):
        seen = self.dir / "seen"
        fake = self.dir / "talus"
        fake.write_text(
            f'#!/bin/sh\nfor a in "$@"; do printf "%s\\n" "$a" >> {seen}; done\nenv >> {seen}\nexec {TALUS} "$@"\n'
        )
        fake.chmod(0o755)
        self.daemon.stop()
        self.daemon = Daemon(
            self.dir / "data", "--talus", fake, environment=dict(os.environ, SECRET_OF_THE_SERVER="s3cr3t")
        )
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
        for path in (
            "/jobs/../../etc/passwd",
            "/jobs/..%2f..%2fqueue.sqlite",
            "/jobs/%2e%2e/results",
            "/processes/..%2f..",
            "/jobs/%00",
        ):
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

    def drip(self, begun):
        """Sends a byte twice a second. @return what came back, and after how long"""
        begin = time.monotonic()
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=30) as s:
            s.sendall(begun)
            s.settimeout(0.5)
            answer = b""
            while time.monotonic() - begin < 25 and not answer:
                try:
                    s.send(b"a")
                    answer = s.recv(1000)
                except TimeoutError:
                    pass
        return answer, time.monotonic() - begin

    def test_a_slow_head_or_slow_body_is_cut_off(self):
        """Dripping bytes keeps no place for longer than the whole request may take."""
        self.start()
        slow = {"head": b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ",
                "body": b"POST /processes/echo/execution HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n"}
        with concurrent.futures.ThreadPoolExecutor() as pool:
            ended = dict(zip(slow, pool.map(self.drip, slow.values())))
        for what, (answer, seconds) in ended.items():
            self.assertTrue(answer.startswith(b"HTTP/1.1 408 "), (what, answer[:100]))
            self.assertLess(seconds, 20, what)

    def test_waiting_for_events_is_capped(self):
        self.start("--max-streams", 3)
        reply = self.daemon.post(
            "/processes/echo/execution", {"inputs": {"s": "a", "pause": 30}}, headers={"Prefer": "respond-async"}
        )
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
        self.problem(self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a", "pause": 0.1}}), 503)
        self.assertEqual(self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a"}}).status, 200)
        for s in held:
            s.close()
        deadline = time.monotonic() + 15
        while self.daemon.get(path + "?wait=0").status != 200 and time.monotonic() < deadline:
            time.sleep(0.2)
        self.assertEqual(self.daemon.get(path + "?wait=0").status, 200)


if __name__ == "__main__":
    main({"Probes": Probes, "SlowClients": SlowClients})
