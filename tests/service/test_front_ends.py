#!/usr/bin/env python3
"""One study through `talus study` and through talusd: the same rules, the same files."""
import json
import pathlib
import subprocess
import time

from daemon import TALUS, ServiceTest, case, main


class Ended:
    """How a study ended: `code` is the exit code of `talus study`, and what the state of a job stands for."""

    def __init__(self, directory, code, said):
        self.directory, self.code, self.said = pathlib.Path(directory), code, said

    def names(self, pattern):
        return sorted(path.name for path in self.directory.glob(pattern))

    def summary(self):
        summary = json.loads((self.directory / "study.json").read_text())
        summary.pop("effort")  # seconds
        summary.pop("checksum")  # which covers them
        return summary


class FrontEnds(ServiceTest):
    def by_command(self, document, disturb=None):
        path = self.dir / "case.json"
        path.write_text(json.dumps(document))
        out = self.dir / "study"
        process = subprocess.Popen(
            [TALUS, "study", path, "--out", out, "--workers", "2", "--no-figures"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if disturb:
            disturb(out)
        said = process.communicate(timeout=300)
        return Ended(out, process.returncode, said[1])

    def by_service(self, document, disturb=None):
        self.start()
        reply = self.daemon.post("/processes/influence-zone/execution", {"inputs": {"case": document}})
        if reply.status != 201:
            return Ended(self.dir / "none", 3, reply.body.decode())
        directory = self.daemon.data / "jobs" / reply.json["jobID"]
        if disturb:
            disturb(directory)
        info = self.daemon.wait_for(reply.json["jobID"], seconds=300)
        refused = "refuses the case" in info["message"]
        code = 0 if info["status"] == "successful" else 3 if refused else 7
        return Ended(directory, code, info["message"])

    def both(self, document, disturb=None):
        return {"talus study": self.by_command(document, disturb), "talusd": self.by_service(document, disturb)}

    @staticmethod
    def document(**study):
        return case(study={"seed": 7, "noise_floor_replicates": 2, **study})

    def test_a_study_gives_the_same_files(self):
        document = self.document(realizations=9)
        ended = self.both(document)
        one, other = ended.values()
        self.assertEqual((one.code, other.code), (0, 0), (one.said, other.said))
        self.assertEqual(one.summary(), other.summary())
        for pattern in ("runs/*", "floor/*", "profiles/*", "*.csv", "plan.json", "case.resolved.json"):
            self.assertEqual(one.names(pattern), other.names(pattern), pattern)
        self.assertEqual(one.names("profiles/*"), ["first.json", "first.vtkhdf", "worst.json", "worst.vtkhdf"])
        for file in ("plan.json", "case.resolved.json", "profiles/worst.json"):
            self.assertEqual((one.directory / file).read_text(), (other.directory / file).read_text(), file)
        farthest = one.summary()["extremes"]["farthest_realization"]
        self.assertEqual(json.loads((one.directory / "profiles/worst.json").read_text())["realization"], farthest)
        if subprocess.run(["which", "gnuplot"], capture_output=True).returncode == 0:
            for study in (one, other):
                subprocess.run([TALUS, "plot", study.directory], check=True, capture_output=True)
                self.assertIn("speed_worst.svg", study.names("figures/*"))

    def test_too_many_failures_end_it_early(self):
        document = self.document(realizations=300, max_failed_share=0.02)
        document["time"] = {"end_s": 100, "fixed_step_s": 0.05}  # far beyond the stable one: every run diverges
        for name, ended in self.both(document).items():
            with self.subTest(name):
                self.assertEqual(ended.code, 7, ended.said)
                self.assertIn("max_failed_share", ended.said)
                failed = ended.names("runs/*.failed.json")
                self.assertGreater(len(failed), 6)  # 0.02 * 300
                self.assertLess(len(failed), 6 + 10)
                self.assertEqual(ended.summary()["realizations"]["failed"], len(failed))

    def test_a_study_without_a_result_has_failed_whatever_the_share(self):
        document = self.document(realizations=3, max_failed_share=1.0)
        document["time"] = {"end_s": 100, "fixed_step_s": 0.05}
        for name, ended in self.both(document).items():
            with self.subTest(name):
                self.assertEqual(ended.code, 7, ended.said)
                self.assertEqual(len(ended.names("runs/*.failed.json")), 3)

    def test_a_case_that_a_run_refuses_ends_it_without_a_failed_realization(self):
        def spoil(directory):
            deadline = time.monotonic() + 60
            while not list(directory.glob("runs/*.json")) and time.monotonic() < deadline:
                time.sleep(0.005)
            (directory / "spoilt").write_text("{}")
            (directory / "spoilt").rename(directory / "case.resolved.json")

        for name, ended in self.both(self.document(realizations=400), spoil).items():
            with self.subTest(name):
                self.assertEqual(ended.code, 3, ended.said)
                self.assertIn("refuses the case", ended.said)
                self.assertEqual(ended.names("runs/*.failed.json"), [])

    def test_an_early_stop_is_the_same(self):
        document = self.document(realizations=60, stop_when_ci_half_width_below_m=0.6)
        document["study"]["max_failed_share"] = 1.0
        one, other = self.both(document).values()
        self.assertEqual((one.code, other.code), (0, 0), (one.said, other.said))
        self.assertTrue(one.summary()["realizations"]["stopped_early"])
        self.assertEqual(one.summary(), other.summary())

    def test_texts_have_the_same_limits(self):
        fits = self.document(realizations=1, noise_floor_replicates=0)
        fits["description"] = "x" * 5000
        for name, ended in self.both(fits).items():
            with self.subTest(name):
                self.assertEqual(ended.code, 0, ended.said)

    def test_too_long_a_text_is_refused(self):
        document = self.document(realizations=1)
        document["description"] = "x" * 70_000
        for name, ended in self.both(document).items():
            with self.subTest(name):
                self.assertEqual(ended.code, 3, ended.said)

    def test_a_seed_that_nobody_gave_is_recorded_and_exact(self):
        document = self.document(realizations=1, noise_floor_replicates=0)
        del document["study"]["seed"]
        seeds = []
        for ended in self.both(document).values():
            self.assertEqual(ended.code, 0, ended.said)
            seeds.append(json.loads((ended.directory / "plan.json").read_text())["seed"])
        self.assertNotEqual(seeds[0], seeds[1])
        self.assertTrue(all(0 <= seed < 2**53 for seed in seeds), seeds)


if __name__ == "__main__":
    main({"FrontEnds": FrontEnds})
