#!/usr/bin/env python3
"""Full disks, files that cannot be written, clocks that jump."""

import fcntl
import os
import shutil
import sqlite3
import subprocess
import threading
import time

from daemon import TALUS, TALUSD, Daemon, ServiceTest, main, study


class BadDays(ServiceTest):
    """Full disks, files that cannot be written, clocks that jump."""

    def on_small_disk(self, mebibytes):
        """A file system of its own; skips where mounting is not allowed."""
        place = self.dir / "disk"
        place.mkdir()
        done = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={mebibytes}m", "tmpfs", str(place)], capture_output=True, text=True
        )
        if done.returncode != 0:
            self.skipTest("cannot mount a small file system here: " + done.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "-l", str(place)], capture_output=True)
        return place

    def test_a_full_disk(self):
        place = self.on_small_disk(48)
        self.daemon = Daemon(place / "data", workers=2)
        job = self.daemon.submit(study(40, spacing=0.8, end=1.5))
        while self.daemon.get(f"/jobs/{job}").json["realizations"]["done"] < 3:
            time.sleep(0.02)
        statuses = set()
        for _ in range(10):
            with open(place / "ballast", "ab", buffering=0) as ballast:
                try:
                    while True:
                        ballast.write(b"x" * 4096)
                except OSError:
                    pass
            statuses.add(self.daemon.post("/processes/influence-zone/execution", study(3)).status)
            self.assertEqual(self.daemon.get("/healthz").status, 200)
            time.sleep(0.1)
        # A run that ends makes room again, so one may get in.
        self.assertTrue(statuses <= {201, 503, 507} and statuses & {503, 507}, statuses)
        self.assertEqual(self.daemon.get(f"/jobs/{job}").status, 200)
        self.assertIsNone(self.daemon.process.poll())
        (place / "ballast").unlink()
        info = self.daemon.wait_for(job)
        self.assertEqual((info["status"], info["realizations"]["done"]), ("successful", 40))
        self.assertEqual(self.daemon.stop(), 0)

    def fill(self, place):
        """Writes until not a byte is free."""
        with open(place / "ballast", "ab", buffering=0) as ballast:
            for size in (1 << 16, 4096, 1):
                try:
                    while True:
                        ballast.write(b"x" * size)
                except OSError:
                    pass

    def test_a_full_disk_can_be_freed_by_deleting_jobs(self):
        place = self.on_small_disk(64)
        data = place / "data"
        self.daemon = Daemon(data, workers=1)
        jobs = [self.daemon.submit(study(2, seed=seed)) for seed in (7, 8)]
        for job in jobs:
            self.daemon.wait_for(job)
        self.assertGreater((data / "reserve").stat().st_size, 0)
        for restart in (False, True):
            if restart:
                self.daemon.kill()
            self.fill(place)
            if restart:
                self.daemon = Daemon(data, workers=1)  # which writes its queue
            job = jobs.pop()
            self.assertEqual(self.daemon.request("DELETE", f"/jobs/{job}").status, 200)
            deadline = time.monotonic() + 30
            while (data / "jobs" / job).exists() and time.monotonic() < deadline:
                time.sleep(0.1)
            self.assertFalse((data / "jobs" / job).exists(), (place / "talusd.log").read_text())
            self.assertEqual(self.daemon.get(f"/jobs/{job}").json["status"], "dismissed")
            (place / "ballast").unlink()
            while not (data / "reserve").exists() and time.monotonic() < deadline:
                time.sleep(0.1)  # it is made again once there is room
            self.assertTrue((data / "reserve").exists())
        self.daemon.wait_for(self.daemon.submit(study(1)))
        self.assertEqual(self.daemon.stop(), 0)

    def test_a_database_that_cannot_be_written(self):
        """The file turns read-only while talusd runs (chattr +i, which holds for root and for open files too)."""
        self.start(workers=1)
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        files = [str(p) for p in self.daemon.data.glob("queue.sqlite*")]
        done = subprocess.run(["chattr", "+i", *files], capture_output=True, text=True)
        self.addCleanup(subprocess.run, ["chattr", "-i", *files], capture_output=True)
        if done.returncode != 0:
            self.skipTest("no chattr +i here: " + done.stderr.strip())
        echo = {"inputs": {"s": "a"}}
        reply = self.daemon.post("/processes/echo/execution", echo, headers={"Prefer": "respond-async"})
        document = self.problem(reply, reply.status)
        self.assertIn(reply.status, (503, 507))
        self.assertIn("cannot be written", document["detail"])
        self.assertEqual(self.daemon.get(f"/jobs/{job}").status, 200)
        self.assertIsNone(self.daemon.process.poll())
        subprocess.run(["chattr", "-i", *files], check=True)
        self.assertEqual(
            self.daemon.post("/processes/echo/execution", echo, headers={"Prefer": "respond-async"}).status, 201
        )

    def test_a_directory_that_cannot_be_removed_yet(self):
        """As on a network file system. It is retried at intervals, the rest continues, and the log does not fill up."""
        self.start()
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        held = self.daemon.data / "jobs" / job / "held"
        held.write_text("")
        done = subprocess.run(["chattr", "+i", held], capture_output=True, text=True)
        self.addCleanup(subprocess.run, ["chattr", "-i", held], capture_output=True)
        if done.returncode != 0:
            self.skipTest("no chattr +i here: " + done.stderr.strip())
        self.assertEqual(self.daemon.request("DELETE", f"/jobs/{job}").status, 200)
        self.daemon.wait_for(self.daemon.submit(study(1)))
        time.sleep(2)
        self.assertIn((self.daemon.data.parent / "talusd.log").read_text().count("not_removed_yet"), (1, 2))
        subprocess.run(["chattr", "-i", held], check=True)
        deadline = time.monotonic() + 20
        while held.parent.exists() and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertFalse(held.parent.exists())

    def test_gnuplot_that_is_missing_or_refused(self):
        """The answer names gnuplot and no file; what needs no picture is answered all the same."""
        programs = self.dir / "programs"
        programs.mkdir()
        talus = self.dir / "talus"
        talus.write_text(f'#!/bin/sh\nPATH={programs}\nexec {TALUS} "$@"\n')
        talus.chmod(0o755)
        self.start("--talus", talus)
        job = self.daemon.submit(study(1))
        self.daemon.wait_for(job)
        path = f"/jobs/{job}/realizations/0"
        gnuplot = programs / "gnuplot"
        for script, said in (
            (None, "gnuplot, which draws the pictures, is missing here"),
            ("#!/bin/sh\nkill -SYS $$\n", "gnuplot, which draws the pictures, could not be run"),
            ("#!/bin/sh\necho no memory >&2\nexit 1\n", "gnuplot, which draws the pictures, could not be run"),
        ):
            if script:
                gnuplot.write_text(script)
                gnuplot.chmod(0o755)
            for what in ("field", "profile"):
                document = self.problem(self.daemon.get(f"{path}/{what}?format=svg"), 503)
                self.assertEqual(document["detail"], said)
                self.assertEqual(self.daemon.get(f"{path}/{what}").status, 200)

    def test_a_data_directory_of_someone_else(self):
        data = self.dir / "data"
        self.start()
        self.daemon.stop()
        if os.getuid() != 0 or not shutil.which("setpriv"):
            self.skipTest("needs root and setpriv to become somebody else")
        for path in (self.dir, data, *data.iterdir()):
            path.chmod(0o755 if path.is_dir() else 0o644)
        done = subprocess.run(
            ["setpriv", "--reuid=65534", "--clear-groups", TALUSD, "--data", str(data), "--listen", "127.0.0.1:0"],
            capture_output=True,
            text=True,
            timeout=20,
        )
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn(str(data), done.stderr)

    def test_a_talusd_killed_a_moment_ago(self):
        """Its locks outlive it for that moment; who starts the next at once need not try again."""
        (self.dir / "data").mkdir()
        with open(self.dir / "data/talusd.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            threading.Timer(0.5, lambda: fcntl.flock(lock, fcntl.LOCK_UN)).start()
            self.start()
        self.assertEqual(self.daemon.get("/healthz").status, 200)

    def test_a_database_that_is_none_of_ours(self):
        data = self.dir / "data"
        self.start()
        self.daemon.stop()
        connection = sqlite3.connect(data / "queue.sqlite")
        connection.execute("PRAGMA user_version = 99")
        connection.commit()
        connection.close()
        refused = Daemon(data, wait=False)
        self.assertEqual(refused.process.wait(10), 5)
        self.assertIn("newer", refused.log_text())
        refused.close()
        (data / "queue.sqlite").write_bytes(b"this is no database" * 100)
        refused = Daemon(data, wait=False)
        self.assertEqual(refused.process.wait(10), 5)
        self.assertIn("talusd:", refused.log_text())
        refused.close()

    def test_the_clock_jumps(self):
        """With a clock of its own that a file shifts: an hour ahead, then back by two."""
        source = self.dir / "clock.c"
        source.write_text('''
            #define _GNU_SOURCE
            #include <dlfcn.h>
            #include <stdio.h>
            #include <stdlib.h>
            #include <time.h>
            int clock_gettime(clockid_t id, struct timespec *t) {
              static int (*real)(clockid_t, struct timespec *);
              if (!real) real = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
              int result = real(id, t);
              if (id != CLOCK_REALTIME) return result;
              FILE *f = fopen(getenv("CLOCK_SHIFT"), "r");
              long shift = 0;
              if (f) { if (fscanf(f, "%ld", &shift) != 1) shift = 0; fclose(f); }
              t->tv_sec += shift;
              return result;
            }''')
        library = self.dir / "clock.so"
        done = subprocess.run(
            ["cc", "-shared", "-fPIC", "-o", str(library), str(source), "-ldl"], capture_output=True, text=True
        )
        if done.returncode != 0:
            self.skipTest("no C compiler: " + done.stderr)
        shift = self.dir / "shift"  # replaced by rename, so that it is never empty
        shift.write_text("0")
        self.start("--lease", 3, environment=dict(os.environ, LD_PRELOAD=str(library), CLOCK_SHIFT=str(shift)))
        job = self.daemon.submit(study(30, spacing=0.5, end=1.0))
        for value in (3600, -3600, 86400, 0):
            time.sleep(0.7)
            (self.dir / "next").write_text(str(value))
            (self.dir / "next").rename(shift)
        info = self.daemon.wait_for(job)
        self.assertEqual(info["realizations"], {"planned": 30, "done": 30, "failed": 0})
        attempts = [self.daemon.get(f"/jobs/{job}/realizations/{i}").json["attempt"] for i in range(30)]
        self.assertEqual(set(attempts), {1}, "a jump of the clock took a lease from a worker that was alive")


if __name__ == "__main__":
    main({"BadDays": BadDays})
