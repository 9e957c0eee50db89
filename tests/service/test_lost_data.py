#!/usr/bin/env python3
"""The data directory, its locks or its jobs are removed under talusd; kept profiles are damaged; what a waiting or ended
job says of it."""

import json
import shutil
import subprocess
import time

from daemon import TALUS, TALUSD, ServiceTest, main, study


class LostData(ServiceTest):
    """A 201 means that the job is on the disk, and two talusd never share a directory."""

    def refused(self):
        reply = self.daemon.post("/processes/influence-zone/execution", study(1))
        detail = self.problem(reply, 503)["detail"]
        self.assertIn("has been removed or replaced", detail)
        self.assertEqual(self.problem(self.daemon.get("/readyz"), 503)["detail"], detail)
        self.assertEqual(self.daemon.get("/healthz").status, 200)
        return detail

    def test_nothing_is_accepted_once_the_data_directory_is_removed(self):
        self.start()
        self.daemon.submit(study(1))
        shutil.rmtree(self.daemon.data, ignore_errors=True)
        self.refused()
        self.daemon.data.mkdir(exist_ok=True)  # another one in its place
        (self.daemon.data / "jobs").mkdir(exist_ok=True)
        self.refused()

    def test_nothing_is_accepted_once_the_queue_or_the_jobs_are_removed(self):
        for lost in ("queue.sqlite", "jobs"):
            self.start()
            self.daemon.wait_for(self.daemon.submit(study(1)))
            (self.daemon.data / lost).rename(self.dir / lost)
            self.assertIn(lost, self.refused())
            (self.dir / lost).rename(self.daemon.data / lost)
            self.assertEqual(self.daemon.get("/readyz").status, 200)
            self.assertEqual(self.daemon.stop(), 0)

    def test_a_second_talusd_is_refused_without_the_lock_files(self):
        self.start()
        for name in ("talusd.lock", "workers.lock"):
            (self.daemon.data / name).unlink()
        done = subprocess.run([TALUSD, "--data", self.daemon.data, "--listen", "127.0.0.1:0", "--talus", TALUS],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn("another talusd is using", done.stderr)
        self.daemon.submit(study(1))

    def test_no_attempt_is_burnt_where_the_jobs_are_removed(self):
        self.start()
        job = self.daemon.submit(study(30, spacing=0.8, end=1.5))
        while self.daemon.get(f"/jobs/{job}").json["realizations"]["done"] < 2:
            time.sleep(0.02)
        jobs, away = self.daemon.data / "jobs", self.dir / "away"
        jobs.rename(away)
        info = self.daemon.wait_for(job)
        self.assertEqual((info["status"], info["realizations"]["failed"]), ("failed", 0))
        self.assertIn("is missing", info["message"])
        self.daemon.stop()
        shutil.rmtree(jobs, ignore_errors=True)
        away.rename(jobs)
        self.start()
        self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").status, 200)
        self.assertEqual(self.daemon.wait_for(job)["realizations"], {"planned": 30, "done": 30, "failed": 0})


class Profiles(ServiceTest):
    """The snapshots that a study keeps carry a hash."""

    def test_a_damaged_profile_is_made_again_by_a_retry(self):
        self.start()
        job = self.daemon.submit(study(5))
        self.daemon.wait_for(job)
        directory = self.daemon.data / "jobs" / job
        results = {path.name: json.loads(path.read_text())["digest"] for path in (directory / "runs").iterdir()}
        for name in ("first", "worst"):
            snapshots = directory / f"profiles/{name}.vtkhdf"
            content = bytearray(snapshots.read_bytes())
            content[len(content) // 2] ^= 1
            snapshots.unlink()  # another name of the same file may exist
            snapshots.write_bytes(content)
            drawn = subprocess.run([TALUS, "plot", directory], capture_output=True, text=True)
            if "gnuplot" not in drawn.stderr:
                self.assertEqual(drawn.returncode, 5)
                self.assertIn(f"{name}.vtkhdf is damaged", drawn.stderr)
            self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").status, 200)
            self.assertEqual(self.daemon.wait_for(job)["realizations"], {"planned": 5, "done": 5, "failed": 0})
            self.assertNotEqual(snapshots.read_bytes(), content)
            self.assertEqual(results, {path.name: json.loads(path.read_text())["digest"]
                                       for path in (directory / "runs").iterdir()})
            attempts = [self.daemon.get(f"/jobs/{job}/realizations/{i}").json["attempt"] for i in range(5)]
            self.assertIn(sum(attempts), (6, 7))


class Messages(ServiceTest):
    """A job says why it waits, and what failed of it."""

    def test_a_job_that_waits_for_disk_space_says_so(self):
        self.start()
        job = self.daemon.submit(study(40, spacing=0.5, end=1.5))
        self.assertEqual(self.daemon.stop(), 0)
        left = shutil.disk_usage(self.dir).free / 2**20
        self.start("--min-disk", 4 * left)
        deadline = time.monotonic() + 60
        while "disk" not in (info := self.daemon.get(f"/jobs/{job}").json)["message"]:
            self.assertLess(time.monotonic(), deadline, info)
            time.sleep(0.05)
        self.assertEqual(info["message"], "the disk is nearly full: no run is started until there is room")
        self.assertEqual(info["waits"], info["message"])
        self.daemon.stop()
        self.start()
        self.assertNotIn("disk", self.daemon.wait_for(job)["message"])
        self.assertNotIn("waits", self.daemon.get(f"/jobs/{job}").json)

    def test_a_failed_replicate_is_in_the_message(self):
        fake = self.dir / "talus"
        fake.write_text(f'#!/bin/sh\ncase "$*" in *--perturbation*) exit 4;; esac\nexec {TALUS} "$@"\n')
        fake.chmod(0o755)
        self.start("--talus", fake)
        info = self.daemon.wait_for(self.daemon.submit(study(2, noise_floor_replicates=3)))
        self.assertEqual(info["status"], "successful")
        self.assertIn("2 realizations done, 3 of 3 replicates for the numerical noise failed", info["message"])


if __name__ == "__main__":
    main({"LostData": LostData, "Profiles": Profiles, "Messages": Messages})
