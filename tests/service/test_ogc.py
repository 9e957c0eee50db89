#!/usr/bin/env python3
"""What OGC API - Processes asks of talusd."""
import time

from daemon import ServiceTest, case, main, study, workers_of

OGC = "http://www.opengis.net/def/"
EXCEPTION = OGC + "exceptions/ogcapi-processes-1/1.0/"


class Ogc(ServiceTest):
    """What the standard asks for, word by word."""

    def setUp(self):
        super().setUp()
        self.start()

    def test_landing_page_links_to_everything(self):
        page = self.daemon.get("/").json
        links = {link["rel"]: link["href"] for link in page["links"]}
        for rel in (
            "service-desc",
            OGC + "rel/ogc/1.0/conformance",
            OGC + "rel/ogc/1.0/processes",
            OGC + "rel/ogc/1.0/job-list",
        ):
            reply = self.daemon.get(links[rel])
            self.assertEqual(reply.status, 200, rel)
            reply.json
        self.assertEqual(
            self.daemon.get("/api").headers["Content-Type"], "application/vnd.oai.openapi+json;version=3.0"
        )

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
                (
                    self.assertNotIsInstance(value.get("exclusiveMinimum", True), (int, float))
                    if "exclusiveMinimum" in value
                    else None
                )
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
        self.assertEqual(
            self.daemon.post("/processes/echo/execution", {"inputs": {"s": "a", "pause": 0.4}}).status, 200
        )
        self.assertGreater(time.monotonic() - begin, 0.39)
        reply = self.daemon.post(
            "/processes/echo/execution", {"inputs": {"s": "a", "pause": 30}}, headers={"Prefer": "respond-async"}
        )
        self.problem(self.daemon.get(reply.headers["Location"] + "/results"), 404, EXCEPTION + "result-not-ready")
        self.daemon.wait_for(reply.json["jobID"], ("running",))

    def test_raw_response_of_one_output(self):
        reply = self.daemon.post(
            "/processes/echo/execution", {"inputs": {"s": "a"}, "outputs": {"s": {}}, "response": "raw"}
        )
        self.assertEqual((reply.status, reply.headers["Content-Type"], reply.body), (200, "text/plain", b"a"))

    def test_missing_and_wrong_inputs_are_400_with_pointers(self):
        def pointers(process, inputs):
            reply = self.daemon.post(f"/processes/{process}/execution", {"inputs": inputs})
            return [error["pointer"] for error in self.problem(reply, 400)["errors"]]

        self.assertEqual(pointers("echo", {"x": 1}), ["/inputs/s"])
        self.assertEqual(pointers("influence-zone", {}), ["/inputs/case"])
        self.assertEqual(pointers("influence-zone", {"case": case(friction=1)}), ["/inputs/case/friction"])
        self.assertEqual(pointers("influence-zone", {"case": case(-1)}), ["/inputs/case/particle_spacing_m"])
        for body in (
            b"",
            b"{",
            b"[]",
            b"[" * 100000,
            b'{"inputs": {"s": "' + b"a" * 5000 + b'"}}',
            b'{"inputs": 1}',
            b"\xff",
        ):
            self.problem(
                self.daemon.post("/processes/echo/execution", body, headers={"Content-Type": "application/json"}), 400
            )
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
        self.assertEqual(reply.headers["Accept-Ranges"], "none")
        reply = self.daemon.request("OPTIONS", "/jobs")
        self.assertEqual((reply.status, reply.headers["Allow"]), (204, "GET, HEAD, OPTIONS"))
        for method in ("POST", "PUT", "PATCH", "DELETE", "TRACE"):
            reply = self.daemon.request(method, "/jobs")
            self.problem(reply, 405)
            self.assertEqual(reply.headers["Allow"], "GET, HEAD, OPTIONS", method)
        self.problem(self.daemon.get("/nothing"), 404)

    def test_what_has_no_value_is_left_out(self):
        def assert_no_null(value, where):
            self.assertIsNotNone(value, where)
            if isinstance(value, (dict, list)):
                for key, member in value.items() if isinstance(value, dict) else enumerate(value):
                    assert_no_null(member, f"{where} {key}")

        job = self.daemon.submit(study(1, noise_floor_replicates=0))
        path = f"/jobs/{job}"
        for _ in ("before", "after"):
            for where in (
                "/",
                "/processes",
                "/processes/echo",
                "/jobs",
                path,
                path + "/histogram",
                path + "/histogram?bins=2",
                path + "/realizations",
                path + "/realizations/0",
                path + "/events?wait=0",
            ):
                assert_no_null(self.daemon.get(where).json, where)
            self.daemon.wait_for(job)
        self.assertNotIn("noise_floor_stdev", self.daemon.get(path + "/histogram").json)

    def test_job_list_by_pages_and_filters(self):
        jobs = []
        for i in range(5):
            reply = self.daemon.post(
                "/processes/echo/execution", {"inputs": {"s": str(i)}}, headers={"Prefer": "respond-async"}
            )
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
        job = self.daemon.submit(study(200, spacing=0.2, end=9))  # runs that would take much longer than we wait
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


if __name__ == "__main__":
    main({"Ogc": Ogc})
