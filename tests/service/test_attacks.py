#!/usr/bin/env python3
"""Clients that take what they can do not keep the operator and the next client from the service."""

import select
import socket
import subprocess
import time

from attacks import ATTACKS, ECHO, LONG_STRING, asked, get, peak_memory, post, under
from daemon import SANITIZED, TALUS, TALUSD, Daemon, ServiceTest, main, study

SECONDS = 1.5
SHORT = {"inputs": {"s": "a", "pause": 0.01}}
PATIENCE = 30.0  # against hanging; how fast the answers come is measured by attacks.py


class Attacks(ServiceTest):
    """A test for each of attacks.ATTACKS."""

    def check(self, name):
        self.start()
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        with under(name, self.daemon.port, job):
            end, rounds = time.monotonic() + SECONDS, 0
            while time.monotonic() < end or rounds < 3:
                for path in ("/healthz", "/readyz", "/metrics"):
                    took, wrong = asked(self.daemon.port, path, PATIENCE)
                    self.assertIsNone(wrong, f"after {took:.1f} s")
                rounds += 1
        self.assertEqual(self.daemon.get(f"/jobs/{job}").json["status"], "successful")

    def test_memory_of_large_bodies(self):
        """What is beyond --max-traffic is refused."""
        for name in ("bodies of 4 MiB", "bodies of 4 MiB of {}"):
            self.start()
            with under(name, self.daemon.port, ""):
                time.sleep(3)
            if not SANITIZED:
                self.assertLess(peak_memory(self.daemon.process.pid), 200, name)
            self.daemon.stop()


for number, (attack, (clients, _)) in enumerate(ATTACKS.items()):
    if clients:
        setattr(Attacks, f"test_{number}_{attack.replace(' ', '_')}", lambda self, name=attack: self.check(name))


class Limits(ServiceTest):
    """What one client may take."""

    def connect(self, sent=b""):
        s = socket.create_connection(("127.0.0.1", self.daemon.port), timeout=20)
        self.addCleanup(s.close)
        s.sendall(sent)
        return s

    def hold(self, request, count, **token):
        """Sends `count` requests that wait, until a short one beside them is refused; their connections and the refusal."""
        held = [self.connect(request) for _ in range(count)]
        while (reply := self.daemon.post(ECHO, SHORT, **token)).status == 200:
            for k, s in enumerate(held):
                if select.select([s], [], [], 0.02)[0]:  # a short one came first, and this one was refused
                    held[k] = self.connect(request)
        return held, reply

    def test_the_oldest_idle_connection_gives_way(self):
        self.start("--max-connections", 16, "--max-connections-each", 16)
        idle = [self.connect(get("/healthz")) for _ in range(16)]
        for s in idle:
            self.assertTrue(s.recv(4096).startswith(b"HTTP/1.1 200 "))
        self.assertEqual(self.daemon.get("/healthz").status, 200)
        self.assertEqual(idle[0].recv(10), b"")
        idle[15].sendall(get("/healthz"))
        self.assertTrue(idle[15].recv(4096).startswith(b"HTTP/1.1 200 "))

    def test_requests_under_way_give_way_to_the_operator_alone(self):
        self.start("--max-connections", 16, "--max-connections-each", 16)
        held = [self.connect(post(ECHO, b'{"inputs": {"s": "a", "pause": 4}}')) for _ in range(16)]
        time.sleep(0.5)
        self.assertTrue(self.connect(get("/jobs")).recv(4096).startswith(b"HTTP/1.1 503 "))
        for _ in range(100):
            self.connect()
        for path in ("/healthz", "/readyz", "/metrics"):
            self.assertTrue(self.connect(get(path)).recv(4096).startswith(b"HTTP/1.1 200 "), path)
        for s in held:
            self.assertTrue(s.recv(4096).startswith(b"HTTP/1.1 200 "))

    def test_connections_of_one_address(self):
        self.start("--max-connections-each", 3)
        held = []
        for _ in range(4):
            held.append(self.connect(get("/healthz")))
            self.assertTrue(held[-1].recv(4096).startswith(b"HTTP/1.1 200 "))
        self.assertEqual(held[0].recv(10), b"")

    def test_bodies_of_all_requests_together(self):
        self.start("--max-body", 1, "--max-traffic", 1)
        half = post(ECHO, b"a" * 600_000, 1_000_000)
        first, second = self.connect(half), self.connect(half)
        answers = []
        for s in (second, first):
            s.settimeout(1)
            try:
                answers.append(s.recv(4096)[:12])
            except TimeoutError:
                answers.append(b"")
        self.assertEqual(sorted(answers), [b"", b"HTTP/1.1 503"])
        self.assertEqual(self.daemon.get("/healthz").status, 200)

    def test_a_body_without_a_token_is_not_read(self):
        line = subprocess.run([TALUSD, "--new-token", "submit", "anna"], capture_output=True, text=True).stdout
        (self.dir / "tokens").write_text(line.split("file: ")[1])
        self.start("--tokens", self.dir / "tokens")
        s = self.connect(post(ECHO, b"", len(LONG_STRING)))  # the head alone
        self.assertTrue(s.recv(4096).startswith(b"HTTP/1.1 401 "))

    def test_work_ends_when_its_client_leaves(self):
        """A wait of 60 s frees its place."""
        self.start("--max-streams", 1)
        held, _ = self.hold(post(ECHO, b'{"inputs": {"s": "a", "pause": 60}}'), 1)
        held[0].close()
        deadline = time.monotonic() + 30
        while (status := self.daemon.post(ECHO, SHORT).status) == 503 and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertEqual(status, 200)

    def test_streams_of_one_subject(self):
        tokens, lines = [], []
        for subject in ("anna", "ben"):
            said = subprocess.run([TALUSD, "--new-token", "submit", subject], capture_output=True, text=True).stdout
            tokens.append(said.split()[1])
            lines.append(said.split("file: ")[1])
        (self.dir / "tokens").write_text("".join(lines))
        self.start("--tokens", self.dir / "tokens", "--max-streams", 4, "--max-streams-each", 2)
        wait = b'{"inputs": {"s": "a", "pause": 20}}'
        request = post(ECHO, wait).replace(b"\r\n\r\n", b"\r\nAuthorization: Bearer %s\r\n\r\n" % tokens[0].encode())
        _, reply = self.hold(request, 2, token=tokens[0])
        self.problem(reply, 503)
        self.assertEqual(self.daemon.post(ECHO, SHORT, token=tokens[1]).status, 200)

    def test_starts_with_little(self):
        """512 MiB of address space and 100 processes."""
        if SANITIZED:
            self.skipTest("sanitizers reserve terabytes of address space")
        limited = self.dir / "talusd"
        limited.write_text(f'#!/bin/sh\nexec prlimit --as={512 << 20} --nproc=100 {TALUSD} "$@"\n')
        limited.chmod(0o755)
        self.daemon = Daemon(self.dir / "data", program=limited)
        job = self.daemon.submit(study(2))
        self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
        with under("bodies of 4 MiB", self.daemon.port, ""):
            for _ in range(5):
                self.assertIsNone(asked(self.daemon.port, "/healthz", PATIENCE)[1])
        self.assertIsNone(self.daemon.process.poll())
        self.assertEqual(self.daemon.get(f"/jobs/{job}").status, 200)

    def test_says_why_it_does_not_start(self):
        """With more and more address space: the loader fails, then talusd does, with a reason, then it starts."""
        if SANITIZED:
            self.skipTest("sanitizers reserve terabytes of address space")
        reasons = []
        for megabytes in range(12, 300, 2):
            limited = subprocess.Popen(
                ["prlimit", f"--as={megabytes * 1_000_000}", TALUSD, "--data", str(self.dir / "data"), "--talus", str(TALUS),
                 "--listen", "127.0.0.1:0"],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            started = "listens" in limited.stdout.readline()
            if started:
                limited.kill()
            said, code = limited.communicate()[1], limited.returncode
            if started:
                break
            self.assertIn(code, (5, 127), said)
            reasons += [said] if code == 5 else []
        self.assertTrue(started)
        self.assertTrue(reasons)
        for said in reasons:
            self.assertRegex(said, "talusd: .*(memory|no thread)")


if __name__ == "__main__":
    main({"Attacks": Attacks, "Limits": Limits})
