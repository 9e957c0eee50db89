#!/usr/bin/env python3
"""Who may do what."""
import json
import subprocess
import time

from daemon import TALUSD, ServiceTest, main, study


class Authorisation(ServiceTest):
    """Who may do what: tokens of two subjects and two roles, and none."""

    options = ("--max-jobs-each", 2)

    def setUp(self):
        super().setUp()
        self.tokens, lines = {}, []
        for name, role, subject in (
            ("anna", "submit", "anna"),
            ("anna-reads", "read", "anna"),
            ("ben", "submit", "ben"),
        ):
            out = subprocess.run(
                [TALUSD, "--new-token", role, subject], capture_output=True, text=True, check=True
            ).stdout.splitlines()
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
            (("GET", "/", None), anyone),
            (("GET", "/processes/echo", None), anyone),
            (("GET", "/metrics", None), anyone),
            (("GET", "/jobs", None), anyone),
            (("GET", "/nothing", None), (401, 404, 404, 404)),
            (("GET", "/healthz", None), (200, 200, 200, 200)),
            (("GET", "/readyz", None), (200, 200, 200, 200)),
            (execution, (401, 200, 403, 200)),
            (("GET", f"/jobs/{job}", None), own),
            (("GET", f"/jobs/{job}/results", None), own),
            (("GET", f"/jobs/{job}/histogram", None), own),
            (("GET", f"/jobs/{job}/realizations", None), own),
            (("GET", f"/jobs/{job}/realizations/0", None), own),
            (("GET", f"/jobs/{job}/realizations/0/field", None), own),
            (("GET", f"/jobs/{job}/realizations/0/profile", None), own),
            (("GET", f"/jobs/{job}/events?wait=0", None), own),
            (("POST", f"/jobs/{job}/retry", None), submit),
            (("POST", f"/jobs/{job}/extend", {"realizations": 1}), submit),
            (("POST", "/Evaluate", {"name": "x"}), (401, 400, 403, 400)),
            (("GET", "/Info", None), anyone),
        ]
        for (method, path, body), expected in table + [(("DELETE", f"/jobs/{job}", None), (401, None, 403, 404))]:
            for who, status in zip((None, "anna", "anna-reads", "ben"), expected):
                if status is None:
                    continue
                reply = self.daemon.request(method, path, body, token=self.tokens.get(who))
                self.assertEqual(reply.status, status, (method, path, who, reply.body))
                if status == 401:
                    self.assertEqual(reply.headers["WWW-Authenticate"], 'Bearer, Basic realm="talusd"')
        self.assertEqual(self.daemon.get("/jobs", token=self.tokens["ben"]).json["jobs"], [])
        self.assertEqual(
            [j["jobID"] for j in self.daemon.get("/jobs", token=self.tokens["anna-reads"]).json["jobs"]], [job]
        )
        self.assertEqual(self.daemon.request("DELETE", f"/jobs/{job}", token=self.tokens["anna"]).status, 200)

    def test_the_scheme_is_known_in_any_case(self):  # RFC 9110 11.1
        for scheme, status in (("Bearer", 200), ("bearer", 200), ("BEARER", 200), ("Basic", 401), ("Bear", 401)):
            reply = self.daemon.get("/jobs", headers={"Authorization": f"{scheme} {self.tokens['anna']}"})
            self.assertEqual(reply.status, status, scheme)

    def test_keys_of_two_subjects_do_not_meet(self):
        headers = {"Idempotency-Key": "same", "Prefer": "respond-async"}
        for who, text in (("anna", "a"), ("ben", "b")):
            reply = self.daemon.post(
                "/processes/echo/execution", {"inputs": {"s": text}}, headers=headers, token=self.tokens[who]
            )
            self.assertEqual(reply.status, 201)

    def test_every_subject_has_a_queue_of_its_own(self):
        slow = {"inputs": {"s": "a", "pause": 60}}
        for who, status in (("anna", 201), ("anna", 201), ("anna", 429), ("ben", 201), ("ben", 201), ("ben", 429)):
            reply = self.daemon.post(
                "/processes/echo/execution", slow, headers={"Prefer": "respond-async"}, token=self.tokens[who]
            )
            self.assertEqual(reply.status, status, who)
        self.assertIn("of yours 2 jobs", reply.json["detail"])

    def test_the_line_in_the_tokens_file_is_no_token(self):
        for line in (self.dir / "tokens").read_text().splitlines():
            self.assertEqual(self.daemon.get("/jobs", token=line.split()[-1]).status, 401)

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
        done = subprocess.run(
            [TALUSD, "--data", str(self.dir / "other"), "--listen", "0.0.0.0:0"], capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 2)
        self.assertIn("--tokens", done.stderr)


if __name__ == "__main__":
    main({"Authorisation": Authorisation})
