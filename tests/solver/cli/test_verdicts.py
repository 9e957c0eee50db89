#!/usr/bin/env python3
"""Runs and studies that look right and are not must say so, in their first line and in every file.

usage: test_verdicts.py TALUS SOURCE_DIR [Run] [Study]
"""
import sys
import unittest

from cli import SOURCE, Directory, check_schema, load, table, talus

SLOPE, SMALL = (SOURCE / "tests/solver/cli/trials" / name for name in ("slope.json", "small-slope.json"))


def overrides(settings):
    return [word for setting in settings for word in ("--set", setting)]


class Run(Directory):
    def verdict(self, *settings, case=SLOPE, extra=()):
        """result.json and stdout of a run that must end with exit code 0."""
        out = self.dir / str(len(list(self.dir.iterdir())))
        done = talus("run", case, *overrides(settings), "--out", out, "--threads", 1, *extra)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = load(out / "result.json")
        check_schema("result", result)
        self.stderr = done.stderr
        return result["quality"], done.stdout.splitlines()

    def assert_says(self, check, verdict, *settings, **options):
        quality, lines = self.verdict(*settings, **options)
        reasons = {reason["check"]: reason for reason in quality["reasons"]}
        self.assertIn(check, reasons, f"{settings}: {quality}")
        self.assertEqual(reasons[check]["verdict"], verdict, settings)
        worst = next(reason for reason in quality["reasons"] if reason["verdict"] == quality["verdict"])
        self.assertEqual(lines[0], f"{quality['verdict']}: {worst['message']}")
        return quality

    def test_a_sound_run_says_nothing(self):
        quality, lines = self.verdict("particle_spacing_m=0.8")
        self.assertEqual(quality, {"verdict": "sound", "reasons": []})
        self.assertEqual(lines[0], "distances from x = 0 m to the right")
        self.assertEqual(self.stderr, "")

    def test_a_courant_number_beyond_stability_is_refused(self):
        for settings in (["numerics.integrator=leapfrog", "numerics.cfl=0.6"], ["numerics.cfl=1.0"]):
            done = talus("run", SLOPE, *overrides(settings), "--out", self.dir / "a")
            self.assertEqual(done.returncode, 3)
            self.assertIn("/numerics/cfl", done.stderr)
            self.assertIn("is too large for integrator", done.stderr)

    def test_an_unstable_run_is_invalid(self):
        # 0.6 h/c: h = 0.6 m, elastic wave of 165 m/s
        settings = ["time.fixed_step_s=0.0022", "numerics.integrator=leapfrog"]
        quality = self.assert_says("energy_created", "invalid", *settings)
        self.assertIn("unstable_time_step", [reason["check"] for reason in quality["reasons"]])
        self.assertIn("still_moving", [reason["check"] for reason in quality["reasons"]])  # the deposit shakes
        self.assertIn("warning: /time/fixed_step_s the fixed time step has the Courant number", self.stderr)

    def test_a_slow_sound_is_invalid(self):
        settings = ["particle_spacing_m=0.8"]
        self.assert_says("compression", "doubtful", "numerics.sound_speed_m_s=30", *settings)
        self.assert_says("mach_number", "invalid", "numerics.sound_speed_m_s=10", *settings)
        self.assert_says("mach_number", "invalid", "numerics.sound_speed_m_s=8", *settings)

    def test_a_run_without_damping_is_doubtful(self):
        self.assert_says("still_moving", "doubtful", "numerics.artificial_viscosity_alpha=0", "numerics.density_filter=none")

    def test_a_run_that_ends_too_early_is_doubtful(self):
        quality = self.assert_says("still_moving", "doubtful", "particle_spacing_m=0.8", "time.end_s=2")
        self.assertIn("when the run ended at t = 2 s", quality["reasons"][0]["message"])

    def test_a_bed_that_is_too_short_is_doubtful(self):
        self.assert_says("left_terrain", "doubtful", "particle_spacing_m=0.8", "terrain.bed_m.2.0=28")

    def test_too_few_particles_are_doubtful_and_warned_of(self):
        self.assert_says("few_particles_across", "doubtful", "particle_spacing_m=2")
        self.assertIn("warning: /particle_spacing_m the slide is 4 particles thick at most, where 5 are needed", self.stderr)

    def test_a_short_correlation_length_is_doubtful_where_the_field_varies(self):
        settings = ["random_field.correlation_length_m=0.2", "random_field.terms=2000", "time.end_s=6"]
        self.assert_says("short_correlation_length", "doubtful", *settings, case=SMALL, extra=["--realization", 0])
        quality, _ = self.verdict(*settings, case=SMALL)  # the median run
        self.assertNotIn("short_correlation_length", [reason["check"] for reason in quality["reasons"]])

    def test_all_commands_print_the_same_warnings(self):
        settings = overrides(["random_field.correlation_length_m=0.2", "random_field.terms=10", "time.end_s=0.1"])
        run = talus("run", SMALL, *settings, "--out", self.dir / "a")
        study = talus("study", SMALL, *settings, "--realizations", 1, "--out", self.dir / "b", "--no-figures")
        validate = talus("validate", SMALL, *settings)
        warnings = [line for line in validate.stderr.splitlines() if line.startswith("warning: ")]
        self.assertEqual([line.split()[1] for line in warnings], ["/random_field", "/random_field"])
        for done in (run, study):
            self.assertEqual([line for line in done.stderr.splitlines() if line.startswith("warning: ")], warnings)
        kept = load(self.dir / "a/result.json")["warnings"]
        self.assertEqual([f"warning: {w['pointer']} {w['message']}" for w in kept], warnings)
        self.assertEqual(load(self.dir / "b/runs/000000.json")["warnings"], kept)


class Study(Directory):
    def study(self, *settings, realizations=4):
        done = talus("study", SMALL, *overrides(settings), "--realizations", realizations, "--out", self.dir / "s", "--no-figures", "--workers", 2)
        summary = load(self.dir / "s/study.json")
        check_schema("study", summary)
        return done, summary, table(self.dir / "s/realizations.csv")

    def test_runs_that_end_too_early(self):
        done, summary, rows = self.study("time.end_s=1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[0], "4 of 4 runs doubtful: still moving (4)")
        self.assertEqual(summary["quality"]["doubtful"], 4)
        self.assertEqual([row["verdict"] for row in rows], ["doubtful"] * 4)
        self.assertTrue(rows[0]["verdict_reasons"].startswith("still_moving: "))
        before = (self.dir / "s/study.json").read_text()
        self.assertEqual(talus("stats", self.dir / "s").stdout, done.stdout)
        self.assertEqual((self.dir / "s/study.json").read_text(), before)

    def test_soil_that_leaves(self):
        done, summary, rows = self.study("terrain.bed_m.2.0=10.5", "time.end_s=8")
        self.assertEqual(done.returncode, 0, done.stderr)
        left = [row for row in rows if float(row["left_domain"]) > 0]
        self.assertTrue(left)
        self.assertIn(f"left terrain ({len(left)})", done.stdout.splitlines()[0])
        for row in rows:
            self.assertEqual("left_terrain: " in row["verdict_reasons"], row in left)

    def test_invalid_runs_have_failed(self):
        done, summary, rows = self.study("numerics.sound_speed_m_s=5", "time.end_s=2")
        self.assertEqual(done.returncode, 7, done.stderr)  # none is done
        self.assertTrue(done.stdout.startswith("4 of 4 runs invalid: "), done.stdout)
        self.assertEqual((summary["realizations"]["done"], summary["realizations"]["failed"], summary["quality"]["invalid"]), (0, 4, 4))
        self.assertEqual({row["status"] for row in rows}, {"failed"})
        self.assertTrue(rows[0]["reason"].startswith("invalid result: "), rows[0])
        self.assertEqual(rows[0]["reason"], "invalid result: " + rows[0]["verdict_reasons"])

    def test_an_unstable_case(self):
        done = talus("study", SMALL, *overrides(["numerics.integrator=leapfrog", "numerics.cfl=0.95"]), "--out", self.dir / "s")
        self.assertEqual(done.returncode, 3)
        self.assertIn("/numerics/cfl 0.95 is too large", done.stderr.replace(": 0.95", " 0.95"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *(sys.argv[3:] or ["Run", "Study"])], verbosity=2)
