#!/usr/bin/env python3
"""Runs and studies that look right and are not must say so, in their first line and in every file.

usage: test_verdicts.py TALUS SOURCE_DIR [Run] [Study]
"""
import io
import json
import sys
import unittest

import h5py

from cli import SOURCE, Directory, check_schema, load, table, talus

SLOPE, SMALL = (SOURCE / "tests/solver/cli/trials" / name for name in ("slope.json", "small-slope.json"))


PREAMBLE = 512  # bytes of a checkpoint before its HDF5 part


def edit_checkpoint(path, change):
    """Calls change(file) with the HDF5 part of a checkpoint, and renews length and checksum (FNV-1a)."""
    body = io.BytesIO(path.read_bytes()[PREAMBLE:])
    with h5py.File(body, "r+") as file:
        change(file)
    checksum = 0xCBF29CE484222325
    for byte in body.getvalue():
        checksum = (checksum ^ byte) * 0x100000001B3 % 2**64
    head = f"talus checkpoint\nbytes {len(body.getvalue())}\nfnv1a64 {checksum:016x}\n".encode()
    path.write_bytes(head.ljust(PREAMBLE, b"\0") + body.getvalue())


def overrides(settings):
    return [word for setting in settings for word in ("--set", setting)]


class Run(Directory):
    def verdict(self, *settings, case=SLOPE, extra=()):
        """result.json and stdout of a run that must end with exit code 0."""
        out = self.dir / str(len(list(self.dir.iterdir())))
        done = talus("run", case, *overrides(settings), "--out", out, "--threads", 1, *extra)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.result = load(out / "result.json")
        check_schema("result", self.result)
        self.stderr = done.stderr
        return self.result["quality"], done.stdout.splitlines()

    def file(self, title, **members):
        path = self.dir / f"{title}.json"
        path.write_text(json.dumps({"title": title, **members}))
        return path

    def assert_says(self, check, verdict, *settings, **options):
        quality, lines = self.verdict(*settings, **options)
        reasons = {reason["check"]: reason for reason in quality["reasons"]}
        self.assertIn(check, reasons, f"{settings}: {quality}")
        self.assertEqual(reasons[check]["verdict"], verdict, settings)
        worst = next(reason for reason in quality["reasons"] if reason["verdict"] == quality["verdict"])
        self.assertEqual(lines[0], f"{quality['verdict']}: {worst['message']}")
        return quality

    def test_a_sound_run_says_nothing(self):
        quality, lines = self.verdict("particle_spacing_m=0.8", "material.viscosity_Pa_s=1500",
                                      "numerics.artificial_viscosity_jump=reconstructed")
        self.assertEqual(quality, {"verdict": "sound", "reasons": []})
        self.assertTrue(self.result["at_rest"])
        self.assertEqual(lines[0], "distances from x = 0 m to the right")
        self.assertEqual(self.stderr, "")
        energy = self.result["energy"]
        share = (energy["artificial_viscosity_J_m"] + energy["density_diffusion_J_m"]) / -energy["potential_J_m"]
        self.assertAlmostEqual(energy["numerical_share"], share, places=12)
        self.assertIn(f"numerical dissipation     {100 * share:10.1f} %   of gravity's work", "\n".join(lines))

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
        self.assertFalse(self.result["at_rest"])

    def test_a_slide_that_creeps_is_not_at_rest(self):
        path = self.file("viscous", particle_spacing_m=0.5, terrain={"bed_m": [[0, 40], [200, 20], [400, 0]]},
                         slide={"outlines": [{"outline_m": [[0, 40], [20, 38], [20, 42], [0, 44]]}]}, time={"end_s": 20},
                         material={"density_kg_m3": 2000, "friction_angle_deg": 5, "viscosity_Pa_s": 2e5})
        self.assert_says("creeping", "doubtful", case=path)
        self.assertFalse(self.result["at_rest"])
        front = self.result["influence_zone_m"]
        self.verdict("time.end_s=40", case=path)
        self.assertGreater(self.result["influence_zone_m"], front + 1, "it said that it would go on")

    def test_soil_that_the_numerics_hold_back_is_doubtful(self):
        # A slab on a plane of 10 degrees with a friction angle of 8 must accelerate for ever.
        slab = [[9.848, 50.36], [29.544, 46.887], [29.892, 48.857], [10.195, 52.33]]
        path = self.file("slab", particle_spacing_m=0.4, slide={"outlines": [{"outline_m": slab}]}, time={"end_s": 4},
                         terrain={"bed_m": [[0, 52.094], [295.442, 0]], "left_end": "open"},
                         material={"density_kg_m3": 2000, "friction_angle_deg": 8})
        self.assert_says("numerical_dissipation", "doubtful", "numerics.artificial_viscosity_jump=whole", case=path)
        quality, _ = self.verdict(case=path)
        self.assertNotIn("numerical_dissipation", [reason["check"] for reason in quality["reasons"]])

    def column(self, width, height, angle):
        """A column on a flat bed of 60 m, with a friction angle and no viscosity."""
        return self.file("column", particle_spacing_m=0.1, terrain={"bed_m": [[0, 0], [60, 0]]}, time={"end_s": 8},
                         slide={"outlines": [{"outline_m": [[0, 0], [width, 0], [width, height], [0, height]]}]},
                         material={"density_kg_m3": 1850, "friction_angle_deg": angle})

    def test_a_front_that_friction_cannot_reach_is_doubtful(self):
        # The energy line of the column meets the bed at 1 m + 2 m/tan(10 deg) = 12.3 m; its tip is pushed beyond.
        quality = self.assert_says("beyond_energy_line", "doubtful", case=self.column(1, 2, 10))
        self.assertGreater(self.result["front_mass_99_m"], 12.3)
        self.assertEqual(self.result["mass_kg_m"]["filled"], 3700)
        self.assertEqual({reason["check"] for reason in quality["reasons"]} - {"still_moving", "front_still_moving"},
                         {"beyond_energy_line", "separate_front"})

    def test_soil_that_hardly_loses_energy_says_so(self):
        quality, _ = self.verdict("numerics.sound_speed_m_s=10", "particle_spacing_m=0.8")
        self.assertIn("too_little_friction", [reason["check"] for reason in quality["reasons"]])
        self.assertIn("beyond_energy_line", [reason["check"] for reason in quality["reasons"]])

    def test_a_flow_of_two_rows_is_doubtful(self):
        # A slab of 1 m by 4 m slides 30 m down a plane of 30 degrees onto a flat: four rows, which thin out to one.
        slab = [[2.598, 14.5], [6.062, 12.5], [6.562, 13.366], [3.098, 15.366]]
        path = self.file("slab", particle_spacing_m=0.25, slide={"outlines": [{"outline_m": slab}]}, time={"end_s": 12},
                         terrain={"bed_m": [[0, 16], [25.981, 1], [125.981, 1]]}, numerics={"sound_speed_m_s": 60},
                         material={"density_kg_m3": 2000, "friction_angle_deg": 25})
        self.assert_says("thin_flow", "doubtful", case=path)

    def test_a_front_of_single_particles_is_doubtful_without_a_viscosity(self):
        column = self.column(1, 2, 15)
        self.assert_says("separate_front", "doubtful", case=column)
        self.assertGreater(self.result["front_mass_99_m"], self.result["front_connected_m"] + 0.5)
        quality, _ = self.verdict("material.viscosity_Pa_s=100", case=column)
        self.assertNotIn("separate_front", [reason["check"] for reason in quality["reasons"]])

    def test_mass_that_the_placement_adds_is_doubtful(self):
        column = self.column(1, 2, 25)
        self.assert_says("mass_changed", "doubtful", "particle_placement=nodes", case=column)
        self.assertIn("warning: /particle_placement the particles carry 15.5 % more mass", self.stderr)
        quality, _ = self.verdict("particle_placement=whole_cells", case=column)
        self.assertNotIn("mass_changed", [reason["check"] for reason in quality["reasons"]])
        validate = talus("validate", column, "--set", "particle_placement=nodes")
        self.assertIn("/particle_placement the particles carry 15.5 % more mass", validate.stderr)

    def test_soil_that_spills_over_an_end_wall_has_left(self):
        path = self.file("spill", particle_spacing_m=0.5, time={"end_s": 4},
                         terrain={"bed_m": [[0, 20], [20, 0], [24, 0]], "right_end": "wall", "wall_top_m": 20.5},
                         slide={"outlines": [{"outline_m": [[0, 20], [10, 10], [10, 16], [0, 26]]}]},
                         material={"density_kg_m3": 2000, "friction_angle_deg": 15})
        self.assert_says("left_terrain", "doubtful", case=path)
        self.assertGreater(self.result["left_domain"], 0)
        self.assertEqual(self.result["penetrated"], 0)
        self.verdict("terrain.left_wall_top_m=30", case=path)
        self.assertEqual(self.result["left_domain"], 0, "it spilled over the left wall")
        self.verdict("terrain.left_wall_top_m=30", "terrain.right_wall_top_m=1", case=path)
        self.assertGreater(self.result["left_domain"], 0, "over the right wall")

    def test_a_loose_rule_of_rest_ends_a_run_at_rest_that_is_doubtful(self):
        rule = 'time.stop_at_rest={"speed_m_s": 2.5, "hold_s": 0.1}'
        self.assert_says("still_moving", "doubtful", "particle_spacing_m=0.8", rule)
        self.assertEqual((self.result["ending"], self.result["at_rest"]), ("at_rest", True))

    def test_a_bed_that_is_too_short_is_doubtful(self):
        quality = self.assert_says("left_terrain", "doubtful", "particle_spacing_m=0.8", "terrain.bed_m.2.0=26")
        self.assertIn("front_at_open_end", [reason["check"] for reason in quality["reasons"]])
        bounds = ["influence_zone_m", "front_connected_m", "front_mass_99_m", "front_mass_999_m", "centre_of_mass_x_m",
                  "front_at_thickness_m"]
        self.assertEqual(self.result["lower_bounds"], bounds)  # 15 % of the soil left

    def test_a_front_within_the_reach_of_the_kernel_is_doubtful(self):
        """0.53 m before the end: more than a spacing, less than 2h."""
        self.assert_says("front_at_open_end", "doubtful", "terrain.bed_m.2.0=34")
        self.assertGreater(34 - self.result["influence_zone_m"], 0.4)
        self.assertEqual(self.result["left_domain"], 0)

    def test_a_front_that_ends_on_the_terrain_is_no_lower_bound(self):
        quality, lines = self.verdict("particle_spacing_m=0.4", "terrain.bed_m.2.0=33")
        self.assertEqual([reason["check"] for reason in quality["reasons"]][0], "left_terrain")
        result = self.result
        self.assertLess(result["front_mass_99_m"], 32)
        self.assertLess(result["left_domain"], 0.01 * result["particles"]["soil"])
        self.assertIn("influence_zone_m", result["lower_bounds"])
        self.assertIn("centre_of_mass_x_m", result["lower_bounds"])
        self.assertNotIn("front_mass_99_m", result["lower_bounds"])
        self.assertIn(f">={result['influence_zone_m']:.3f} m", "\n".join(lines))

    def test_too_few_particles_are_doubtful_and_warned_of(self):
        self.assert_says("few_particles_across", "doubtful", "particle_spacing_m=2")
        self.assertIn("warning: /particle_spacing_m the slide is 4 particles thick at most, where 5 are needed", self.stderr)

    def test_a_short_correlation_length_is_doubtful_where_the_field_varies(self):
        settings = ["random_field.correlation_length_m=0.2", "random_field.cell_average=false", "random_field.terms=2000", "time.end_s=6"]
        self.assert_says("short_correlation_length", "doubtful", *settings, case=SMALL, extra=["--realization", 0])
        quality, _ = self.verdict(*settings, case=SMALL)  # the median run
        self.assertNotIn("short_correlation_length", [reason["check"] for reason in quality["reasons"]])

    def resumed(self, change):
        """Quality and result of a run whose checkpoint at t = 1 s was changed."""
        out = self.dir / "resumed"
        run = ["run", SMALL, "--out", out, "--threads", 1]
        self.assertEqual(talus(*run, "--set", "time.end_s=1").returncode, 0)
        before = load(out / "result.json")["quality"]
        edit_checkpoint(out / "checkpoint.h5", change)
        done = talus(*run, "--set", "time.end_s=3", "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = load(out / "result.json")
        check_schema("result", result)
        self.assertEqual([reason["check"] for reason in before["reasons"]], ["still_moving"])
        return {reason["check"]: reason for reason in result["quality"]["reasons"]}, result

    def test_soil_in_the_ground(self):
        """The contact holds all soil, so that a particle must be put into the rock by hand."""
        def bury(file):
            y = file["reals/y"]
            lowest = int(y[:].argmin())
            for name in ("reals/y", "reals/y_sorted"):
                file[name][lowest] -= 0.6  # 1.2 spacings
        reasons, result = self.resumed(bury)
        self.assertEqual(result["penetrated"], 1)
        self.assertEqual(reasons["particles_in_ground"]["verdict"], "doubtful")  # 1 of 132: less than a hundredth
        self.assertEqual(reasons["particles_in_ground"]["message"],
                         "1 of 132 particles were deeper than half a spacing in the ground")

    def test_extremes_outlast_a_checkpoint(self):
        def raise_peaks(file):
            scalars = file["reals/scalars"]
            scalars[1], scalars[6] = 50.0, 0.1  # peak speed [m/s], peak of rho/rho0 - 1
        reasons, result = self.resumed(raise_peaks)
        self.assertEqual(result["max_speed_m_s"], 50.0)
        self.assertIn("mach_number", reasons)
        self.assertEqual(reasons["compression"]["value"], 0.1)

    def test_a_field_is_mirrored_with_its_slide(self):
        """Two modes along x: the first is even about the middle of the slide, the second odd."""
        right = load(SMALL)
        right["random_field"] = {"correlation_length_m": 3, "log_stdev": 0.3, "terms": 2, "direction": "x"}
        mirror = lambda points: [[-x, y] for x, y in reversed(points)]
        outline = right["slide"]["outlines"][0]["outline_m"]
        left = right | {"terrain": {"bed_m": mirror(right["terrain"]["bed_m"])}, "slide": {"outlines": [{"outline_m": mirror(outline)}]}}
        fronts = []
        for case, xi in ((right, [1.0, 1.5]), (left, [1.0, -1.5]), (left, [1.0, 1.5])):
            path = self.dir / "case.json"
            path.write_text(json.dumps(case | {"random_field": case["random_field"] | {"xi": xi}}))
            self.verdict(case=path, extra=["--realization", 0])
            fronts.append(self.result)
        for key in ("influence_zone_m", "front_mass_99_m", "centre_of_mass_x_m"):
            self.assertAlmostEqual(fronts[0][key], fronts[1][key], delta=1e-3, msg=key)
            self.assertGreater(abs(fronts[2][key] - fronts[1][key]), 0.05, key)

    def test_the_cases_of_the_paper_take_the_vectorised_loops(self):
        cases = sorted((SOURCE / "solver/cases").glob("table4-case*.json"))
        self.assertEqual(len(cases), 9)
        for case in cases:
            self.verdict("particle_spacing_m=1", "time.end_s=0.01", "time.snapshot_times_s=[]", case=case)
            self.assertEqual(self.result["backend"], "vectorised", case)
            self.assertNotIn("times slower", self.stderr)

    def test_all_commands_print_the_same_warnings(self):
        settings = overrides(["random_field.correlation_length_m=0.2", "random_field.cell_average=false", "random_field.terms=10", "time.end_s=0.1"])
        run = talus("run", SMALL, *settings, "--out", self.dir / "a")
        study = talus("study", SMALL, *settings, "--realizations", 1, "--out", self.dir / "b", "--no-figures")
        validate = talus("validate", SMALL, *settings)
        warnings = [line for line in validate.stderr.splitlines() if line.startswith("warning: ")]
        self.assertEqual([line.split()[1] for line in warnings], ["/random_field", "/material", "/random_field"])
        self.assertIn("no rate-dependent dissipation is stated", warnings[1])
        self.assertIn("talus validate lists values by soil type", warnings[1])
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
        done, summary, rows = self.study("time.end_s=0.3")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[0], "4 of 4 runs doubtful: still moving (4)")
        self.assertEqual(summary["quality"]["doubtful"], 4)
        self.assertEqual([row["verdict"] for row in rows], ["doubtful"] * 4)
        self.assertTrue(rows[0]["verdict_reasons"].startswith("still_moving: "))
        before = (self.dir / "s/study.json").read_text()
        self.assertEqual(talus("stats", self.dir / "s").stdout, done.stdout)
        self.assertEqual((self.dir / "s/study.json").read_text(), before)

    def test_the_study_whose_steps_were_too_long(self):
        """The spread is that of the soil, not of the steps."""
        done, summary, rows = self.study("numerics.cfl=0.4", realizations=20)
        self.assertEqual((done.returncode, summary["quality"]["invalid"]), (0, 0), done.stderr)
        front = summary["quantities"]["influence_zone_m"]
        self.assertAlmostEqual(front["mean"], 15.79, delta=0.1)
        self.assertAlmostEqual(front["stdev"], 2.47, delta=0.1)
        self.assertIn("front still moving", done.stdout.splitlines()[0])

    def test_steps_that_are_too_long_are_seen_in_the_runs(self):
        """0.95 h/c: what the limit of numerics.cfl refuses, and a fixed step does not."""
        done, summary, rows = self.study("numerics.integrator=leapfrog", "time.fixed_step_s=0.0057", realizations=3)
        self.assertEqual((done.returncode, summary["quality"]["invalid"]), (7, 3), done.stderr)
        for row in rows:
            self.assertIn("energy_created", row["verdict_reasons"])

    def test_noise_as_large_as_the_spread(self):
        done, summary, _ = self.study("random_field.cov_tan_phi=1e-6", "study.noise_floor_replicates=3", "time.end_s=1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("noise_near_spread", [reason["check"] for reason in summary["quality"]["reasons"]])
        self.assertIn("study doubtful", done.stdout.splitlines()[0])
        self.assertIn("more than a third of it", done.stdout.splitlines()[0])

    def test_soil_that_leaves(self):
        done, summary, rows = self.study("terrain.bed_m.2.0=10.5", "time.end_s=8")
        self.assertEqual(done.returncode, 0, done.stderr)
        left = [row for row in rows if float(row["left_domain"]) > 0]
        self.assertTrue(left)
        self.assertIn(f"left terrain ({len(left)})", done.stdout.splitlines()[0])
        for row in rows:
            self.assertEqual("left_terrain: " in row["verdict_reasons"], row in left)
            self.assertEqual("influence_zone_m" in row["lower_bounds"].split(), row in left)
        for key, quantity in summary["quantities"].items():
            cut = [float(row[key]) for row in rows if key in row["lower_bounds"].split()]
            self.assertEqual(quantity["censored"], {"runs": len(cut), "from": min(cut)} if cut else None, key)

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
