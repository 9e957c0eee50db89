#!/usr/bin/env python3
"""A study whose runs others make: talus study --prepare, talus stats --from-runs and --quantity.

usage: test_books.py TALUS SOURCE_DIR [unittest arguments]
"""
import json
import sys
import unittest

from cli import Directory, load, table, talus

CASE = {"time": {"end_s": 0.5}, "particle_spacing_m": 1.0, "study": {"noise_floor_replicates": 1}}
SEED = 5


class Books(Directory):
    def setUp(self):
        super().setUp()
        self.file = self.case(**CASE)
        self.out = self.dir / "study"

    def prepare(self, realizations, seed=SEED, code=0):
        done = talus("study", self.file, "--prepare", "--realizations", realizations, "--seed", seed, "--out", self.out)
        self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
        return done

    def make(self, name, realization, *arguments):
        """Runs one realization as the service does and puts its result into the books."""
        work = self.dir / f"work-{name.replace('/', '-')}"
        done = talus(
            "run",
            self.out / "case.resolved.json",
            "--realization",
            realization,
            "--seed",
            SEED,
            "--out",
            work,
            "--study-worker",
            *arguments,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        place = self.out / f"{name}.json"
        place.parent.mkdir(exist_ok=True)
        (work / "result.json").rename(place)

    def make_all(self, realizations):
        self.prepare(realizations)
        for i in range(realizations):
            self.make(f"runs/{i:06}", i)
        self.make("floor/1", 0, "--perturbation", "1e-6")

    def stats(self, *arguments, code=0):
        done = talus("stats", self.out, *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def distribution(self, *arguments):
        return json.loads(self.stats("--from-runs", *arguments).stdout)

    def test_preparing_writes_plan_and_case_and_runs_nothing(self):
        self.prepare(3)
        self.assertEqual({p.name for p in self.out.iterdir() if not p.name.startswith("talus-output")},
                         {"plan.json", "case.resolved.json"})
        plan = load(self.out / "plan.json")
        self.assertEqual((plan["realizations"], plan["seed"], plan["noise_floor_replicates"]), (3, SEED, 1))
        self.assertEqual(load(self.out / "case.resolved.json")["study"]["seed"], SEED)

    def test_preparing_again_makes_it_longer_and_leaves_its_runs(self):
        self.prepare(1)
        self.make("runs/000000", 0)
        before = (self.out / "runs/000000.json").read_text()
        self.prepare(4)
        self.assertEqual(load(self.out / "plan.json")["realizations"], 4)
        self.assertEqual((self.out / "runs/000000.json").read_text(), before)
        self.assertIn("seed", self.prepare(4, seed=SEED + 1, code=5).stderr)
        self.assertEqual(load(self.out / "plan.json")["seed"], SEED)

    def test_statistics_of_a_prepared_study_leave_it_able_to_go_on(self):
        self.prepare(2)
        self.stats("--from-runs")
        self.prepare(2)
        done = talus("study", self.file, "--realizations", 2, "--seed", SEED, "--out", self.out, "--no-figures")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_preparing_a_bad_case_is_3(self):
        self.file.write_text("{}")
        self.prepare(1, code=3)
        self.assertFalse(self.out.exists())

    def test_statistics_of_runs_made_elsewhere_are_those_of_a_study(self):
        self.make_all(4)
        self.stats("--from-runs")
        whole = self.dir / "whole"
        done = talus("study", self.file, "--realizations", 4, "--seed", SEED, "--out", whole, "--no-figures")
        self.assertEqual(done.returncode, 0, done.stderr)
        mine, expected = load(self.out / "study.json"), load(whole / "study.json")
        for key in ("realizations", "quantities", "noise_floor"):
            self.assertEqual(mine[key], expected[key], key)
        digests = [[row["digest"] for row in table(d / "realizations.csv")] for d in (self.out, whole)]
        self.assertEqual(*digests)
        self.assertEqual(len(set(digests[0])), 4)

    def test_a_partial_study_counts_what_is_there(self):
        self.prepare(4)
        self.make("runs/000002", 2)
        (self.out / "runs/000001.failed.json").write_text('{"reason": "diverged: on purpose"}')
        self.stats("--from-runs")
        realizations = load(self.out / "study.json")["realizations"]
        self.assertEqual([realizations[k] for k in ("planned", "done", "failed", "complete")], [4, 1, 1, False])
        rows = {row["index"]: row for row in table(self.out / "realizations.csv")}
        self.assertEqual({i: rows[i]["status"] for i in rows}, {"1": "failed", "2": "done"})
        self.assertEqual(rows["1"]["reason"], "diverged: on purpose")

    def test_one_quantity_is_printed_and_nothing_written(self):
        self.make_all(4)
        before = sorted(self.out.rglob("*"))
        sample = [load(self.out / f"runs/{i:06}.json")["front_mass_99_m"] for i in range(4)]
        d = self.distribution("--quantity", "front_mass_99_m")
        self.assertEqual((d["quantity"], d["planned"], d["done"], d["failed"], d["n"]), ("front_mass_99_m", 4, 4, 0, 4))
        self.assertAlmostEqual(d["mean"], sum(sample) / 4)
        self.assertEqual((d["min"], d["max"]), (min(sample), max(sample)))
        self.assertEqual(sum(d["histogram"]["counts"]), 4)
        self.assertEqual(sorted(self.out.rglob("*")), before)

    def test_a_question_before_the_first_run_writes_nothing(self):
        self.prepare(2)
        before = sorted(self.out.rglob("*"))
        self.assertEqual(self.distribution("--quantity", "influence_zone_m")["n"], 0)
        self.assertEqual(sorted(self.out.rglob("*")), before)
        self.stats("--from-runs", "--quantity", "influence_zone", code=2)
        self.assertEqual(sorted(self.out.rglob("*")), before)

    def test_a_study_without_its_case_is_merged_into_nothing(self):
        self.make_all(1)
        self.stats("--from-runs")
        (self.out / "case.resolved.json").unlink()
        self.stats("--out", self.dir / "merged", code=5)
        self.assertFalse((self.dir / "merged").exists())

    def test_bins_are_equal_and_edges_are_those_given(self):
        self.make_all(4)
        sample = sorted(load(self.out / f"runs/{i:06}.json")["influence_zone_m"] for i in range(4))
        h = self.distribution("--quantity", "influence_zone_m", "--bins", 3)["histogram"]
        widths = [b - a for a, b in zip(h["edges"], h["edges"][1:])]
        self.assertEqual((len(h["counts"]), sum(h["counts"]), h["edges_given"]), (3, 4, False))
        for width in widths:
            self.assertAlmostEqual(width, widths[0])
        self.assertEqual((h["edges"][0] <= sample[0], h["edges"][-1] >= sample[-1]), (True, True))
        edges = [(sample[0] + sample[1]) / 2, (sample[1] + sample[2]) / 2, (sample[2] + sample[3]) / 2]
        h = self.distribution("--quantity", "influence_zone_m", "--edges", ",".join(map(repr, edges)))["histogram"]
        self.assertEqual(
            (h["edges"], h["counts"], h["underflow"], h["overflow"], h["edges_given"]), (edges, [1, 1], 1, 1, True)
        )

    def test_misuse_is_2(self):
        self.prepare(1)
        for arguments in (
            ["--bins", 3],
            ["--edges", "1,2"],
            ["--quantity", "x"],
            ["--quantity", "influence_zone_m", "--bins", 0],
            ["--quantity", "influence_zone_m", "--bins", 2, "--edges", "1,2"],
            ["--quantity", "influence_zone_m", "--edges", "2,1"],
            ["--quantity", "influence_zone_m", "--edges", "1,1"],
            ["--quantity", "influence_zone_m", "--edges", "1"],
            [self.out, "--from-runs"],
        ):
            done = self.stats("--from-runs", *arguments, code=2)
            self.assertTrue(done.stderr, arguments)

    def test_without_a_plan_is_5(self):
        self.out.mkdir()
        self.assertIn("plan.json", self.stats("--from-runs", code=5).stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
