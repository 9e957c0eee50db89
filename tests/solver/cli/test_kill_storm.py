#!/usr/bin/env python3
"""kill -9 and SIGSTOP of `talus study` and of its workers at random moments: every realization ends with the result of an
undisturbed study.

usage: test_kill_storm.py TALUS SOURCE_DIR [unittest arguments]      TALUS_KILLS: kills of either, 8 without it
"""
import contextlib
import os
import pathlib
import random
import signal
import subprocess
import sys
import time
import unittest

from cli import SLOPE, Directory, load, start, table, talus, wait_for

KILLS = int(os.environ.get("TALUS_KILLS", "8"))
SMALL = ["--set", "particle_spacing_m=0.8", "--set", "time.end_s=1.5", "--set", "time.snapshot_times_s=[1]", "--seed", "7",
         "--no-figures"]


def workers_of(process):
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    try:
        return [int(child) for child in children.read_text().split()]
    except OSError:
        return []


class KillStorm(Directory):
    def command(self, out, realizations):
        return ["study", SLOPE, *SMALL, "--realizations", realizations, "--workers", 2, "--attempts", 100, "--out", out]

    def results(self, out):
        return {path.stem: load(path)["digest"] for path in (out / "runs").glob("[0-9]*.json")}

    def assert_undisturbed(self, storm, realizations):
        calm = self.dir / "calm"
        self.assertEqual(talus(*self.command(calm, realizations)).returncode, 0)
        self.assertEqual(self.results(storm), self.results(calm))
        self.assertEqual(len(self.results(storm)), realizations)
        summaries = [load(out / "study.json") for out in (storm, calm)]
        for summary in summaries:
            summary.pop("effort")  # seconds
            summary.pop("checksum")
        self.assertEqual(*summaries)
        self.assertEqual(summaries[0]["realizations"]["failed"], 0)

    def test_killed_at_random_moments(self):
        draw, storm, realizations = random.Random(3), self.dir / "storm", 10 + 3 * KILLS
        of_studies, of_workers = 0, 0
        process = start(*self.command(storm, realizations))
        while of_studies < KILLS or of_workers < KILLS:
            time.sleep(draw.uniform(0.0, 0.12))
            self.assertIsNone(process.poll(), "the study ended before all kills")
            workers = workers_of(process)
            if of_studies < KILLS and draw.random() < 0.5:
                process.kill()
                process.communicate()
                of_studies += 1
                process = start(*self.command(storm, realizations))
            elif workers and of_workers < KILLS:
                with contextlib.suppress(ProcessLookupError):  # it has just ended
                    os.kill(draw.choice(workers), signal.SIGKILL)
                    of_workers += 1
        _, messages = process.communicate()
        self.assertEqual(process.returncode, 0, messages)
        self.assert_undisturbed(storm, realizations)
        print(f"\n{of_studies} kills of talus study, {of_workers} of its workers: {realizations} of {realizations} "
              "digests equal, 0 failed", flush=True)

    def test_a_stopped_worker_is_run_again(self):
        out = self.dir / "study"
        process = start(*self.command(out, 4), "--stall-limit", 1)
        wait_for(lambda: workers_of(process), process, "it had a worker")
        os.kill(workers_of(process)[0], signal.SIGSTOP)
        _, messages = process.communicate()
        self.assertEqual(process.returncode, 0, messages)
        self.assertIn("hung: no CPU time used for 1 s", messages)
        self.assertIn("1 run again", messages)
        self.assert_undisturbed(out, 4)

    def test_a_run_beyond_the_time_limit_fails(self):
        out = self.dir / "study"
        done = talus("study", SLOPE, "--set", "particle_spacing_m=0.1", "--realizations", 2, "--time-limit", 1,
                     "--set", "study.noise_floor_replicates=0", "--no-figures", "--out", out)
        self.assertEqual(done.returncode, 7, done.stderr)
        self.assertIn("took longer than the limit of 1 s", table(out / "realizations.csv")[0]["reason"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
