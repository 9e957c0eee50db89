#!/usr/bin/env python3
"""Targets from the command line: results, histories, probabilities and comparisons.

usage: test_targets.py TALUS SOURCE_DIR [unittest arguments]
"""
import json
import signal
import sys
import unittest

from cli import Directory, check_schema, load, start, table, talus, wait_for

ROAD = {"name": "road", "stretch_m": [28, 31]}
FAR = {"name": "far", "point_m": [45]}
WALL = {"name": "wall", "structure": {"x_m": [24, 27], "height_m": 3}}
SOIL = {"density_kg_m3": 2200, "friction_angle_deg": 25}
FIELD = {"correlation_length_m": 4, "log_stdev": 0.2}


class Targets(Directory):
    def case_with(self, targets, **changes):
        changes = {"time": {"end_s": 6}, "random_field": FIELD, "material": SOIL, **changes}
        path = self.case(targets=targets, **changes)
        return path.rename(self.dir / f"case-{len(list(self.dir.iterdir()))}.json")

    def study(self, out, targets, *arguments, **changes):
        done = talus("study", self.case_with(targets, **changes), "--realizations", 6, "--seed", 3, "--no-figures",
                     "--out", self.dir / out, "--set", "study.noise_floor_replicates=0", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_run_states_what_happened_at_each(self):
        done = talus("run", self.case_with([ROAD, FAR, WALL]), "--out", self.dir / "run")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = load(self.dir / "run/result.json")
        check_schema("result", result)
        road, far, wall = result["targets"]
        self.assertEqual([t["kind"] for t in result["targets"]], ["stretch", "point", "structure"])
        self.assertTrue(wall["arrives"])
        self.assertGreater(wall["peak_horizontal_force_N_m"], 1000)
        self.assertFalse(far["arrives"])
        self.assertIsNone(far["arrival_s"])
        self.assertNotIn("peak_horizontal_force_N_m", road)
        self.assertRegex(done.stdout, r"\nwall +reached after [\d.]+ s: depth .* force .* kN/m, overturning moment ")
        self.assertRegex(done.stdout, r"\nfar +not reached\n")
        rows = [row for row in table(self.dir / "run/targets.csv") if row["target"] == "wall"]
        self.assertEqual(float(rows[-1]["horizontal_impulse_Ns_m"]), wall["horizontal_impulse_Ns_m"])
        times = [float(row["time_s"]) for row in table(self.dir / "run/history.csv")]
        self.assertEqual([float(row["time_s"]) for row in rows], times)
        # What is written is what was gained between two rows.
        gained = float(rows[-1]["horizontal_impulse_Ns_m"]) - float(rows[-2]["horizontal_impulse_Ns_m"])
        self.assertAlmostEqual(float(rows[-1]["horizontal_force_N_m"]) * (times[-1] - times[-2]) / gained, 1.0, 9)

    def test_an_interrupted_run_goes_on_with_the_same_numbers(self):
        case = self.case_with([ROAD, WALL])
        self.assertEqual(talus("run", case, "--out", self.dir / "whole").returncode, 0)
        process = start("run", case, "--out", self.dir / "parts")
        wait_for((self.dir / "parts/snapshots.vtkhdf").exists, process, "the run began")
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.assertEqual(talus("run", case, "--out", self.dir / "parts").returncode, 0)
        self.assertEqual((self.dir / "parts/targets.csv").read_text(), (self.dir / "whole/targets.csv").read_text())
        self.assertEqual(load(self.dir / "parts/result.json")["targets"], load(self.dir / "whole/result.json")["targets"])

    def test_bad_targets_are_refused_and_nothing_is_written(self):
        done = talus("run", self.case_with([{"name": "deep", "point_m": [30, -3]}]), "--out", self.dir / "run")
        self.assertEqual(done.returncode, 3)
        self.assertIn("/targets/0/point_m: lies ", done.stderr)
        self.assertFalse((self.dir / "run").exists())

    def test_a_study_states_probabilities(self):
        printed = self.study("study", [ROAD, FAR])
        self.assertIn("far reached: 0.00, 95 % 0.00 to 0.39, 0 of 6\n", printed)
        study = load(self.dir / "study/study.json")
        check_schema("study", study)
        rows = table(self.dir / "study/realizations.csv")
        hits = sum(int(row["road.arrives"]) for row in rows)
        self.assertEqual(study["targets"][0]["reached"]["k"], hits)
        fronts = sorted(float(row["front_mass_99_m"]) for row in rows)
        middle = 0.5 * (fronts[2] + fronts[3])
        done = talus("stats", self.dir / "study", "--at", repr(middle), "--at", "name=road", "--at", "name=far")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.splitlines()
        self.assertTrue(lines[0].startswith(f"P(front_mass_99_m > {middle!r} m) = 0.50, 95 % 0.19 to 0.81, 3 of 6"), lines)
        self.assertTrue(lines[1].startswith(f"P(road reached) = {hits / 6:.2f}, "), lines)
        self.assertEqual(lines[2], "P(far reached) = 0.00, 95 % 0.00 to 0.39, 0 of 6")
        answers = json.loads(talus("stats", self.dir / "study", "--json", "--at", "0.1", "--quantity", "road.peak_depth_m").stdout)
        self.assertEqual(answers[0]["k"], sum(float(row["road.peak_depth_m"]) > 0.1 for row in rows))

    def test_questions_that_have_no_answer(self):
        self.study("study", [ROAD])
        for arguments, words in ((["--at", "name=roda"], "(road?)"), (["--at", "far"], "neither a number nor name=TARGET"),
                                 (["--quantity", "road.peak_depth", "--at", "1"], "(road.peak_depth_m?)"),
                                 (["--quantity", "road.peak_depth_m"], "goes with --at"),
                                 (["--at", "1", "--quantity", "front_mass_99_m", "--bins", "3"], "does not go with bins")):
            done = talus("stats", self.dir / "study", *arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertIn(words, done.stderr)

    def test_a_barrier_is_compared_on_the_same_draws(self):
        self.study("without", [ROAD])
        self.study("with", [ROAD, WALL])
        done = talus("compare", self.dir / "without", self.dir / "with", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        all_ = json.loads(done.stdout)
        self.assertEqual(all_["pairs"], 6)
        self.assertEqual(all_["case_differences"], ["/targets"])
        a, b = (table(self.dir / name / "realizations.csv") for name in ("without", "with"))
        differences = [float(y["front_mass_99_m"]) - float(x["front_mass_99_m"]) for x, y in zip(a, b)]
        front = all_["quantities"]["front_mass_99_m"]
        self.assertAlmostEqual(front["difference"], sum(differences) / 6, 9)
        self.assertLess(front["difference_ci95"][1], 0, "the barrier holds nothing back")
        self.assertEqual([t["name"] for t in all_["targets"]], ["road"])
        text = talus("compare", self.dir / "without", self.dir / "with").stdout
        self.assertIn("6 pairs on the same draws, seed 3", text)
        self.assertIn("differs: /targets\n", text)
        self.assertIn("road reached: ", text)

    def test_studies_of_other_draws_are_not_compared(self):
        self.study("one", [ROAD])
        self.study("two", [ROAD], random_field={**FIELD, "log_stdev": 0.1})
        done = talus("compare", self.dir / "one", self.dir / "two")
        self.assertEqual((done.returncode, done.stdout), (3, ""))
        self.assertIn("/random_field/log_stdev: differs", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
