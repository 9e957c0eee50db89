#!/usr/bin/env python3
"""What many requests at once may take: one thing is made once, few wait, documents and inputs take bounded memory."""
import concurrent.futures
import json
import socket
import time

from daemon import TALUS, ServiceTest, case, main, study

OBJECTS = "[" + ",".join(["{}"] * 400_000) + "]"  # 1.2 MB


class Shares(ServiceTest):
    workers = 1  # one run outside the queue at a time

    def setUp(self):
        super().setUp()
        self.gate, self.runs = self.dir / "gate", self.dir / "runs"
        self.runs.write_text("")
        fake = self.dir / "talus"  # as talus, but runs outside the queue are noted, and wait while the gate is there
        fake.write_text(
            f'#!/bin/sh\ncase "$*" in run*scratch*) echo run >> {self.runs};'
            f' while [ -e {self.gate} ]; do sleep 0.05; done;; esac\nexec {TALUS} "$@"\n'
        )
        fake.chmod(0o755)
        models = self.dir / "models"
        models.mkdir()
        document = case()
        document["random_field"]["terms"] = 2
        (models / "slope.json").write_text(json.dumps(document))
        self.start("--talus", fake, "--max-streams", 16, "--models", models)

    def made(self):
        return len(self.runs.read_text().split())

    def wait_until(self, holds, seconds=60):
        deadline = time.monotonic() + seconds
        while not holds():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    def test_a_profile_is_made_once_for_all_who_ask(self):
        job = self.daemon.submit(study(2))
        self.daemon.wait_for(job)
        path = f"/jobs/{job}/realizations/0/profile"
        self.gate.write_text("")
        with concurrent.futures.ThreadPoolExecutor(40) as pool:
            replies = [pool.submit(self.daemon.get, path) for _ in range(40)]
            self.wait_until(lambda: self.made() == 1 and sum(reply.done() for reply in replies) == 40 - 16)
            self.gate.unlink()
        replies = [reply.result() for reply in replies]
        self.assertEqual(sorted(reply.status for reply in replies), [200] * 16 + [503] * 24)
        self.assertEqual({reply.headers["Retry-After"] for reply in replies if reply.status == 503}, {"5"})
        self.assertEqual(len({reply.body for reply in replies if reply.status == 200}), 1)
        self.assertEqual(self.daemon.get(path).status, 200)
        self.assertEqual(self.made(), 1)

    def test_evaluations_wait_for_one_another(self):
        def evaluate(i):
            return self.daemon.post("/Evaluate", {"name": "slope", "input": [[i / 10, 0.5]]})

        self.gate.write_text("")
        with concurrent.futures.ThreadPoolExecutor(20) as pool:
            replies = [pool.submit(evaluate, i % 10) for i in range(20)]
            self.wait_until(lambda: self.made() == 1 and sum(reply.done() for reply in replies) == 20 - 16)
            self.gate.unlink()
        replies = [reply.result() for reply in replies]
        self.assertEqual(sorted(reply.status for reply in replies), [200] * 16 + [503] * 4)
        for reply in replies:
            if reply.status == 200:
                self.assertEqual(set(reply.json), {"output"})
            else:
                self.assertEqual(reply.json["error"]["type"], "InvalidOutput")
                self.assertIn("too many requests that wait", reply.json["error"]["message"])
                self.assertEqual(reply.headers["Retry-After"], "5")
        self.assertLessEqual(self.made(), 10)

    def test_an_evaluation_ends_when_its_client_leaves(self):
        self.gate.write_text("")
        body = json.dumps({"name": "slope", "input": [[0.1, 0.5]]})
        head = f"POST /Evaluate HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(body)}\r\n\r\n"
        with socket.create_connection(("127.0.0.1", self.daemon.port)) as client:
            client.sendall((head + body).encode())
            self.wait_until(lambda: self.made() == 1)
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            other = pool.submit(self.daemon.post, "/Evaluate", {"name": "slope", "input": [[0.2, 0.5]]})
            self.wait_until(lambda: self.made() == 2)  # it has the place of the first, whose gate is still shut
            self.gate.unlink()
            self.assertEqual(set(other.result().json), {"output"})

    def test_echo_jobs_leave_no_trace(self):
        body = {"inputs": {"s": "x", "pause": 60, "o": {"a": ["y" * 4000] * 500}}}
        prefer = {"Prefer": "respond-async"}
        jobs = [self.daemon.post("/processes/echo/execution", body, headers=prefer).json["jobID"] for _ in range(8)]

        def size():
            return sum(path.stat().st_size for path in self.daemon.data.glob("queue.sqlite*"))

        self.assertGreater(size(), 16_000_000)
        self.assertLess(len(self.daemon.get("/jobs").body), 20_000)
        for job in jobs:
            self.daemon.request("DELETE", f"/jobs/{job}")
        self.daemon.wait_for(jobs[0], ("dismissed",))
        done = {"inputs": {"s": "x", "pause": 0.1}}
        job = self.daemon.post("/processes/echo/execution", done, headers=prefer).json["jobID"]
        self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
        self.assertEqual(self.daemon.get(f"/jobs/{job}/results").json, {"s": "x"})

        def small():
            self.daemon.post("/processes/echo/execution", done, headers=prefer)  # the log shrinks when it is next written
            return (self.daemon.data / "queue.sqlite").stat().st_size < 5_000_000

        self.wait_until(small)

    def test_documents_of_many_objects(self):
        self.problem(self.daemon.post("/processes/echo/execution", OBJECTS), 400)
        document = self.problem(self.daemon.post("/processes/echo/execution", OBJECTS[:-1] + "," + OBJECTS[1:]), 400)
        self.assertEqual(document["errors"][0]["message"], "the document holds more than 500000 values")

    def test_a_large_echo_does_not_wait(self):
        """While it waits, it would keep other large requests from the threads that read them."""
        body = {"inputs": {"s": "x", "pause": 60, "o": {"a": ["y" * 4000] * 100}}}
        document = self.problem(self.daemon.post("/processes/echo/execution", body), 400)
        self.assertEqual([fault["pointer"] for fault in document["errors"]], ["/inputs/pause"])


if __name__ == "__main__":
    main({"Shares": Shares})
