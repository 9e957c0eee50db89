#!/usr/bin/env python3
"""What is beneath a job; workers that break, and quotas."""
import json
import os
import signal
import subprocess
import threading
import time

from daemon import SOURCE, TALUS, ServiceTest, digests, main, study


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
        for query in (
            "quantity=x",
            "bins=0",
            "bins=1001",
            "edges=1",
            "edges=2,1",
            "edges=1,a",
            "bins=2&edges=1,2",
            "edges=1,nan",
            "x=1",
        ):
            self.problem(self.daemon.get(f"/jobs/{job}/histogram?{query}"), 400)

    def test_exceedance_is_what_stats_says(self):
        case = study(6)
        case["inputs"]["case"]["targets"] = [{"name": "near", "point_m": [22]}, {"name": "far", "point_m": [55]}]
        job = self.daemon.submit(case)
        self.daemon.wait_for(job)
        path = f"/jobs/{job}/exceedance"
        fronts = [run["measures"]["front_mass_99_m"] for run in self.daemon.get(f"/jobs/{job}/realizations").json["realizations"]]
        x = sorted(fronts)[2]
        front = self.daemon.get(f"{path}?quantity=front_mass_99_m&x={x!r}").json
        self.assertEqual((front["k"], front["n"], front["failed"]), (3, 6, 0))
        far = self.daemon.get(f"{path}?quantity=far").json
        self.assertEqual((far["k"], far["n"], far["lo"]), (0, 6, 0))
        directory = self.daemon.data / "jobs" / job
        for query, arguments in (
            (f"quantity=front_mass_99_m&x={x!r}", ["--at", repr(x)]),
            ("quantity=far", ["--at", "name=far"]),
            ("quantity=near.peak_depth_m&x=0.5", ["--quantity", "near.peak_depth_m", "--at", "0.5"]),
        ):
            said = subprocess.run([TALUS, "stats", directory, "--json", *arguments], capture_output=True, text=True, check=True)
            expected = {key: value for key, value in json.loads(said.stdout)[0].items() if value is not None}
            self.assertEqual(self.daemon.get(f"{path}?{query}").json, expected)
        for query in ("quantity=nowhere", "quantity=far.peak_depth_m", "quantity=front_mass_99_m", "x=a", "bins=2&x=1"):
            self.problem(self.daemon.get(f"{path}?{query}"), 400)

    def test_one_realization_and_its_replay(self):
        job = self.daemon.submit(study(3))
        self.daemon.wait_for(job)
        run = self.daemon.get(f"/jobs/{job}/realizations/2").json
        self.assertEqual((run["seed"], run["state"]), (7, "done"))
        command = run["command"].replace(
            "case.resolved.json", str(self.daemon.data / "jobs" / job / "case.resolved.json")
        )
        command = command.replace("DIR", str(self.dir / "again")).split()
        subprocess.run([str(TALUS), *command[1:]], check=True, capture_output=True)
        self.assertEqual(json.loads((self.dir / "again/result.json").read_text())["digest"], run["digest"])
        for index in ("3", "-1", "x", "1e0", "99999999999999999999"):
            self.problem(self.daemon.get(f"/jobs/{job}/realizations/{index}"), 404)
        page = self.daemon.get(f"/jobs/{job}/realizations?limit=2").json
        rest = self.daemon.get(page["links"][0]["href"]).json
        self.assertEqual([r["index"] for r in page["realizations"] + rest["realizations"]], [0, 1, 2])
        self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations?state=failed").json["realizations"], [])

    def test_the_verdicts_of_the_runs_are_told_everywhere(self):
        small = json.loads((SOURCE / "tests/solver/cli/trials/small-slope.json").read_text())
        job = self.daemon.submit({"inputs": {"case": {**small, "time": {"end_s": 0.3}}, "realizations": 4, "seed": 5}})
        info = self.daemon.wait_for(job)
        counts = {"sound": 0, "doubtful": 4, "invalid": 0, "not_assessed": 0}
        self.assertEqual(info["quality"], counts)
        self.assertIn("4 of 4 runs doubtful: still moving (4)", info["message"])
        self.assertEqual(self.daemon.get(f"/jobs/{job}/histogram").json["quality"], counts)
        summary = self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]
        self.assertEqual(summary["quality"]["doubtful"], 4)
        self.assertEqual(summary["quality"]["reasons"][0]["check"], "still_moving")
        run = self.daemon.get(f"/jobs/{job}/realizations/1").json
        self.assertEqual(run["verdict"], "doubtful")
        self.assertTrue(run["verdict_reasons"].startswith("still_moving: the slide moved at"), run)

        slow_sound = {**small, "time": {"end_s": 2}, "numerics": {"sound_speed_m_s": 5}}
        job = self.daemon.submit({"inputs": {"case": slow_sound, "realizations": 2, "seed": 5}})
        info = self.daemon.wait_for(job)
        self.assertEqual((info["status"], info["realizations"]["failed"], info["quality"]["invalid"]), ("failed", 2, 2))
        self.assertIn("2 of 2 runs invalid: ", info["message"])
        run = self.daemon.get(f"/jobs/{job}/realizations/0").json
        self.assertEqual((run["state"], run["verdict"]), ("failed", "invalid"))
        self.assertEqual(run["reason"], "invalid result: " + run["verdict_reasons"])

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
            self.assertEqual(
                self.daemon.get(f"{path}/{what}", headers={"Accept": "image/svg+xml"}).headers["Content-Type"],
                "image/svg+xml",
            )
        self.problem(self.daemon.get(path + "/field?format=png"), 400)

    def test_only_the_latest_profiles_are_kept(self):
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        directory = self.daemon.data / "jobs" / job / "profiles"
        for i in range(1, 19):  # asked for earlier, the last one first
            (directory / f"{i}.json").write_text("{}")
            os.utime(directory / f"{i}.json", (10**9 - i, 10**9 - i))
        self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations/0/profile").status, 200)
        kept = {"first.vtkhdf", "first.json", "worst.vtkhdf", "worst.json"}  # the study's own
        self.assertEqual({p.name for p in directory.iterdir()}, {f"{i}.json" for i in range(16)} | kept)

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
            self.assertEqual(
                self.daemon.post(f"/jobs/{job}/extend", {"realizations": 1}, headers={"Idempotency-Key": "x"}).status,
                200,
            )
        self.assertEqual(self.daemon.wait_for(job)["realizations"]["planned"], 3)

    def test_extending_twice_at_the_same_moment(self):
        job = self.daemon.submit(study(1, noise_floor_replicates=0))
        threads = [
            threading.Thread(target=self.daemon.post, args=(f"/jobs/{job}/extend", {"realizations": 2}))
            for _ in range(4)
        ]
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
            self.assertEqual(self.daemon.get(path, headers={"If-None-Match": '"x", W/' + tag}).status, 304)
        tag = self.daemon.get("/jobs").headers["ETag"]
        self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a"}}, headers={"Prefer": "respond-async"})
        self.assertEqual(self.daemon.get("/jobs", headers={"If-None-Match": tag}).status, 200)

    def test_events_tell_until_the_end(self):
        job = self.daemon.submit(study(20, noise_floor_replicates=0))
        reply = self.daemon.get(f"/jobs/{job}/events")
        self.assertEqual(reply.headers["Content-Type"], "text/event-stream")
        events = [json.loads(line[6:]) for line in reply.body.decode().splitlines() if line.startswith("data: ")]
        self.assertEqual(events[-1]["status"], "successful")
        progress = [event["progress"] for event in events]
        self.assertEqual(progress, sorted(progress))
        expected = [min(99, 5 * event["realizations"]["done"]) for event in events[:-1]]
        self.assertEqual(progress, [*expected, 100])
        info = self.daemon.get(f"/jobs/{job}/events?wait=5&since=0").json
        self.assertEqual(info["status"], "successful")

    def test_events_for_a_client_that_knows_no_chunks(self):
        job = self.daemon.submit(study(2, noise_floor_replicates=0))
        head, _, body = self.daemon.raw(f"GET /jobs/{job}/events HTTP/1.0\r\n\r\n".encode(), 60).partition(b"\r\n\r\n")
        self.assertNotIn(b"chunked", head.lower())
        self.assertRegex(head, rb"(?i)Connection: close")
        self.assertRegex(body, rb"\A(id: |: keep-alive)")
        self.assertRegex(body, rb'"status":"successful".*\n\n\Z')

    def test_long_poll_ends_with_the_change(self):
        reply = self.daemon.post(
            "/processes/echo/execution", {"inputs": {"s": "a", "pause": 1.0}}, headers={"Prefer": "respond-async"}
        )
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
        fake.write_text(
            f'#!/bin/sh\nif [ "$1" = run ] && [ "$4" = 1 ] && [ -e {mark} ]; then echo going down; kill -SEGV $$; fi\n'
            f'exec {TALUS} "$@"\n'
        )
        fake.chmod(0o755)
        self.start("--talus", fake, "--attempts", 3)
        job = self.daemon.submit(study(4, max_failed_share=0.1))
        info = self.daemon.wait_for(job)
        self.assertEqual(info["status"], "failed")
        self.assertEqual((info["realizations"]["planned"], info["realizations"]["failed"]), (4, 1))
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
        self.assertTrue(
            self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]["realizations"]["stopped_early"]
        )
        self.problem(self.daemon.post(f"/jobs/{job}/extend", {"realizations": 1}), 409)

    def test_quotas_are_refused_with_numbers(self):
        self.start(
            "--max-particles",
            1000,
            "--max-steps",
            5000,
            "--max-realizations",
            50,
            "--max-core-hours",
            0.01,
            "--max-jobs-each",
            2,
        )

        def refused(body):
            document = self.problem(
                self.daemon.post("/processes/influence-zone/execution", body), 422, "quota-exceeded"
            )
            return {error["pointer"]: error["message"] for error in document["errors"]}

        self.assertIn("at most 1000", refused(study(1, spacing=0.2))["/inputs/case/particle_spacing_m"])
        self.assertIn("at most 5000", refused(study(1, end=1000))["/inputs/case/time/end_s"])
        self.assertEqual(refused(study(51))["/inputs/realizations"], "realizations: 51, at most 50")
        self.assertIn("core-hours", refused(study(50, end=1000))["/inputs"])
        slow = {"inputs": {"s": "a", "pause": 30}}
        for status in (201, 201, 429):
            self.assertEqual(
                self.daemon.post("/processes/echo/execution", slow, headers={"Prefer": "respond-async"}).status, status
            )
        self.assertEqual([p.name for p in (self.daemon.data / "jobs").iterdir()], [])
        job = self.daemon.get("/jobs").json["jobs"][0]["jobID"]
        self.daemon.request("DELETE", f"/jobs/{job}")
        job = self.daemon.submit(study(5))
        errors = self.problem(self.daemon.post(f"/jobs/{job}/extend", {"realizations": 100}), 422)["errors"]
        self.assertEqual(errors, [{"pointer": "/realizations", "message": "realizations: 105, at most 50"}])

    def test_who_fills_the_queue_is_told_how_many_wait(self):
        self.start("--max-jobs", 2)
        done = self.daemon.submit(study(1))
        self.daemon.wait_for(done)
        slow = {"inputs": {"s": "a", "pause": 60}}
        for status in (201, 201, 429):
            reply = self.daemon.post("/processes/echo/execution", slow, headers={"Prefer": "respond-async"})
            self.assertEqual(reply.status, status)
        self.assertIn("in all 2 jobs are waiting or running; at most 2 may", reply.json["detail"])
        self.assertIn("Retry-After", reply.headers)
        self.problem(self.daemon.post("/processes/influence-zone/execution", study(1)), 429)
        for what, body in (("extend", {"realizations": 1}), ("retry", None)):  # they would open it again
            self.problem(self.daemon.post(f"/jobs/{done}/{what}", body), 429)

    def test_too_little_disk(self):
        self.start("--min-disk", 10 ** 9)
        document = self.problem(
            self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a"}}, headers={"Prefer": "respond-async"}),
            507,
        )
        self.assertIn("MiB", document["detail"])
        self.problem(self.daemon.get("/readyz"), 503)


if __name__ == "__main__":
    main({"Ours": Ours, "Queue": Queue})
