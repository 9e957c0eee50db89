#!/usr/bin/env python3
"""Who is let in, by which name, from which page; and the token file."""

import base64
import json
import os
import pathlib
import signal
import socket
import subprocess
import time

from attacks import ECHO
from daemon import TALUSD, Daemon, ServiceTest, main, study, workers_of


def new_token(role, subject, *expires):
    """@return the token, and its line for the file"""
    said = subprocess.run([TALUSD, "--new-token", role, subject, *expires], capture_output=True, text=True, check=True)
    token, line = said.stdout.splitlines()
    return token.split()[-1], line.split(": ", 1)[1] + "\n"


class Doors(ServiceTest):
    def status(self, method, path, body=None, **headers):
        return self.daemon.request(method, path, body, {k.replace("_", "-"): v for k, v in headers.items()}).status

    def test_other_sites_whatever_the_configuration(self):
        """A public URL opens nothing; nor does a type of content for which browsers ask nobody."""
        body = json.dumps({"inputs": {"s": "a"}})
        for options in ((), ("--public-url", "https://talus.example.org")):
            self.start(*options)
            here = f"http://127.0.0.1:{self.daemon.port}"
            for method, path, sent in (("POST", ECHO, body), ("GET", "/jobs", None), ("GET", "/metrics", None),
                                       ("GET", "/jobs/x/realizations/0/profile", None), ("DELETE", "/jobs/x", None),
                                       ("POST", "/Evaluate", "{}"), ("OPTIONS", "/jobs", None)):
                for origin in ("http://evil.example", "null", here + "1"):
                    self.assertEqual(self.status(method, path, sent, Origin=origin), 403, (method, path, origin))
                for site in ("cross-site", "same-site"):
                    self.assertEqual(self.status(method, path, sent, Sec_Fetch_Site=site), 403, (method, path, site))
                self.assertEqual(self.status(method, path, sent, Host="evil.example"), 403, (method, path))
            for content_type in ("text/plain; x=json", "text/plain", "application/jsonp", "multipart/form-data; json"):
                self.assertEqual(self.status("POST", ECHO, body, Content_Type=content_type), 415, content_type)
            for content_type in ("application/json", "Application/JSON; charset=utf-8", "application/geo+json", ""):
                self.assertEqual(
                    self.status("POST", ECHO, body, Content_Type=content_type, Origin=here, Sec_Fetch_Site="same-origin"),
                    200, content_type)
            self.daemon.stop()

    def test_names(self):
        self.start("--public-url", "https://talus.example.org/x", "--host", "second.example")
        for name in ("talus.example.org", "second.example:80", "localhost", "127.0.0.1"):
            self.assertEqual(self.status("GET", "/jobs", Host=name), 200, name)
        for name in ("talus.example.org.evil.example", "example.org", "127.0.0.2"):
            self.assertEqual(self.status("GET", "/jobs", Host=name), 403, name)

    def test_no_name_of_a_client_comes_back(self):
        """Neither with tokens, nor under an Idempotency-Key."""
        token, line = new_token("submit", "anna")
        (self.dir / "tokens").write_text(line)
        self.start("--tokens", self.dir / "tokens")
        headers = {"Host": "evil.example", "Idempotency-Key": "one"}
        self.problem(self.daemon.post("/processes/influence-zone/execution", study(1), headers=headers, token=token), 403)
        del headers["Host"]
        reply = self.daemon.post("/processes/influence-zone/execution", study(1), headers=headers, token=token)
        self.assertTrue(reply.headers["Location"].startswith(self.daemon.url + "/jobs/"))
        self.assertNotIn(b"evil", reply.body)

    def test_what_a_browser_renders_can_do_nothing(self):
        self.start()
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        field = f"/jobs/{job}/realizations/0/field"
        for path in ("/", f"{field}?format=svg", field, "/nothing", "/metrics"):
            headers = self.daemon.get(path).headers
            self.assertIn("default-src 'none'", headers["Content-Security-Policy"], path)
            self.assertIn("sandbox", headers["Content-Security-Policy"], path)
            self.assertEqual(headers["X-Content-Type-Options"], "nosniff", path)
        answer = self.daemon.raw(b"nonsense\r\n\r\n")
        self.assertIn(b"Content-Security-Policy", answer)

    def test_workers_inherit_no_client(self):
        self.start()
        clients = [socket.create_connection(("127.0.0.1", self.daemon.port)) for _ in range(100)]
        job = self.daemon.submit(study(200, spacing=0.5))
        self.daemon.wait_for(job, ("running",))
        seen, deadline = 0, time.monotonic() + 60
        while seen < 3 and time.monotonic() < deadline:
            for pid in workers_of(self.daemon.data):
                try:
                    links = [os.readlink(entry) for entry in pathlib.Path(f"/proc/{pid}/fd").iterdir()]
                except OSError:
                    continue
                self.assertEqual([link for link in links if link.startswith("socket:")], [])
                seen += 1
        self.assertGreaterEqual(seen, 3)
        for client in clients:
            client.close()


class TokenFile(ServiceTest):
    def setUp(self):
        super().setUp()
        self.tokens = self.dir / "tokens"

    def reload(self, event):
        """SIGHUP, and waits until the log has the event once more."""
        log = self.dir / "talusd.log"
        before = log.read_text().count(f'"{event}"')
        self.daemon.process.send_signal(signal.SIGHUP)
        deadline = time.monotonic() + 30
        while log.read_text().count(f'"{event}"') == before:
            self.assertLess(time.monotonic(), deadline, event)
            time.sleep(0.01)

    def test_hangup_reads_it_again(self):
        old, old_line = new_token("submit", "anna")
        new, new_line = new_token("submit", "anna")
        self.tokens.write_text(old_line)
        self.start("--tokens", self.tokens)
        job = self.daemon.submit(study(1), token=old)
        self.tokens.write_text(new_line)
        self.reload("tokens_reloaded")
        self.assertEqual(self.daemon.get("/jobs", token=old).status, 401)
        self.assertEqual(self.daemon.get(f"/jobs/{job}", token=new).status, 200)
        self.tokens.write_text("nonsense\n")
        self.reload("tokens_not_reloaded")
        self.tokens.unlink()
        self.reload("tokens_not_reloaded")
        self.assertEqual(self.daemon.get(f"/jobs/{job}", token=new).status, 200)
        self.assertEqual(self.daemon.stop(), 0)

    def test_hangup_without_tokens(self):
        self.start()
        self.reload("hangup")
        self.assertEqual(self.daemon.get("/jobs").status, 200)

    def test_expiry(self):
        past, past_line = new_token("read", "anna", "2020-01-01T00:00:00Z")
        future, future_line = new_token("read", "anna", "2999-01-01T00:00:00+01:00")
        self.tokens.write_text(past_line + future_line)
        self.start("--tokens", self.tokens)
        self.assertEqual(self.daemon.get("/jobs", token=past).status, 401)
        self.assertEqual(self.daemon.get("/jobs", token=future).status, 200)

    def test_basic(self):
        token, line = new_token("submit", "anna")
        self.tokens.write_text(line)
        self.start("--tokens", self.tokens)
        for user, password, status in (("anna", token, 200), ("", token, 200), ("anna", "x", 401), (token, "", 401)):
            coded = base64.b64encode(f"{user}:{password}".encode()).decode()
            self.assertEqual(self.daemon.get("/jobs", headers={"Authorization": "Basic " + coded}).status, status)
        self.assertNotIn(token, (self.dir / "talusd.log").read_text())

    def exit_code(self):
        refused = Daemon(self.dir / "data", "--tokens", self.tokens, wait=False)
        code = refused.process.wait(30)
        refused.close()
        return code

    def test_exit_codes(self):
        self.assertEqual(self.exit_code(), 5)  # there is none
        self.tokens.write_text("submit anna secret\n")
        self.assertEqual(self.exit_code(), 2)
        self.tokens.write_text(new_token("submit", "anna")[1])
        self.tokens.chmod(0o602)
        self.assertEqual(self.exit_code(), 2)
        self.assertIn("every user of this machine may write it", (self.dir / "talusd.log").read_text())
        self.tokens.chmod(0o600)
        self.start("--tokens", self.tokens)
        for values in (("submit", "a b"), ("admin", "anna"), ("read", "anna", "tomorrow")):
            self.assertEqual(subprocess.run([TALUSD, "--new-token", *values], capture_output=True).returncode, 2)


if __name__ == "__main__":
    main({"Doors": Doors, "TokenFile": TokenFile})
