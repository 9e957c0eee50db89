#!/usr/bin/env python3
"""The command line as other programs call it: files, exit codes, stdout and stderr, signals, kill -9.

usage: test_cli.py TALUS SOURCE_DIR [unittest arguments]; --slow-study runs the study at 0.2 m instead of everything else
"""
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

import h5py

from cli import COARSE, ENVIRONMENT, SLOPE, SOURCE, TALUS, Directory, check_schema, load, start, table, talus, wait_for

PROCESSOR = pathlib.Path("/proc/cpuinfo").read_text()


class Basics(Directory):
    def test_version_and_help_are_data(self):
        done = talus("--version")
        self.assertEqual(done.returncode, 0)
        for word in ("talus 0.", "compiler", "pair loops"):
            self.assertIn(word, done.stdout)
        self.assertEqual(talus("run", "--help").returncode, 0)

    def test_wrong_usage_is_2(self):
        for arguments in ([], ["run"], ["run", SLOPE], ["nonsense"], ["run", SLOPE, "--out", self.dir / "x", "--threads", "0"],
                          ["run", SLOPE, "--out", self.dir / "x", "--realization", "-1"]):
            done = talus(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertTrue(done.stderr)

    def test_a_slip_of_the_keyboard_is_told_what_was_meant(self):
        for arguments, words in (
            (["stdy", SLOPE], ['"stdy" is not a command', "(study?)"]),
            (["help", "stdy"], ["(study?)"]),
            (["run", SLOPE, "--realizations", "3"], ["not an option of talus run (--realization?)", "an option of: study"]),
            (["run", SLOPE, "--sed", "3"], ["--sed is not an option", "(--seed?)", "talus help run"]),
            (["study", SLOPE, "--out", self.dir / "x", "--realizations", "1.5"], ['"1.5" is not a whole number']),
            (["--foo"], ["--foo is not an option of talus"]),
            ([], ["a command is required"]),
        ):
            done = talus(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            for word in words:
                self.assertIn(word, done.stderr, arguments)

    def test_help_of_a_command_in_both_ways(self):
        self.assertEqual(talus("help", "run").stdout, talus("run", "--help").stdout)
        self.assertEqual(talus("help").stdout, talus("--help").stdout)
        self.assertIn("Exit codes: 0 ok, 1 internal error, 2 usage, 3 bad case, 5 input/output\n", talus("help", "field").stdout)

    def test_every_alias_works(self):
        """The list of solver/cli/help.hpp and solver/case/overrides.hpp."""
        declared = re.findall(r'\{"(\S+)", "(\S+)"\}', "".join(
            (SOURCE / f"solver/{file}").read_text() for file in ("cli/help.hpp", "case/overrides.hpp")))
        tried = [("--realisation", "--realization"), ("--realisations", "--realizations"),
                 ("study.realisations", "study.realizations"), ("rheology.yield=regularised", "rheology.yield=regularized"),
                 ("terrain.left_boundary_m", "terrain.measured_from_m")]
        self.assertEqual(sorted(declared), sorted(tried))
        field = [talus("field", SLOPE, *COARSE, "--json", "--seed", "1", option, "2") for option in tried[0]]
        self.assertEqual(field[0].stdout, field[1].stdout)
        self.assertEqual(field[0].returncode, 0, field[0].stderr)
        for spelling in (["--realisations", "1e1"], ["--realisations=10"], ["--set", "study.realisations=10"]):
            out = self.dir / str(len(list(self.dir.iterdir())))
            done = talus("study", SLOPE, *COARSE, "--prepare", "--out", out, *spelling)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(load(out / "plan.json")["realizations"], 10, spelling)
        checks = [json.loads(talus("validate", SLOPE, "--json", "--set", choice).stdout) for choice in tried[3]]
        self.assertEqual(checks[0]["hash"], checks[1]["hash"])
        self.assertEqual([len(c["warnings"]) for c in checks], [len(checks[1]["warnings"]) + 1, len(checks[1]["warnings"])])
        self.assertIn("rheology.yield=regularized", checks[0]["warnings"][0]["message"])
        origins = [json.loads(talus("validate", SLOPE, "--json", "--set", f"{key}=5").stdout) for key in tried[4]]
        self.assertEqual(origins[0]["hash"], origins[1]["hash"])
        self.assertIn("terrain.measured_from_m", origins[0]["warnings"][0]["message"])

    def test_bad_case_is_3_and_writes_nothing(self):
        out = self.dir / "out"
        for verb in ("run", "study"):
            done = talus(verb, self.case(material={"density_kg_m3": -1, "friction_angle": 25}), "--out", out)
            self.assertEqual((done.returncode, done.stdout), (3, ""))
            self.assertIn("/material/density_kg_m3", done.stderr)
            self.assertIn("friction_angle_deg", done.stderr)
            self.assertFalse(out.exists())

    def test_unknown_override_is_3(self):
        done = talus("run", SLOPE, "--set", "particle_spacing=0.4", "--out", self.dir / "out")
        self.assertEqual(done.returncode, 3)
        self.assertIn("particle_spacing_m", done.stderr)

    def test_missing_case_is_5(self):
        done = talus("run", self.dir / "none.json", "--out", self.dir / "out")
        self.assertEqual(done.returncode, 5)
        self.assertIn("none.json", done.stderr)

    def test_foreign_directory_is_5_and_stays_as_it_was(self):
        foreign = self.dir / "home"
        foreign.mkdir()
        (foreign / "thesis.tex").write_text("mine")
        for verb in ("run", "study"):
            done = talus(verb, SLOPE, *COARSE, "--out", foreign)
            self.assertEqual(done.returncode, 5, done.stderr)
            self.assertIn(str(foreign), done.stderr)
        self.assertEqual([p.name for p in foreign.iterdir()], ["thesis.tex"])

    def test_unwritable_place_is_5(self):
        blocked = self.dir / "file"
        blocked.write_text("")
        done = talus("run", SLOPE, *COARSE, "--out", blocked / "out")
        self.assertEqual(done.returncode, 5)

    def test_a_full_disk_is_5_and_leaves_no_result(self):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
        done = talus("run", SLOPE, *COARSE, "--set", "particle_spacing_m=0.3", "--out", self.dir / "out", preexec_fn=limit)
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertFalse((self.dir / "out/result.json").exists())

    def test_schemas_are_printed(self):
        for name in ("case", "result", "study"):
            done = talus("schema", name)
            self.assertEqual(json.loads(done.stdout), load(SOURCE / f"schemas/{name}.schema.json"))
        self.assertNotEqual(talus("schema", "cas").returncode, 0)

    def test_an_unknown_instruction_set_is_2(self):
        with unittest.mock.patch.dict(ENVIRONMENT, TALUS_SIMD="MMX"):
            done = talus("validate", SLOPE)
        self.assertEqual(done.returncode, 2)
        self.assertIn("TALUS_SIMD", done.stderr)

    def test_threads_do_not_spin_for_long_unless_asked_to(self):
        for chosen in ({}, {"GOMP_SPINCOUNT": "7", "GLIBC_TUNABLES": "glibc.malloc.hugetlb=0"}):
            environment = {name: value for name, value in os.environ.items() if not name.startswith(("GOMP_", "OMP_", "GLIBC_"))}
            running = subprocess.Popen([TALUS, "run", SLOPE, "--out", self.dir / f"of{len(chosen)}"], env=environment | chosen,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            settings = {}
            while running.poll() is None and "GOMP_SPINCOUNT" not in settings:
                words = pathlib.Path(f"/proc/{running.pid}/environ").read_bytes().decode().split("\0")
                settings = dict(word.split("=", 1) for word in words if "=" in word)
            running.kill()
            running.wait()
            expected = {"GOMP_SPINCOUNT": "5000", "GLIBC_TUNABLES": "glibc.malloc.hugetlb=1"} | chosen  # what was chosen stays
            self.assertEqual({name: settings.get(name) for name in expected}, expected)

    def test_bench_prints_one_json_value(self):
        done = talus("bench", "--json", "--seconds", 0.05, "--sizes", "2000,1000", "--threads", "1,2")
        self.assertEqual(done.returncode, 0, done.stderr)
        bench = json.loads(done.stdout)
        self.assertEqual(len(bench["runs"]), 6)  # the base; another size, threads, integrator, yield, precision
        for run in bench["runs"]:
            for key in ("particles", "threads", "integrator", "yield", "precision", "simd", "evaluations_per_second_per_core",
                        "particle_steps_per_second_per_core", "bytes_per_particle"):
                self.assertIn(key, run)
            self.assertGreater(run["evaluations_per_second_per_core"], 0)
            self.assertAlmostEqual(sum(run["share"].values()), 1.0)
            self.assertEqual(run["backend"], "vectorised" if run["precision"] == "single" else "plain")
            self.assertEqual(run["simd"] == "none", run["backend"] == "plain")
            factor = 2 if run["integrator"] == "rk2" else 1
            self.assertAlmostEqual(run["evaluations_per_second_per_core"] / run["particle_steps_per_second_per_core"], factor)
        self.assertAlmostEqual(bench["runs"][0]["particles"], 2000, delta=40)
        self.assertEqual({run["integrator"] for run in bench["runs"]}, {"rk2", "leapfrog"})
        table = talus("bench", "--seconds", 0.05, "--sizes", "1000", "--threads", "1")
        self.assertEqual(len(table.stdout.splitlines()), 3 + 4)
        wide, narrow = (json.loads(talus("bench", "--json", "--seconds", 0.05, "--sizes", "1000", "--threads", "1", "--set", f"numerics.smoothing_ratio={ratio}").stdout)["runs"][0]
                        for ratio in (1.5, 1.2))
        self.assertGreater(wide["neighbours"], narrow["neighbours"])
        self.assertEqual(talus("bench", "--sizes", "1").returncode, 2)
        self.assertEqual(talus("bench", self.case(title=3)).returncode, 3)


class Run(Directory):
    def test_writes_what_the_contract_names(self):
        result = self.run_ok("a")
        check_schema("result", result)
        for name in ("result.json", "case.resolved.json", "snapshots.vtkhdf", "snapshots.xdmf", "history.csv"):
            self.assertTrue((self.dir / "a" / name).stat().st_size > 0, name)
        self.assertEqual((result["penetrated"], result["threads"]), (0, 1))
        self.assertEqual(result["steps"], result["evaluations"])  # leapfrog
        self.assertIsNone(result["provenance"]["realization"])
        with h5py.File(self.dir / "a/snapshots.vtkhdf") as f:
            times = list(f["VTKHDF/Steps/Values"])
        self.assertEqual(len(times), 4)  # start, 1 s, 2 s, end
        self.assertEqual((times[0], times[3]), (0.0, 3.0))
        self.assertTrue(1.0 <= times[1] < 1.01 and 2.0 <= times[2] < 2.01)
        rows = table(self.dir / "a/history.csv")
        self.assertAlmostEqual(float(rows[-1]["front_m"]), result["influence_zone_m"])

    def test_the_resolved_case_runs_to_the_same_digest(self):
        first = self.run_ok("a", "--realization", 4, "--seed", 11)
        done = talus("run", self.dir / "a/case.resolved.json", "--realization", 4, "--out", self.dir / "b")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(load(self.dir / "b/result.json")["digest"], first["digest"])

    def test_a_case_on_a_national_grid_has_the_same_digest_and_its_own_coordinates(self):
        by = (2_683_000, 1_247_000)
        near = load(SLOPE)
        move = lambda points: [[x + by[0], y + by[1]] for x, y in points]
        outlines = [{"outline_m": move(near["slide"]["outlines"][0]["outline_m"])}]
        terrain = near["terrain"] | {"bed_m": move(near["terrain"]["bed_m"])}
        positions, results = [], []
        for name, changes in (("near", {}), ("far", {"terrain": terrain, "slide": {"outlines": outlines}})):
            path = self.case(**changes)
            out = self.dir / name
            self.assertEqual(talus("run", path, "--out", out, "--seed", 1).returncode, 0)
            self.assertEqual(talus("profile", out, "--out", self.dir / "profile.json").returncode, 0)
            self.assertEqual(talus("field", path, "--out", self.dir / "field.csv").returncode, 0)
            profile, field = load(self.dir / "profile.json"), table(self.dir / "field.csv")
            positions.append((list(zip(profile["x_m"], profile["y_m"])), [(float(f["x_m"]), float(f["y_m"])) for f in field]))
            results.append(load(out / "result.json"))
        self.assertEqual(results[0]["digest"], results[1]["digest"])
        self.assertEqual(results[0]["influence_zone_m"], results[1]["influence_zone_m"])
        # Of snapshots near zero the points are of single precision, up to 60 m here.
        for near_points, far_points, rounding in zip(*positions, (2e-6, 2e-9), strict=True):
            for here, there in zip(near_points, far_points, strict=True):
                for axis in (0, 1):
                    self.assertAlmostEqual(here[axis] + by[axis], there[axis], delta=rounding)

    def test_json_is_one_value_on_stdout(self):
        done = talus("run", SLOPE, *COARSE, "--out", self.dir / "a", "--json", "--figures")
        self.assertEqual(json.loads(done.stdout), load(self.dir / "a/result.json"))
        self.assertTrue(list((self.dir / "a/figures").glob("*.png")))

    def test_threads_and_snapshots_do_not_change_the_digest(self):
        one = self.run_ok("a", "--threads", 1)
        for threads in (2, 3):
            self.assertEqual(self.run_ok(f"t{threads}", "--threads", threads)["digest"], one["digest"])
        self.assertEqual(self.run_ok("s", "--set", "time.snapshot_times_s=[]")["digest"], one["digest"])

    @unittest.skipUnless("avx2" in PROCESSOR, "this processor has no AVX2")
    def test_avx2_gives_the_same_bits_as_anything_better(self):
        best = self.run_ok("best")
        with unittest.mock.patch.dict(ENVIRONMENT, TALUS_SIMD="AVX2"):
            self.assertEqual(self.run_ok("avx2")["digest"], best["digest"])
        with unittest.mock.patch.dict(ENVIRONMENT, TALUS_SIMD="SSE4"):  # other rounding: no fused multiply-add
            other = self.run_ok("sse4")
        self.assertAlmostEqual(other["influence_zone_m"], best["influence_zone_m"], delta=0.01)

    def test_a_run_says_which_loops_it_takes(self):
        short = ("--set", "time.end_s=0.02", "--set", "time.snapshot_times_s=[]")
        with unittest.mock.patch.dict(ENVIRONMENT, TALUS_SIMD="SSE4"):
            fast = self.run_ok("fast", *short)
        self.assertEqual((fast["backend"], fast["simd"]), ("vectorised", "SSE4"))
        done = talus("run", SLOPE, *COARSE, "--out", self.dir / "plain", *short, "--set", "numerics.precision=double")
        plain = load(self.dir / "plain/result.json")
        check_schema("result", plain)
        self.assertEqual((plain["backend"], plain["simd"]), ("plain", "none"))
        self.assertIn("nine times slower", done.stderr)

    def test_both_precisions_reach_the_same_front(self):
        single, double = (self.run_ok(name, "--set", f"numerics.precision={name}") for name in ("single", "double"))
        self.assertAlmostEqual(single["influence_zone_m"], double["influence_zone_m"], delta=0.01)
        self.assertNotEqual(single["digest"], double["digest"])

    def test_seeds_realizations_and_the_median_differ_and_repeat(self):
        digests = [self.run_ok(name, *arguments)["digest"] for name, arguments in
                   {"a": ["--realization", 0, "--seed", 1], "b": ["--realization", 1, "--seed", 1],
                    "c": ["--realization", 0, "--seed", 2], "d": []}.items()]
        self.assertEqual(len(set(digests)), 4)
        self.assertEqual(self.run_ok("e", "--realization", 1, "--seed", 1)["digest"], digests[1])

    def test_a_seed_is_drawn_and_recorded(self):
        case, results = self.case(study={}), []  # no seed of its own
        for out, arguments in {"a": [], "b": [], "c": ["--seed"]}.items():
            if arguments:
                arguments.append(results[0]["provenance"]["seed"])
            done = talus("run", case, "--realization", 0, "--out", self.dir / out, *arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            results.append(load(self.dir / out / "result.json"))
        self.assertNotEqual(results[0]["provenance"]["seed"], results[1]["provenance"]["seed"])
        self.assertEqual(results[2]["digest"], results[0]["digest"])

    def test_a_finished_run_is_not_overwritten(self):
        first = self.run_ok("a")
        done = talus("run", SLOPE, *COARSE, "--out", self.dir / "a")
        self.assertEqual(done.returncode, 5)
        done = talus("run", SLOPE, *COARSE, "--out", self.dir / "a", "--resume", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout), first)

    def test_a_signal_checkpoints_with_6_and_resume_gives_the_same_run(self):
        fine = ["--set", "particle_spacing_m=0.3", "--set", "time.snapshot_times_s=[0.5,1,1.5,2]"]
        whole = self.run_ok("whole", *fine, "--realization", 2, "--seed", 5)
        for number in (signal.SIGTERM, signal.SIGINT):
            out = self.dir / f"stopped-{number}"
            process = start("run", SLOPE, *COARSE, *fine, "--realization", 2, "--seed", 5, "--out", out)
            wait_for((out / "snapshots.vtkhdf").exists, process, "the run began")
            time.sleep(0.4)
            process.send_signal(number)
            _, stderr = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 6, stderr)
            self.assertIn("the same command continues it", stderr)
            self.assertTrue((out / "checkpoint.h5").exists())
            self.assertFalse((out / "result.json").exists())
            done = talus("run", SLOPE, *COARSE, *fine, "--realization", 2, "--out", out, *(["--resume"] if number == signal.SIGINT else []), "--threads", 2)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stderr, r"continues from t = \d")
            result = load(out / "result.json")
            for key in ("digest", "steps", "evaluations", "influence_zone_m", "max_speed_m_s", "energy", "quality"):
                self.assertEqual(result[key], whole[key], key)
            with h5py.File(out / "snapshots.vtkhdf") as a, h5py.File(self.dir / "whole/snapshots.vtkhdf") as b:
                self.assertEqual(a["VTKHDF/Steps/Values"][:].tolist(), b["VTKHDF/Steps/Values"][:].tolist())
                self.assertTrue((a["VTKHDF/PointData/velocity"][:] == b["VTKHDF/PointData/velocity"][:]).all())
            self.assertEqual((out / "history.csv").read_text(), (self.dir / "whole/history.csv").read_text())
            self.assertEqual((out / "checkpoint.h5").exists(), not result["at_rest"])

    def test_a_run_that_ended_moving_continues_to_a_later_end(self):
        def ends(time):
            return ["--set", f"time.end_s={time}", "--set", "time.snapshot_times_s=[0.5]"]
        out = self.dir / "a"
        whole = self.run_ok("whole", *ends(3))
        self.assertFalse(self.run_ok("a", *ends(1))["at_rest"])
        done = talus("run", SLOPE, *COARSE, *ends(3), "--out", out)
        self.assertEqual(done.returncode, 5)
        self.assertIn("up to t = 1 s; --resume continues it to 3 s", done.stderr)
        self.assertTrue((out / "result.json").exists())
        done = talus("run", SLOPE, *COARSE, *ends(3), "--out", out, "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("continues from t = 1 s", done.stderr)
        result = load(out / "result.json")
        self.assertEqual((result["time_s"], result["provenance"]["case_hash"]), (3.0, whole["provenance"]["case_hash"]))
        self.assertLess(abs(result["influence_zone_m"] - whole["influence_zone_m"]), 0.05)  # one step was shortened
        times = [float(row["time_s"]) for row in table(out / "history.csv")]
        self.assertEqual((times[0], times[-1]), (0.0, 3.0))
        self.assertEqual(times, sorted(set(times)))
        with h5py.File(out / "snapshots.vtkhdf") as f:
            shots = f["VTKHDF/Steps/Values"][:].tolist()
        self.assertEqual((len(shots), shots[0], shots[2:]), (4, 0.0, [1.0, 3.0]))
        done = talus("run", SLOPE, *COARSE, *ends(1), "--out", out, "--resume")
        self.assertEqual(done.returncode, 5)
        self.assertIn("holds this run up to t = 3 s, beyond time.end_s = 1 s", done.stderr)

    def test_a_run_at_rest_has_nothing_to_continue(self):
        rest = ["--set", "time.stop_at_rest=true", "--set", "particle_spacing_m=1", "--set", "time.end_s=60"]
        first = self.run_ok("a", *rest)
        self.assertEqual((first["at_rest"], first["ending"]), (True, "at_rest"))
        done = talus("run", SLOPE, *COARSE, *rest[:-1], "time.end_s=80", "--out", self.dir / "a", "--resume")
        self.assertEqual(done.returncode, 5)
        self.assertIn("came to rest before its end, t = 60 s", done.stderr)
        self.assertEqual(load(self.dir / "a/result.json"), first)

    def test_divergence_is_4_names_the_place_and_keeps_the_snapshots(self):
        done = talus("run", self.case(time={"end_s": 100, "fixed_step_s": 0.05, "snapshot_times_s": [0.05]}), "--out", self.dir / "a")
        self.assertEqual((done.returncode, done.stdout), (4, ""))
        for word in ("step", "time", "particle"):
            self.assertIn(word, done.stderr)
        self.assertFalse((self.dir / "a/result.json").exists())
        with h5py.File(self.dir / "a/snapshots.vtkhdf") as f:
            self.assertGreaterEqual(f["VTKHDF/Steps"].attrs["NSteps"], 1)


class Study(Directory):
    case_options = ["--set", "particle_spacing_m=0.8", "--set", "time.end_s=3", "--set", "time.snapshot_times_s=[]"]
    arguments = ["study", SLOPE, *case_options, "--set", "study.noise_floor_replicates=2", "--workers", 2, "--threads", 1]

    def study(self, out, realizations, *arguments, seed=3):
        return talus(*self.arguments, "--seed", seed, "--realizations", realizations, "--out", self.dir / out, *arguments)

    def test_from_case_to_histogram(self):
        done = self.study("a", 6, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        study = load(self.dir / "a/study.json")
        self.assertEqual(json.loads(done.stdout), study)
        check_schema("study", study)
        self.assertEqual(study["realizations"]["done"], 6)
        for name, quantity in study["quantities"].items():
            counts = quantity["histogram"]
            self.assertEqual(sum(counts["counts"]) + counts["underflow"] + counts["overflow"], 6, name)
            self.assertIsNotNone(quantity["noise_floor_stdev"], name)
        rows = table(self.dir / "a/realizations.csv")
        self.assertEqual([int(row["index"]) for row in rows], list(range(6)))
        self.assertTrue(list((self.dir / "a/figures").glob("*.png")))
        alone = talus("run", SLOPE, *self.case_options, "--seed", 3, "--realization", 4, "--out", self.dir / "alone")
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertEqual(load(self.dir / "alone/result.json")["digest"], rows[4]["digest"])
        self.assertEqual(talus("stats", self.dir / "a", "--out", self.dir / "again").returncode, 0)
        self.assertEqual(load(self.dir / "again/study.json")["quantities"], study["quantities"])

    def test_extending_a_study_leaves_its_first_runs_alone(self):
        self.assertEqual(self.study("a", 3, "--no-figures").returncode, 0)
        before = {p.name: (p.stat().st_mtime_ns, p.read_text()) for p in (self.dir / "a/runs").iterdir()}
        self.assertEqual(self.study("a", 5, "--no-figures").returncode, 0)
        for name, content in before.items():
            path = self.dir / "a/runs" / name
            self.assertEqual((path.stat().st_mtime_ns, path.read_text()), content)
        self.assertEqual(self.study("b", 5, "--no-figures").returncode, 0)
        digests = [[row["digest"] for row in table(self.dir / d / "realizations.csv")] for d in "ab"]
        self.assertEqual(*digests)

    def test_another_seed_in_the_same_directory_is_refused(self):
        self.assertEqual(self.study("a", 2, "--no-figures").returncode, 0)
        done = self.study("a", 2, "--no-figures", seed=4)
        self.assertEqual(done.returncode, 5, done.stderr)

    def test_too_many_failures_end_the_study_with_7(self):
        done = talus("study", self.case(time={"end_s": 100, "fixed_step_s": 0.05}), "--realizations", 3, "--seed", 1, "--out", self.dir / "a", "--no-figures")
        self.assertEqual(done.returncode, 7, done.stderr)
        rows = table(self.dir / "a/realizations.csv")
        self.assertEqual({row["status"] for row in rows}, {"failed"})
        self.assertIn("diverged", rows[0]["reason"])
        study = load(self.dir / "a/study.json")
        self.assertEqual((study["realizations"]["planned"], study["realizations"]["done"]), (3, 0))

    def test_a_study_continues_to_a_later_end(self):
        """What still moved is run again from the start, so that the study is the one of the later end, bit for bit."""
        later = ["--no-figures", "--set", "time.end_s=4"]
        self.assertEqual(self.study("a", 3, "--no-figures").returncode, 0)
        self.assertFalse(any(load(p)["at_rest"] for p in (self.dir / "a/runs").iterdir()))
        done = self.study("a", 3, *later)
        self.assertEqual(done.returncode, 5)
        self.assertIn("up to t = 3 s; --resume continues it to 4 s", done.stderr)
        done = self.study("a", 3, *later, "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.study("b", 3, *later).returncode, 0)
        tables = [table(self.dir / d / "realizations.csv") for d in "ab"]
        self.assertEqual(*([row["digest"] for row in rows] for rows in tables))
        # A run at rest is kept; an unfinished change of the end loses nothing.
        kept = self.dir / "a/runs/000001.json"
        result = load(kept)
        result["at_rest"] = True
        kept.write_text(json.dumps(result))
        later[-1] = "time.end_s=5"
        done = self.study("a", 3, *later, "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(load(kept), result)
        self.assertEqual(load(self.dir / "a/runs/000002.json")["time_s"], 5.0)
        self.assertEqual(talus("stats", self.dir / "a", "--from-runs", "--out", self.dir / "again").returncode, 0)

    def kill_and_resume(self, out, realizations, *arguments):
        command = [*self.arguments, *arguments, "--seed", 3, "--realizations", realizations, "--out", self.dir / out, "--no-figures"]
        process = start(*command)
        runs = self.dir / out / "runs"
        wait_for(lambda: runs.is_dir() and len(list(runs.glob("*.json"))) >= realizations // 2, process,
                 "half of the study", 900)
        process.kill()
        process.communicate()
        time.sleep(0.5)  # the workers go with it
        finished = {p.name: p.stat().st_mtime_ns for p in runs.glob("*.json")}
        self.assertLess(len(finished), realizations)
        done = subprocess.run([TALUS, *map(str, command)], capture_output=True, text=True, env=ENVIRONMENT, timeout=1100)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name, mtime in finished.items():
            self.assertEqual((runs / name).stat().st_mtime_ns, mtime, f"{name} was run twice")
        study = load(self.dir / out / "study.json")
        self.assertEqual(study["realizations"]["done"], realizations)
        return [row["digest"] for row in table(self.dir / out / "realizations.csv")]

    def test_kill_9_half_way_then_resume(self):
        digests = self.kill_and_resume("killed", 6, "--set", "particle_spacing_m=0.5")
        self.assertEqual(self.study("whole", 6, "--no-figures", "--set", "particle_spacing_m=0.5").returncode, 0)
        self.assertEqual(digests, [row["digest"] for row in table(self.dir / "whole/realizations.csv")])

    def test_sigterm_is_6_and_the_workers_leave_checkpoints(self):
        command = [*self.arguments, "--set", "particle_spacing_m=0.3", "--seed", 3, "--realizations", 4, "--out", self.dir / "a", "--no-figures"]
        process = start(*command)
        wait_for(lambda: list((self.dir / "a").glob("work/*/snapshots.vtkhdf")), process, "the first worker")
        time.sleep(0.5)
        process.terminate()
        _, stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 6, stderr)
        self.assertTrue(list((self.dir / "a").glob("work/*/checkpoint.h5")))
        done = talus(*command)
        self.assertEqual(done.returncode, 0, done.stderr)


class SlowStudy(Study):
    """The illustrative slope, 8 realizations at 0.2 m, killed half way."""

    arguments = ["study", SLOPE, "--set", "particle_spacing_m=0.2", "--set", "study.noise_floor_replicates=0", "--workers", 2, "--threads", 1]

    def test_kill_9_half_way_then_resume(self):
        self.assertEqual(len(set(self.kill_and_resume("killed", 8))), 8)


if __name__ == "__main__":
    rest = sys.argv[3:]
    if "--slow-study" in rest:
        suite = unittest.TestSuite([SlowStudy("test_kill_9_half_way_then_resume")])
        sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
    unittest.main(argv=[sys.argv[0], *(rest or ["Basics", "Run", "Study"])], verbosity=2)
