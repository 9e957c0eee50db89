#!/usr/bin/env python3
"""talusd and clients that others wrote, and our own.  usage: test_clients.py TALUSD SOURCE_DIR GROUP [test names]"""
import json
import os
import subprocess
import sys

from daemon import SOURCE, TALUS, TALUSD, ServiceTest, case, main, study


class Umbridge(ServiceTest):
    """The client of UM-Bridge from PyPI, and the protocol's errors in their order."""

    TERMS = 7

    def setUp(self):
        super().setUp()
        models = self.dir / "models"
        models.mkdir()
        document = case()
        document["random_field"]["terms"] = self.TERMS
        (models / "slope.json").write_text(json.dumps(document))
        self.case = document
        self.start("--models", models)

    def test_the_client_evaluates(self):
        import umbridge
        self.assertEqual(umbridge.supported_models(self.daemon.url), ["slope"])
        model = umbridge.HTTPModel(self.daemon.url, "slope")
        self.assertEqual(model.get_input_sizes(), [self.TERMS])
        self.assertEqual(model.get_output_sizes(), [5])
        self.assertTrue(model.supports_evaluate())
        self.assertFalse(model.supports_gradient() or model.supports_apply_jacobian() or model.supports_apply_hessian())
        xi = [0.5, -1.0, 0.25, 0.0, 1.5, -0.75, 2.0]
        output = model([xi])
        path = self.dir / "case.json"
        self.case["random_field"]["xi"] = xi
        path.write_text(json.dumps(self.case))
        subprocess.run([str(TALUS), "run", str(path), "--out", str(self.dir / "run")], check=True, capture_output=True)
        result = json.loads((self.dir / "run/result.json").read_text())
        self.assertEqual(
            output,
            [
                [
                    result[key]
                    for key in (
                        "influence_zone_m",
                        "front_connected_m",
                        "front_mass_99_m",
                        "front_mass_999_m",
                        "centre_of_mass_x_m",
                    )
                ]
            ],
        )

    def test_parameters(self):
        import umbridge
        model = umbridge.HTTPModel(self.daemon.url, "slope")
        config = {"parameters": ["cohesion_Pa", "log_mean"]}
        self.assertEqual(model.get_input_sizes(config), [self.TERMS, 2])
        weak, strong = (model([[0.0] * self.TERMS, [0.0, mean]], config)[0][0] for mean in (-1.2, -0.3))
        self.assertGreater(weak, strong)

    def test_coefficients_of_several_properties(self):
        import umbridge
        document = json.loads((SOURCE / "tests/solver/cli/trials/small-slope.json").read_text())
        field = document["random_field"] = {"correlation_length_m": 2, "terms": 7}
        field["properties"] = {"friction": {"cov": 0.1}, "cohesion": {"mean_kPa": 2, "cov": 0.3, "varies": "once"}}
        document.update(time={"end_s": 1})
        (self.dir / "models/c-phi.json").write_text(json.dumps(document))
        model = umbridge.HTTPModel(self.daemon.url, "c-phi")
        config = {"parameters": ["cohesion_mean_kPa", "friction_cov"]}
        self.assertEqual(model.get_input_sizes(config), [8, 2])
        weak, strong = (model([[0.0] * 7 + [z], [2.0, 0.1]], config)[0][0] for z in (-2.0, 5.0))
        self.assertGreater(weak, strong)
        firm = model([[0.0] * 8, [9.0, 0.1]], config)[0][0]
        self.assertGreater(weak, firm)
        (self.dir / "models/c-phi.json").unlink()

    def test_an_invalid_run_is_an_error_that_says_why(self):
        import umbridge
        document = json.loads((SOURCE / "tests/solver/cli/trials/small-slope.json").read_text())
        document.update(time={"end_s": 2}, numerics={"sound_speed_m_s": 5})
        (self.dir / "models/soft.json").write_text(json.dumps(document))
        body = {"name": "soft", "input": [[0.0] * 50]}
        reply = self.daemon.post("/Evaluate", body)
        self.assertEqual((reply.status, reply.json["error"]["type"]), (500, "InvalidOutput"), reply.body)
        self.assertRegex(reply.json["error"]["message"], "its result is invalid, since .* times the speed of sound")
        with self.assertRaisesRegex(Exception, "its result is invalid"):
            umbridge.HTTPModel(self.daemon.url, "soft")(body["input"])

    def test_errors(self):
        def error(path, body, kind):
            for content_type in (
                "application/json",
                "text/plain",
                "application/x-www-form-urlencoded",
                "multipart/form-data; boundary=x",
            ):
                reply = self.daemon.post(path, json.dumps(body), headers={"Content-Type": content_type})
                self.assertEqual(reply.status, 400, (path, body, reply.body))
                self.assertEqual(set(reply.json), {"error"})
                self.assertEqual(set(reply.json["error"]), {"type", "message"})
                self.assertEqual(reply.json["error"]["type"], kind, (path, body))

        for path in (
            "/ModelInfo",
            "/InputSizes",
            "/OutputSizes",
            "/Evaluate",
            "/Gradient",
            "/ApplyJacobian",
            "/ApplyHessian",
        ):
            error(path, {"name": "none"}, "ModelNotFound")
            error(path, {}, "ModelNotFound")
            error(path, {"name": "../slope"}, "ModelNotFound")
        for path in ("/Gradient", "/ApplyJacobian", "/ApplyHessian"):
            error(path, {"name": "slope", "input": "nonsense"}, "UnsupportedFeature")
        for wrong in (
            {},
            {"input": 1},
            {"input": [[1.0]]},
            {"input": [[0.0] * self.TERMS, []]},
            {"input": [["a"] * self.TERMS]},
            {"input": [[0.0] * self.TERMS], "config": {"nonsense": 1}},
            {"input": [[1e9] * self.TERMS]},
        ):
            error("/Evaluate", {"name": "slope", **wrong}, "InvalidInput")
        for body in ("", "{", "[]"):
            self.assertEqual(self.daemon.post("/Evaluate", body).status, 400)
        said = self.daemon.post("/Evaluate", "{").json["error"]
        self.assertEqual(said["type"], "InvalidInput")
        self.assertIn("the body is not JSON; body:1:2: syntax error", said["message"])

    def test_the_quotas_hold_here_too(self):
        body = {"name": "slope", "input": [[0.0] * self.TERMS, [1e6]], "config": {"parameters": ["end_s"]}}
        reply = self.daemon.post("/Evaluate", body)
        self.assertEqual((reply.status, reply.json["error"]["type"]), (400, "InvalidInput"), reply.body)
        self.assertIn("steps of a run", reply.json["error"]["message"])

    def test_exactly_the_keys_of_the_protocol(self):
        self.assertEqual(self.daemon.get("/Info").json, {"protocolVersion": 1.0, "models": ["slope"]})
        for path, body, expected in (
            (
                "/ModelInfo",
                {},
                {"support": {"Evaluate": True, "Gradient": False, "ApplyJacobian": False, "ApplyHessian": False}},
            ),
            ("/InputSizes", {}, {"inputSizes": [self.TERMS]}),
            ("/OutputSizes", {"config": {}}, {"outputSizes": [5]}),
        ):
            self.assertEqual(self.daemon.post(path, {"name": "slope", **body}).json, expected)


class Owslib(ServiceTest):
    def test_the_processes_client(self):
        from owslib.ogcapi.processes import Processes
        self.start()
        client = Processes(self.daemon.url)
        self.assertEqual([p["id"] for p in client.processes()], ["influence-zone", "echo"])
        self.assertIn("case", client.process("influence-zone")["inputs"])
        self.assertEqual(client.execute("echo", {"s": "hello"}), {"s": "hello"})
        info = client.execute("influence-zone", study(3)["inputs"], async_=True)
        job = info["jobID"]
        self.daemon.wait_for(job)
        results = client._request(path=f"jobs/{job}/results")  # it has no method for results
        self.assertEqual(sum(results["histogram"]["value"]["histogram"]["counts"]), 3)


class Verbs(ServiceTest):
    """talus submit, status, watch, results, cancel."""

    def talus(self, *arguments, code=0, **environment):
        done = subprocess.run([str(TALUS), *map(str, arguments)], capture_output=True, text=True, timeout=120,
                              env=dict(os.environ, TALUS_SERVER=self.daemon.url, **environment))
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def test_from_submit_to_cancel(self):
        self.start()
        (self.dir / "bed.csv").write_text("x,y\n0,8.2\n14.202,0\n60,0\n")  # a file beside the case is sent along
        document = case()
        del document["terrain"]["bed_m"]
        document["terrain"]["bed_csv"] = "bed.csv"
        path = self.dir / "case.json"
        path.write_text(json.dumps(document))
        job = self.talus(
            "submit", path, "--realizations", 5, "--seed", 3, "--set", "study.noise_floor_replicates=0"
        ).stdout.strip()
        watched = self.talus("watch", job)
        self.assertIn("successful  100 %", watched.stderr)
        self.assertIn(job, self.talus("status").stdout)
        self.assertEqual(json.loads(self.talus("status", job, "--json").stdout)["realizations"]["done"], 5)
        self.talus("results", job, "--out", self.dir / "results.json")
        self.assertEqual(
            json.loads((self.dir / "results.json").read_text())["summary"]["value"]["provenance"]["seed"], 3
        )
        self.assertIn("run-out distance", self.talus("results", job).stdout)
        self.assertIn("dismissed", self.talus("cancel", job).stdout)
        self.talus("watch", job, code=6)
        self.talus("results", job, code=5)
        self.talus("status", "../x", code=3)
        self.talus("status", "0" * 32, code=5)
        subprocess.run(
            [
                str(TALUS),
                "study",
                str(path),
                "--realizations",
                "5",
                "--seed",
                "3",
                "--out",
                str(self.dir / "local"),
                "--no-figures",
                "--set",
                "study.noise_floor_replicates=0",
            ],
            check=True,
            capture_output=True,
        )
        remote = json.loads((self.dir / "results.json").read_text())["summary"]["value"]
        local = json.loads((self.dir / "local/study.json").read_text())
        local.pop("checksum")  # of the file
        for summary in (remote, local):
            summary.pop("effort")
        self.assertEqual(remote, local)

    def test_both_front_ends_take_the_same_documents(self):
        self.start()
        path = self.dir / "case.json"
        local = ["study", path, "--realizations", 1, "--out", self.dir / "local", "--prepare"]
        path.write_text(json.dumps(case(description="slope " * 833)))  # 4998 characters
        self.talus(*local)
        self.talus("submit", path, "--realizations", 1)
        path.write_text(json.dumps(case(description="x" * 65537)))
        self.assertIn("longer than 65536 bytes", self.talus(*local, code=3).stderr)
        self.assertIn("longer than 65536 bytes", self.talus("submit", path, "--realizations", 1, code=3).stderr)

    def test_errors_of_the_server_are_shown(self):
        self.start("--max-realizations", 2)
        path = self.dir / "case.json"
        path.write_text(json.dumps(case()))
        self.assertIn("at most 2", self.talus("submit", path, "--realizations", 5, code=3).stderr)
        self.assertIn("cannot reach", self.talus("status", "--server", "http://127.0.0.1:1", code=5).stderr)
        self.assertIn("not a URL", self.talus("status", "--server", "nonsense://x y", code=3).stderr)

    def test_tokens(self):
        made = subprocess.run([TALUSD, "--new-token", "submit", "anna"], capture_output=True, text=True, check=True)
        token, line = (text.split(": ", 1)[1] for text in made.stdout.splitlines())
        (self.dir / "tokens").write_text(line + "\n")
        (self.dir / "token").write_text(token + "\n")
        self.start("--tokens", self.dir / "tokens")
        self.assertIn("token", self.talus("status", code=5).stderr)
        self.assertIn("token", self.talus("status", code=5, TALUS_TOKEN="wrong").stderr)
        for more, environment in ((["--token-file", self.dir / "token"], {}), ([], {"TALUS_TOKEN": token})):
            done = self.talus("status", *more, **environment)
            self.assertNotIn(token, done.stdout + done.stderr)


class Schemathesis(ServiceTest):
    """Requests made up from the OpenAPI document: no 5xx and no answer that it does not declare."""

    def test_the_document_holds(self):
        self.start("--max-jobs-each", 100000, "--max-jobs", 100000, "--max-realizations", 50)
        job = self.daemon.submit(study(3))
        self.daemon.wait_for(job)
        self.explore()
        # Again with a job and realizations that are there, so that more than 404 comes back.
        (self.dir / "schemathesis.toml").write_text(
            f'[parameters]\n"path.jobID" = "{job}"\n"path.index" = 1\n"path.processID" = "echo"\n'
        )
        self.explore("--exclude-operation-id", "dismiss")
        self.assertIsNone(self.daemon.process.poll())

    def explore(self, *options):
        program = os.path.join(os.path.dirname(sys.executable), "schemathesis")
        done = subprocess.run(
            [
                program,
                "run",
                f"{self.daemon.url}/api",
                "--phases",
                "examples,coverage,fuzzing",
                "--max-examples",
                "15",
                "--checks",
                "not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance",
                "--exclude-path-regex",
                "/events$",
                "--seed",
                "1",
                "--request-timeout",
                "20",
                "--no-color",
                *options,
            ],
            capture_output=True,
            text=True,
            cwd=self.dir,
            timeout=500,
        )
        self.assertEqual(done.returncode, 0, done.stdout[-6000:] + done.stderr[-2000:])
        print(done.stdout[-600:], flush=True)


if __name__ == "__main__":
    main({"Umbridge": Umbridge, "Owslib": Owslib, "Verbs": Verbs, "Schemathesis": Schemathesis})
