#!/usr/bin/env python3
"""The abstract tests of OGC 18-062r2, as its conformance suite sends them."""
import datetime
import email
import email.policy
import time

from daemon import ServiceTest, main

OGC = "http://www.opengis.net/def/"
EXCEPTION = OGC + "exceptions/ogcapi-processes-1/1.0/"
JSON = {"Accept": "application/json"}
VALUES = {"s": {"transmissionMode": "value"}, "x": {"transmissionMode": "value"}}
INPUTS = {"s": "teststring", "m": "teststring", "x": "teststring",
          "b": {"crs": "urn:ogc:def:crs:EPSG:6.6:4326", "bbox": [345345345] * 4}}


class Conformance(ServiceTest):
    def setUp(self):
        super().setUp()
        self.start()

    def execute(self, inputs, outputs=None, status=200, headers=None, **more):
        body = {"inputs": inputs, **({"outputs": outputs} if outputs is not None else {}), **more}
        reply = self.daemon.post("/processes/echo/execution", body, headers={**JSON, **(headers or {})})
        self.assertEqual(reply.status, status, reply.body)
        return reply

    def submit(self, **more):
        """@return Location of an echo job"""
        return self.execute(INPUTS, VALUES, 201, {"Prefer": "respond-async "}, **more).headers["Location"]

    def get(self, path, **query):
        text = "&".join(f"{name}={value}" for name, value in query.items())
        return self.daemon.get(path + ("?" + text if text else "")).json

    def link(self, document, rel):
        return next((link["href"] for link in document["links"] if link["rel"] == rel), None)

    # core

    def test_limit_of_the_process_list(self):
        page = self.get("/processes", limit=1)
        self.assertEqual([p["id"] for p in page["processes"]], ["influence-zone"])
        self.assertEqual(self.link(page, "self"), self.daemon.url + "/processes?limit=1")
        rest = self.daemon.get(self.link(page, "next")).json
        self.assertEqual([p["id"] for p in rest["processes"]], ["echo"])
        self.assertIsNone(self.link(rest, "next"))
        self.assertIsNone(self.link(self.get("/processes", limit=2), "next"))
        for limit in ("0", "10001", "x"):
            self.problem(self.daemon.get("/processes?limit=" + limit), 400)

    def test_inputs_inline(self):
        self.execute(INPUTS, VALUES)
        self.execute({**INPUTS, "a": [1, 2, 3]})
        # The suite's idea of an object; strictly a qualified value.
        self.execute({**INPUTS, "o": {"value": "teststring"}}, VALUES)
        self.execute({**INPUTS, "o": {"value": {"k": 1}, "mediaType": "application/json"}}, VALUES)
        self.assertEqual(self.execute({"s": {"value": "a"}}).json, {"s": "a"})

    def test_wrong_inputs_and_requests_are_exceptions(self):
        for body in ({"inputs": {**INPUTS, "m": {"type": "wrong/type"}}}, {"invalid-execute-request": "true"}):
            self.problem(self.daemon.post("/processes/echo/execution", body, headers=JSON), 400)

    def test_sync_document(self):
        reply = self.execute(INPUTS, VALUES, response="document")
        self.assertEqual(
            (reply.headers["Content-Type"], reply.json), ("application/json", {"s": "teststring", "x": "teststring"})
        )
        self.assertNotIn("Link", reply.headers)

    def test_raw_value_of_one_output(self):
        reply = self.execute(INPUTS, {"s": VALUES["s"]}, response="raw")
        self.assertEqual((reply.headers["Content-Type"], reply.body), ("text/plain", b"teststring"))
        location = self.execute(INPUTS, {"s": VALUES["s"]}, 201, {"Prefer": "respond-async"}, response="raw").headers[
            "Location"
        ]
        self.daemon.wait_for(location.rsplit("/", 1)[1])
        reply = self.daemon.get(location + "/results")
        self.assertEqual((reply.headers["Content-Type"], reply.body), ("text/plain", b"teststring"))

    def assert_multipart(self, reply, expected):
        self.assertEqual(reply.status, 200, reply.body)
        text = b"Content-Type: " + reply.headers["Content-Type"].encode() + b"\r\n\r\n" + reply.body
        message = email.message_from_bytes(text, policy=email.policy.HTTP)
        self.assertEqual(message.get_content_type(), "multipart/related")
        self.assertEqual(
            [(part["Content-ID"], part.get_content_type(), part.get_payload()) for part in message.iter_parts()],
            expected,
        )
        self.assertEqual(message.get_param("type"), expected[0][1])

    def test_raw_values_of_several_outputs(self):
        expected = [("s", "text/plain", "teststring"), ("x", "application/json", "3\n")]
        inputs = {**INPUTS, "x": 3}
        for accept in ("*/*", "multipart/related"):
            self.assert_multipart(self.execute(inputs, VALUES, headers={"Accept": accept}, response="raw"), expected)
        location = self.execute(inputs, VALUES, 201, {"Prefer": "respond-async"}, response="raw").headers["Location"]
        self.daemon.wait_for(location.rsplit("/", 1)[1])
        self.assert_multipart(self.daemon.get(location + "/results"), expected)
        # Who accepts JSON alone gets a document.
        self.assertEqual(self.execute(inputs, VALUES, response="raw").json, {"s": "teststring", "x": 3})
        self.assertEqual(self.daemon.get(location + "/results", headers=JSON).json, {"s": "teststring", "x": 3})

    def test_async(self):
        location = self.submit()
        info = self.daemon.get(location, headers=JSON).json
        self.assertIn(info["status"], ("accepted", "running", "successful"))
        info = self.daemon.wait_for(info["jobID"])
        self.assertEqual(self.link(info, OGC + "rel/ogc/1.0/results"), location + "/results")
        self.assertEqual(self.daemon.get(location + "/results").json, {"s": "teststring", "x": "teststring"})
        self.problem(self.daemon.get("/jobs/invalid-job/results"), 404, EXCEPTION + "no-such-job")

    # job-list

    def test_the_job_list_by_type(self):
        job = self.submit().rsplit("/", 1)[1]
        for types in ("process", "process,process"):
            self.assertEqual([j["jobID"] for j in self.get("/jobs", type=types)["jobs"]], [job])
        self.problem(self.daemon.get("/jobs?type=process,x"), 400)

    def test_the_job_list_by_time_of_creation(self):
        job = self.submit().rsplit("/", 1)[1]
        created = self.get("/jobs/" + job)["created"]
        moment = datetime.datetime.fromisoformat(created.replace("Z", "+00:00"))
        hour = datetime.timedelta(hours=1)
        before, after = (t.isoformat().replace("+00:00", "Z") for t in (moment - hour, moment + hour))
        elsewhere = moment.astimezone(datetime.timezone(hour)).isoformat(timespec="milliseconds").replace("+", "%2B")
        for when, found in (
            (created, 1),
            (elsewhere, 1),
            (before, 0),
            (f"{before}/{after}", 1),
            (f"{before}/..", 1),
            (f"{before}/", 1),
            (f"../{after}", 1),
            (f"/{after}", 1),
            (f"{after}/..", 0),
            (f"../{before}", 0),
        ):
            self.assertEqual(len(self.get("/jobs", datetime=when)["jobs"]), found, when)
        for when in ("yesterday", "../..", "/", "2026-01-01", f"{before}/{after}/{after}", ""):
            self.problem(self.daemon.get("/jobs?datetime=" + when), 400)

    def test_the_job_list_by_duration(self):
        location = self.execute({"s": "a", "pause": 60}, None, 201, {"Prefer": "respond-async"}).headers["Location"]
        running = location.rsplit("/", 1)[1]
        short = self.submit().rsplit("/", 1)[1]
        self.daemon.wait_for(short)
        self.daemon.wait_for(running, ("running",))

        def found(**query):
            return [j["jobID"] for j in self.get("/jobs", **query)["jobs"]]

        deadline = time.monotonic() + 10
        while running not in found(minDuration=1) and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertEqual(found(minDuration=1), [running])
        self.assertNotIn(running, found(maxDuration=0))
        self.assertEqual(found(minDuration=0, maxDuration=50), [short, running])
        self.assertEqual(found(minDuration=0, maxDuration=50, status="running"), [running])
        self.problem(self.daemon.get("/jobs?minDuration=a"), 400)

    def test_pages_keep_the_filter(self):
        jobs = [self.submit().rsplit("/", 1)[1] for _ in range(3)]
        path, seen = "/jobs?limit=1&datetime=2020-01-01T00:00:00%2B01:00/..&type=process", []
        while path:
            page = self.daemon.get(path).json
            self.assertIn("datetime=2020-01-01T00%3A00%3A00%2B01%3A00%2F..", self.link(page, "self"))
            seen += [job["jobID"] for job in page["jobs"]]
            path = self.link(page, "next")
        self.assertEqual(seen, jobs[::-1])

    # dismiss

    def test_dismissing_a_running_and_a_finished_job(self):
        for pause, state in ((60, "running"), (0, "successful")):
            location = self.execute({"s": "a", "pause": pause}, None, 201, {"Prefer": "respond-async"}).headers[
                "Location"
            ]
            self.daemon.wait_for(location.rsplit("/", 1)[1], (state,))
            reply = self.daemon.request("DELETE", location)
            self.assertEqual((reply.status, reply.json["status"]), (200, "dismissed"))
            self.assertEqual(self.daemon.get(location).json["status"], "dismissed")
        self.problem(self.daemon.request("DELETE", "/jobs/invalid-job"), 404, EXCEPTION + "no-such-job")


if __name__ == "__main__":
    main({"Conformance": Conformance})
