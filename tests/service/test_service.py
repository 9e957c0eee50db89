#!/usr/bin/env python3
"""talusd from outside: the API, the queue, crashes.  usage: test_service.py TALUSD SOURCE_DIR GROUP [test names]"""
import json
import os
import random
import signal
import socket
import subprocess
import threading
import time

from daemon import SOURCE, TALUS, TALUSD, Daemon, ServiceTest, case, digests, main, study, workers_of

OGC = "http://www.opengis.net/def/"
EXCEPTION = OGC + "exceptions/ogcapi-processes-1/1.0/"


class Ogc(ServiceTest):
    """What the standard asks for, word by word."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()

    def setUp(self):
        super().setUp()
        self.start()

    def test_landing_page_links_to_everything(self):
        page = self.daemon.get("/").json
        links = {link["rel"]: link["href"] for link in page["links"]}
        for rel in ("service-desc", OGC + "rel/ogc/1.0/conformance", OGC + "rel/ogc/1.0/processes", OGC + "rel/ogc/1.0/job-list"):
            reply = self.daemon.get(links[rel])
            self.assertEqual(reply.status, 200, rel)
            reply.json
        self.assertEqual(self.daemon.get("/api").headers["Content-Type"], "application/vnd.oai.openapi+json;version=3.0")

    def test_conformance(self):
        classes = self.daemon.get("/conformance").json["conformsTo"]
        for name in ("core", "json", "oas30", "job-list", "dismiss", "ogc-process-description"):
            self.assertIn("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/" + name, classes)

    def test_process_descriptions_use_plain_schemas(self):
        forbidden = {"examples", "const", "$schema"}

        def walk(value, inside_all_of=False):
            if isinstance(value, dict):
                self.assertFalse(forbidden & value.keys(), value)
                self.assertFalse(inside_all_of and "$ref" in value)
                self.assertNotIsInstance(value.get("exclusiveMinimum", True), (int, float)) if "exclusiveMinimum" in value else None
                for key, member in value.items():
                    walk(member, key == "allOf")
            elif isinstance(value, list):
                for member in value:
                    walk(member, inside_all_of)

        processes = self.daemon.get("/processes").json["processes"]
        self.assertEqual([p["id"] for p in processes], ["influence-zone", "echo"])
        for summary in processes:
            description = self.daemon.get("/processes/" + summary["id"]).json
            walk(description)
            for member in ("id", "version", "jobControlOptions", "outputTransmission", "inputs", "outputs"):
                self.assertIn(member, description)
        echo = self.daemon.get("/processes/echo").json
        self.assertEqual(list(echo["inputs"]), ["s", "pause", "a", "b", "o", "m", "x"])
        self.assertEqual(echo["inputs"]["b"]["schema"], {"allOf": [{"format": "ogc-bbox"}]})
        self.assertEqual(list(echo["outputs"]), ["s", "x"])
        self.problem(self.daemon.get("/processes/none"), 404, EXCEPTION + "no-such-process")
        self.problem(self.daemon.post("/processes/none/execution", {"inputs": {}}), 404, EXCEPTION + "no-such-process")

    def test_a_study_from_submission_to_results(self):
        reply = self.daemon.post("/processes/influence-zone/execution", study(noise_floor_replicates=2))
        self.assertEqual(reply.status, 201)
        location = reply.headers["Location"]
        self.assertTrue(location.startswith("http://127.0.0.1:"), location)
        info = reply.json
        self.assertEqual(location, f"{self.daemon.url}/jobs/{info['jobID']}")
        for member in ("jobID", "processID", "type", "status", "message", "created", "updated", "progress", "links"):
            self.assertIn(member, info)
        self.assertEqual((info["type"], info["processID"]), ("process", "influence-zone"))
        self.assertNotIn("finished", info)
        self.assertIn("monitor", [link["rel"] for link in info["links"]])
        self.assertNotIn(OGC + "rel/ogc/1.0/results", [link["rel"] for link in info["links"]])
        early = self.daemon.get(location + "/results")
        if early.status != 200:
            self.problem(early, 404, EXCEPTION + "result-not-ready")

        ended = self.daemon.wait_for(info["jobID"])
        self.assertEqual((ended["status"], ended["progress"]), ("successful", 100))
        self.assertIn("finished", ended)
        rels = [link["rel"] for link in ended["links"]]
        self.assertIn(OGC + "rel/ogc/1.0/results", rels)
        self.assertNotIn("monitor", rels)
        results = self.daemon.get(location + "/results").json
        self.assertEqual(set(results), {"histogram", "summary"})
        self.assertEqual(sum(results["histogram"]["value"]["histogram"]["counts"]), 6)
        self.assertEqual(results["summary"]["value"]["realizations"]["done"], 6)
        self.assertEqual(results["summary"]["value"]["noise_floor"]["replicates_done"], 2)
        self.assertNotIn(None, [value for value in ended.values()])

    def test_outputs_are_selectable(self):
        job = self.daemon.submit({**study(2), "outputs": {"histogram": {"transmissionMode": "value"}}})
        self.daemon.wait_for(job)
        self.assertEqual(set(self.daemon.get(f"/jobs/{job}/results").json), {"histogram"})
        bad = self.daemon.post("/processes/influence-zone/execution", {**study(2), "outputs": {"nonsense": {}}})
        self.assertEqual(self.problem(bad, 400)["errors"][0]["pointer"], "/outputs/nonsense")

    def test_prefer_decides_between_sync_and_async(self):
        body = {"inputs": {"s": "hello", "x": 3, "a": [1, 2], "b": {"bbox": [1, 2, 3, 4]}, "o": {"k": 1}, "m": "text"}}
        reply = self.daemon.post("/processes/echo/execution", body)
        self.assertEqual((reply.status, reply.json), (200, {"s": "hello", "x": 3}))
        self.assertNotIn("Link", reply.headers)
        self.assertNotIn("Location", reply.headers)
        for prefer in ("respond-async", "  respond-async  ", "wait=5, respond-async", "respond-async;foreign"):
            reply = self.daemon.post("/processes/echo/execution", body, headers={"Prefer": prefer})
            self.assertEqual(reply.status, 201, prefer)
            self.assertEqual(reply.headers["Preference-Applied"], "respond-async")
            job = reply.json["jobID"]
            self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
            self.assertEqual(self.daemon.get(reply.headers["Location"] + "/results").json, {"s": "hello", "x": 3})
        self.assertEqual(self.daemon.post("/processes/influence-zone/execution", study(1)).status, 201)

    def test_echo_waits(self):
        begin = time.monotonic()
        self.assertEqual(self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a", "pause": 0.4}}).status, 200)
        self.assertGreater(time.monotonic() - begin, 0.39)
        reply = self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a", "pause": 30}}, headers={"Prefer": "respond-async"})
        self.problem(self.daemon.get(reply.headers["Location"] + "/results"), 404, EXCEPTION + "result-not-ready")
        self.daemon.wait_for(reply.json["jobID"], ("running",))

    def test_raw_response_of_one_output(self):
        reply = self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a"}, "outputs": {"s": {}}, "response": "raw"})
        self.assertEqual((reply.status, reply.headers["Content-Type"], reply.body), (200, "text/plain", b"a"))

    def test_missing_and_wrong_inputs_are_400_with_pointers(self):
        def pointers(process, inputs):
            reply = self.daemon.post(f"/processes/{process}/execution", {"inputs": inputs})
            return [error["pointer"] for error in self.problem(reply, 400)["errors"]]

        self.assertEqual(pointers("echo", {"x": 1}), ["/inputs/s"])
        self.assertEqual(pointers("influence-zone", {}), ["/inputs/case"])
        self.assertEqual(pointers("influence-zone", {"case": case(friction=1)}), ["/inputs/case/friction"])
        self.assertEqual(pointers("influence-zone", {"case": case(-1)}), ["/inputs/case/particle_spacing_m"])
        for body in (b"", b"{", b"[]", b"[" * 100000, b'{"inputs": {"s": "' + b"a" * 5000 + b'"}}', b'{"inputs": 1}', b"\xff"):
            self.problem(self.daemon.post("/processes/echo/execution", body, headers={"Content-Type": "application/json"}), 400)
        self.problem(self.daemon.post("/processes/echo/execution", b"a=b", headers={"Content-Type": "text/plain"}), 415)

    def test_problems_are_problem_json_only_for_who_asks(self):
        self.assertEqual(self.daemon.get("/jobs/none").headers["Content-Type"], "application/json")
        reply = self.daemon.get("/jobs/none", headers={"Accept": "application/problem+json"})
        self.assertEqual(reply.headers["Content-Type"], "application/problem+json")
        self.problem(reply, 404, EXCEPTION + "no-such-job")

    def test_head_options_and_405(self):
        reply = self.daemon.request("HEAD", "/processes")
        self.assertEqual((reply.status, reply.body), (200, b""))
        self.assertGreater(int(reply.headers["Content-Length"]), 100)
        reply = self.daemon.request("OPTIONS", "/jobs")
        self.assertEqual((reply.status, reply.headers["Allow"]), (204, "GET, HEAD, OPTIONS"))
        for method in ("POST", "PUT", "PATCH", "DELETE", "TRACE"):
            reply = self.daemon.request(method, "/jobs")
            self.problem(reply, 405)
            self.assertEqual(reply.headers["Allow"], "GET, HEAD, OPTIONS", method)
        self.problem(self.daemon.get("/nothing"), 404)

    def test_job_list_by_pages_and_filters(self):
        jobs = []
        for i in range(5):
            reply = self.daemon.post("/processes/echo/execution", {"inputs": {"s": str(i)}}, headers={"Prefer": "respond-async"})
            jobs.append(reply.json["jobID"])
        for job in jobs:
            self.daemon.wait_for(job)
        seen, path = [], "/jobs?limit=2&status=successful&processID=echo"
        while path:
            page = self.daemon.get(path).json
            self.assertLessEqual(len(page["jobs"]), 2)
            seen += [job["jobID"] for job in page["jobs"]]
            path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
        self.assertEqual(seen, jobs[::-1])
        self.assertEqual(self.daemon.get("/jobs?status=failed,dismissed").json["jobs"], [])
        for query in ("limit=0", "limit=a", "status=nonsense", "type=x", "nonsense=1", "after=-1"):
            self.problem(self.daemon.get("/jobs?" + query), 400)

    def test_dismissing(self):
        job = self.daemon.submit(study(200, spacing=0.5, end=3))
        self.daemon.wait_for(job, ("running",))
        reply = self.daemon.request("DELETE", f"/jobs/{job}")
        self.assertEqual((reply.status, reply.json["status"]), (200, "dismissed"))
        self.assertEqual(self.daemon.get(f"/jobs/{job}").json["status"], "dismissed")
        deadline = time.monotonic() + 5
        directory = self.daemon.data / "jobs" / job
        while (workers_of(directory) or directory.exists()) and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertEqual(workers_of(directory), [])
        self.assertFalse(directory.exists())
        self.problem(self.daemon.get(f"/jobs/{job}/results"), 410)
        self.problem(self.daemon.request("DELETE", "/jobs/none"), 404, EXCEPTION + "no-such-job")


class Ours(ServiceTest):
    """Beneath a job: histogram, realizations, retry, extend, events, keys, tags."""

    def setUp(self):
        super().setUp()
        self.start()

    def test_histogram_and_from_a_bin_to_its_runs(self):
        job = self.daemon.submit(study(12, noise_floor_replicates=2))
        partial = self.daemon.get(f"/jobs/{job}/histogram").json
        self.assertLessEqual(partial["done"], 12)
        self.daemon.wait_for(job)
        h = self.daemon.get(f"/jobs/{job}/histogram?bins=4").json
        self.assertEqual((h["done"], h["failed"], h["planned"], h["partial"]), (12, 0, 12, False))
        self.assertGreater(h["noise_floor_stdev"], 0)
        self.assertEqual(sum(h["histogram"]["counts"]), 12)
        seen = set()
        for b in h["bins"]:
            runs = self.daemon.get(b["href"]).json["realizations"]
            self.assertEqual(len(runs), b["count"])
            for run in runs:
                self.assertGreaterEqual(run["measures"]["influence_zone_m"], b["from"])
                self.assertLessEqual(run["measures"]["influence_zone_m"], b["to"])
                seen.add(run["index"])
        self.assertEqual(seen, set(range(12)))
        h = self.daemon.get(f"/jobs/{job}/histogram?quantity=front_mass_99_m&edges=0,10,100").json["histogram"]
        self.assertEqual((h["edges"], h["counts"], h["edges_given"]), ([0, 10, 100], [0, 12], True))
        for query in ("quantity=x", "bins=0", "bins=1001", "edges=1", "edges=2,1", "edges=1,a", "bins=2&edges=1,2", "edges=1,nan", "x=1"):
            self.problem(self.daemon.get(f"/jobs/{job}/histogram?{query}"), 400)

    def test_one_realization_and_its_replay(self):
        job = self.daemon.submit(study(3))
        self.daemon.wait_for(job)
        run = self.daemon.get(f"/jobs/{job}/realizations/2").json
        self.assertEqual((run["seed"], run["state"]), (7, "done"))
        command = run["command"].replace("case.resolved.json", str(self.daemon.data / "jobs" / job / "case.resolved.json"))
        command = command.replace("DIR", str(self.dir / "again")).split()
        subprocess.run([str(TALUS), *command[1:]], check=True, capture_output=True)
        self.assertEqual(json.loads((self.dir / "again/result.json").read_text())["digest"], run["digest"])
        for index in ("3", "-1", "x", "1e0", "99999999999999999999"):
            self.problem(self.daemon.get(f"/jobs/{job}/realizations/{index}"), 404)
        page = self.daemon.get(f"/jobs/{job}/realizations?limit=2").json
        rest = self.daemon.get(page["links"][0]["href"]).json
        self.assertEqual([r["index"] for r in page["realizations"] + rest["realizations"]], [0, 1, 2])
        self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations?state=failed").json["realizations"], [])

    def test_field_and_profile(self):
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        path = f"/jobs/{job}/realizations/0"
        field = self.daemon.get(path + "/field").json
        self.assertEqual(len(field["x_m"]), field["particles"])
        self.assertEqual(len(field["particle_friction_angle_deg"]), field["particles"])
        profile = self.daemon.get(path + "/profile").json
        self.assertEqual(len(profile["x_m"]), field["particles"])
        zone = self.daemon.get(path).json["measures"]["influence_zone_m"]
        self.assertAlmostEqual(max(profile["x_m"]), zone, places=4)
        self.assertEqual(self.daemon.get(path + "/profile").json, profile)
        for what in ("field", "profile"):
            reply = self.daemon.get(f"{path}/{what}?format=svg")
            self.assertEqual((reply.status, reply.headers["Content-Type"]), (200, "image/svg+xml"), reply.body[:300])
            self.assertIn(b"<svg", reply.body)
            self.assertEqual(self.daemon.get(f"{path}/{what}", headers={"Accept": "image/svg+xml"}).headers["Content-Type"], "image/svg+xml")
        self.problem(self.daemon.get(path + "/field?format=png"), 400)

    def test_extending_leaves_old_runs_untouched(self):
        job = self.daemon.submit(study(4))
        self.daemon.wait_for(job)
        before = {r["index"]: r for r in self.daemon.get(f"/jobs/{job}/realizations").json["realizations"]}
        stamps = {p.name: p.stat().st_mtime_ns for p in (self.daemon.data / "jobs" / job / "runs").iterdir()}
        reply = self.daemon.post(f"/jobs/{job}/extend", {"realizations": 3})
        self.assertEqual((reply.status, reply.json["realizations"]["planned"]), (200, 7))
        self.assertEqual(self.daemon.wait_for(job)["realizations"], {"planned": 7, "done": 7, "failed": 0})
        after = {r["index"]: r for r in self.daemon.get(f"/jobs/{job}/realizations").json["realizations"]}
        self.assertEqual({i: after[i] for i in before}, before)
        for name, stamp in stamps.items():
            self.assertEqual((self.daemon.data / "jobs" / job / "runs" / name).stat().st_mtime_ns, stamp)
        self.assertEqual(self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]["realizations"]["done"], 7)
        whole = self.daemon.submit(study(7))
        self.daemon.wait_for(whole)
        self.assertEqual(digests(self.daemon.data, job), digests(self.daemon.data, whole))
        for body in ({}, {"realizations": 0}, {"realizations": 1.5}, {"realizations": 1, "x": 1}, []):
            self.problem(self.daemon.post(f"/jobs/{job}/extend", body), 400)

    def test_idempotency_key(self):
        headers = {"Idempotency-Key": "abc"}
        first = self.daemon.post("/processes/influence-zone/execution", study(2), headers=headers)
        again = self.daemon.post("/processes/influence-zone/execution", study(2), headers=headers)
        self.assertEqual((first.status, again.status), (201, 201))
        self.assertEqual((again.body, again.headers["Location"]), (first.body, first.headers["Location"]))
        self.problem(self.daemon.post("/processes/influence-zone/execution", study(3), headers=headers), 422)
        self.assertEqual(len(self.daemon.get("/jobs").json["jobs"]), 1)
        job = first.json["jobID"]
        self.daemon.wait_for(job)
        for _ in range(2):
            self.assertEqual(self.daemon.post(f"/jobs/{job}/extend", {"realizations": 1}, headers={"Idempotency-Key": "x"}).status, 200)
        self.assertEqual(self.daemon.wait_for(job)["realizations"]["planned"], 3)

    def test_extending_twice_at_the_same_moment(self):
        job = self.daemon.submit(study(1, noise_floor_replicates=0))
        threads = [threading.Thread(target=self.daemon.post, args=(f"/jobs/{job}/extend", {"realizations": 2})) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(self.daemon.wait_for(job)["realizations"]["planned"], 9)

    def test_the_same_key_at_the_same_moment(self):
        replies = []
        threads = [threading.Thread(target=lambda: replies.append(self.daemon.post(
            "/processes/influence-zone/execution", study(1), headers={"Idempotency-Key": "k"}))) for _ in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual({r.status for r in replies}, {201})
        self.assertEqual(len({r.body for r in replies}), 1)
        self.assertEqual(len(self.daemon.get("/jobs").json["jobs"]), 1)

    def test_etag(self):
        for path in ("/", "/processes/echo", "/jobs", "/api"):
            reply = self.daemon.get(path)
            tag = reply.headers["ETag"]
            again = self.daemon.get(path, headers={"If-None-Match": tag})
            self.assertEqual((again.status, again.body), (304, b""), path)
            self.assertEqual(self.daemon.get(path, headers={"If-None-Match": '"x"'}).status, 200)

    def test_events_tell_until_the_end(self):
        job = self.daemon.submit(study(20))
        reply = self.daemon.get(f"/jobs/{job}/events")
        self.assertEqual(reply.headers["Content-Type"], "text/event-stream")
        events = [json.loads(line[6:]) for line in reply.body.decode().splitlines() if line.startswith("data: ")]
        self.assertEqual(events[-1]["status"], "successful")
        progress = [event["progress"] for event in events]
        self.assertEqual(progress, sorted(progress))
        info = self.daemon.get(f"/jobs/{job}/events?wait=5&since=0").json
        self.assertEqual(info["status"], "successful")

    def test_long_poll_ends_with_the_change(self):
        reply = self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a", "pause": 1.0}}, headers={"Prefer": "respond-async"})
        job = reply.json["jobID"]
        self.daemon.wait_for(job, ("running",))
        begin = time.monotonic()
        info = self.daemon.get(f"/jobs/{job}/events?wait=20").json
        self.assertEqual(info["status"], "successful")
        self.assertLess(time.monotonic() - begin, 10)

    def test_metrics(self):
        self.daemon.wait_for(self.daemon.submit(study(3, noise_floor_replicates=0)))
        text = self.daemon.get("/metrics").body.decode()
        for line in ('talus_jobs{status="successful"} 1.0', "talus_queue_depth 0.0", 'talus_workers{state="all"} 2.0',
                     'talus_realizations_total{outcome="done"} 3.0', "talus_realization_seconds_count 3.0"):
            self.assertIn(line, text)
        self.assertEqual(self.daemon.get("/healthz").json, {"status": "ok"})
        self.assertEqual(self.daemon.get("/readyz").json, {"status": "ready"})


class Queue(ServiceTest):
    """Workers that break, studies that stop by themselves, quotas."""

    def test_a_run_that_keeps_crashing_fails_and_can_be_retried(self):
        fake = self.dir / "talus"  # as talus, but realization 1 kills itself while the mark is there
        mark = self.dir / "mark"
        mark.write_text("")
        fake.write_text(f'#!/bin/sh\nif [ "$1" = run ] && [ "$4" = 1 ] && [ -e {mark} ]; then echo going down; kill -SEGV $$; fi\nexec {TALUS} "$@"\n')
        fake.chmod(0o755)
        self.start("--talus", fake, "--attempts", 3)
        job = self.daemon.submit(study(4, max_failed_share=0.1))
        info = self.daemon.wait_for(job)
        self.assertEqual(info["status"], "failed")
        self.assertEqual(info["realizations"], {"planned": 4, "done": 3, "failed": 1})
        self.problem(self.daemon.get(f"/jobs/{job}/results"), 422)
        run = self.daemon.get(f"/jobs/{job}/realizations/1").json
        self.assertEqual((run["state"], run["signal"], run["attempt"]), ("failed", signal.SIGSEGV, 3))
        self.assertIn("going down", run["log_tail"])
        self.assertEqual(self.daemon.get(f"/jobs/{job}/histogram").json["failed"], 1)
        before = digests(self.daemon.data, job)
        mark.unlink()
        self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").status, 200)
        info = self.daemon.wait_for(job)
        self.assertEqual((info["status"], info["realizations"]["done"]), ("successful", 4))
        after = digests(self.daemon.data, job)
        self.assertEqual(before, {k: after[k] for k in before})
        self.assertEqual(len(after), 4)

    def test_a_run_that_takes_too_long_fails(self):
        self.start("--time-limit", 1)
        job = self.daemon.submit(study(1, spacing=0.2, end=9))
        info = self.daemon.wait_for(job)
        self.assertEqual(info["status"], "failed")
        self.assertIn("limit of 1 s", self.daemon.get(f"/jobs/{job}/realizations/0").json["reason"])

    def test_a_small_job_is_not_starved(self):
        self.start()
        huge = self.daemon.submit(study(400))
        small = self.daemon.submit(study(3, seed=8))
        self.daemon.wait_for(small, seconds=30)
        self.assertLess(self.daemon.get(f"/jobs/{huge}").json["realizations"]["done"], 200)

    def test_a_study_may_stop_by_itself(self):
        self.start()
        document = study(400)
        document["inputs"]["case"]["study"] = {"stop_when_ci_half_width_below_m": 0.5}
        job = self.daemon.submit(document)
        info = self.daemon.wait_for(job)
        self.assertEqual(info["status"], "successful")
        self.assertIn("stopped early", info["message"])
        self.assertLess(info["realizations"]["done"], 400)
        self.assertTrue(self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]["realizations"]["stopped_early"])

    def test_quotas_are_refused_with_numbers(self):
        self.start("--max-particles", 1000, "--max-steps", 5000, "--max-realizations", 50, "--max-core-hours", 0.01, "--max-jobs-each", 2)

        def refused(body):
            document = self.problem(self.daemon.post("/processes/influence-zone/execution", body), 422, "quota-exceeded")
            return {error["pointer"]: error["message"] for error in document["errors"]}

        self.assertIn("at most 1000", refused(study(1, spacing=0.2))["/inputs/case/particle_spacing_m"])
        self.assertIn("at most 5000", refused(study(1, end=1000))["/inputs/case/time/end_s"])
        self.assertIn("realizations: 51, at most 50", str(refused(study(51))).replace(".0", ""))
        self.assertIn("core-hours", refused(study(50, end=1000))["/inputs"])
        slow = {"inputs": {"s": "a", "pause": 30}}
        for status in (201, 201, 429):
            self.assertEqual(self.daemon.post("/processes/echo/execution", slow, headers={"Prefer": "respond-async"}).status, status)
        self.assertEqual([p.name for p in (self.daemon.data / "jobs").iterdir()], [])
        job = self.daemon.get("/jobs").json["jobs"][0]["jobID"]
        self.daemon.request("DELETE", f"/jobs/{job}")
        job = self.daemon.submit(study(5))
        self.assertIn("at most 50", str(self.problem(self.daemon.post(f"/jobs/{job}/extend", {"realizations": 100}), 422)["errors"]))

    def test_too_little_disk(self):
        self.start("--min-disk", 10 ** 9)
        document = self.problem(self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a"}}, headers={"Prefer": "respond-async"}), 507)
        self.assertIn("MiB", document["detail"])
        self.problem(self.daemon.get("/readyz"), 503)


class Crash(ServiceTest):
    """kill -9 and SIGTERM: every realization ends once, and the statistics are those of an undisturbed study."""

    RUNS = 24

    def undisturbed(self, **more):
        directory = self.dir / "plain"
        path = self.dir / "case.json"
        path.write_text(json.dumps(case(**more)))
        subprocess.run([str(TALUS), "study", str(path), "--realizations", str(self.RUNS), "--seed", "7", "--out", str(directory),
                        "--workers", "2", "--no-figures"], check=True, capture_output=True)
        return json.loads((directory / "study.json").read_text()), {
            p.stem: json.loads(p.read_text())["digest"] for p in (directory / "runs").glob("*.json")}

    def assert_same(self, job, plain):
        summary, expected = plain
        mine = self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]
        self.assertEqual(digests(self.daemon.data, job), expected)
        for document in (mine, summary):
            document.pop("effort")  # seconds
        self.assertEqual(mine, summary)

    def test_a_second_talusd_is_refused(self):
        self.start()
        second = Daemon(self.daemon.data, wait=False)
        self.assertEqual(second.process.wait(10), 5)
        self.assertIn("another talusd", second.said())
        second.close()
        self.assertEqual(self.daemon.get("/healthz").status, 200)

    def test_stopped_at_once(self):
        for _ in range(5):
            self.start()
            self.assertEqual(self.daemon.stop(seconds=10), 0)

    def test_sigterm_drains_and_the_next_one_goes_on(self):
        plain = self.undisturbed(spacing=0.5, end=1.0)
        self.start("--grace", 20)
        job = self.daemon.submit(study(self.RUNS, spacing=0.5, end=1.0))
        while self.daemon.get(f"/jobs/{job}").json["realizations"]["done"] < 3:
            time.sleep(0.02)
        begin = time.monotonic()
        self.assertEqual(self.daemon.stop(), 0)
        self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual(workers_of(self.dir), [])
        self.start()
        self.assertEqual(self.daemon.wait_for(job)["realizations"]["done"], self.RUNS)
        self.assert_same(job, plain)

    def test_what_was_checkpointed_is_resumed(self):
        self.start(workers=1)
        job = self.daemon.submit(study(1, spacing=0.2, end=3))
        work = self.daemon.data / "jobs" / job / "work/000000"
        while not (work / "history.csv").exists() and not (work / "snapshots.vtkhdf").exists():
            time.sleep(0.02)
        time.sleep(1)
        self.assertEqual(self.daemon.stop(), 0)
        self.assertTrue((work / "checkpoint.h5").exists())
        self.start(workers=1)
        time.sleep(0.3)
        commands = [open(f"/proc/{pid}/cmdline").read() for pid in workers_of(self.dir)]
        self.assertTrue(any("--resume" in command for command in commands), commands)
        self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
        self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations/0").json["attempt"], 2)

    def kills(self, count, seed):
        """kill -9 of talusd or of a worker at random moments, `count` times, while a study runs."""
        random_source = random.Random(seed)
        plain = self.undisturbed(spacing=0.8, end=1.5)
        self.start("--attempts", 100)
        job = self.daemon.submit(study(self.RUNS, spacing=0.8, end=1.5))
        done, of_talusd, of_workers = 0, 0, 0
        while done < count:
            time.sleep(random_source.uniform(0.0, 0.15))
            running = workers_of(self.dir)
            if running and random_source.random() < 0.6:
                try:
                    os.kill(random_source.choice(running), signal.SIGKILL)
                    of_workers += 1
                except ProcessLookupError:
                    continue
            else:
                self.daemon.kill()
                self.start("--attempts", 100)
                of_talusd += 1
            done += 1
            if self.daemon.get(f"/jobs/{job}").json["status"] != "running":
                self.daemon.post(f"/jobs/{job}/extend", {"realizations": 0})  # refused: nothing to extend
                break
        info = self.daemon.wait_for(job)
        self.assertEqual(info["realizations"], {"planned": self.RUNS, "done": self.RUNS, "failed": 0})
        self.assert_same(job, plain)
        return done, of_talusd, of_workers

    def test_killed_at_random_moments(self):
        done, of_talusd, of_workers = self.kills(12, seed=1)
        print(f"\n{of_talusd} kills of talusd, {of_workers} of workers", flush=True)


class ManyKills(Crash):
    """Fifty kills, over a study long enough for them."""

    RUNS = 120

    def test_killed_at_random_moments(self):
        done, of_talusd, of_workers = self.kills(50, seed=2)
        print(f"\n{of_talusd} kills of talusd, {of_workers} of workers", flush=True)
        self.assertEqual(done, 50)

    test_a_second_talusd_is_refused = None
    test_sigterm_drains_and_the_next_one_goes_on = None
    test_what_was_checkpointed_is_resumed = None
    test_stopped_at_once = None


if __name__ == "__main__":
    main({"Ogc": Ogc, "Ours": Ours, "Queue": Queue, "Crash": Crash, "ManyKills": ManyKills})
