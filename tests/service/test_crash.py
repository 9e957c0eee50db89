#!/usr/bin/env python3
"""kill -9 and SIGTERM."""
import json
import os
import random
import signal
import subprocess
import time

from daemon import TALUS, Daemon, ServiceTest, case, digests, main, study, workers_of


class Crash(ServiceTest):
    """kill -9 and SIGTERM: every realization ends once, and the statistics are those of an undisturbed study."""

    RUNS = 24

    def undisturbed(self, **more):
        directory = self.dir / "plain"
        path = self.dir / "case.json"
        path.write_text(json.dumps(case(**more)))
        subprocess.run(
            [
                str(TALUS),
                "study",
                str(path),
                "--realizations",
                str(self.RUNS),
                "--seed",
                "7",
                "--out",
                str(directory),
                "--workers",
                "2",
                "--no-figures",
            ],
            check=True,
            capture_output=True,
        )
        return json.loads((directory / "study.json").read_text()), {
            p.stem: json.loads(p.read_text())["digest"] for p in (directory / "runs").glob("*.json")}

    def assert_same(self, job, plain):
        summary, expected = plain
        mine = self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]
        self.assertEqual(digests(self.daemon.data, job), expected)
        for document in (mine, summary):
            document.pop("effort")  # seconds
            document.pop("checksum", None)  # of the file
        self.assertEqual(mine, summary)

    def test_a_second_talusd_is_refused(self):
        self.start()
        second = Daemon(self.daemon.data, wait=False)
        self.assertEqual(second.process.wait(10), 5)
        self.assertIn("another talusd", second.log_text())
        second.close()
        self.assertEqual(self.daemon.get("/healthz").status, 200)

    def test_stopped_at_once(self):
        for _ in range(5):
            self.start()
            self.assertEqual(self.daemon.stop(seconds=10), 0)

    def test_sigterm_drains_and_the_next_one_goes_on(self):
        plain = self.undisturbed(spacing=0.5, end=1.0)
        self.start("--grace", 20)
        job = self.daemon.submit(study(self.RUNS, spacing=0.5, end=1.0))
        while self.daemon.get(f"/jobs/{job}").json["realizations"]["done"] < 3:
            time.sleep(0.02)
        begin = time.monotonic()
        self.assertEqual(self.daemon.stop(), 0)
        self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual(workers_of(self.dir), [])
        self.start()
        self.assertEqual(self.daemon.wait_for(job)["realizations"]["done"], self.RUNS)
        self.assert_same(job, plain)

    def test_what_was_checkpointed_is_resumed(self):
        self.start("--attempts", 1, workers=1)  # a stop does not count as a crash
        job = self.daemon.submit(study(1, spacing=0.2, end=3))
        work = self.daemon.data / "jobs" / job / "work/000000"
        while not (work / "history.csv").exists() and not (work / "snapshots.vtkhdf").exists():
            time.sleep(0.02)
        time.sleep(1)
        self.assertEqual(self.daemon.stop(), 0)
        self.assertTrue((work / "checkpoint.h5").exists())
        self.start(workers=1)
        time.sleep(0.3)
        commands = [open(f"/proc/{pid}/cmdline").read() for pid in workers_of(self.dir)]
        self.assertTrue(any("--resume" in command for command in commands), commands)
        self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
        self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations/0").json["attempt"], 2)

    def kills(self, count, seed):
        """kill -9 of talusd or of a worker at random moments, `count` times, while a study runs."""
        random_source = random.Random(seed)
        plain = self.undisturbed(spacing=0.8, end=1.5)
        self.start("--attempts", 100)
        job = self.daemon.submit(study(self.RUNS, spacing=0.8, end=1.5))
        done, of_talusd, of_workers = 0, 0, 0
        while done < count:
            time.sleep(random_source.uniform(0.0, 0.15))
            running = workers_of(self.dir)
            if running and random_source.random() < 0.6:
                try:
                    os.kill(random_source.choice(running), signal.SIGKILL)
                    of_workers += 1
                except ProcessLookupError:
                    continue
            else:
                self.daemon.kill()
                self.start("--attempts", 100)
                of_talusd += 1
            done += 1
            if self.daemon.get(f"/jobs/{job}").json["status"] != "running":
                self.daemon.post(f"/jobs/{job}/extend", {"realizations": 0})  # refused: nothing to extend
                break
        info = self.daemon.wait_for(job)
        self.assertEqual(info["realizations"], {"planned": self.RUNS, "done": self.RUNS, "failed": 0})
        self.assert_same(job, plain)
        return done, of_talusd, of_workers

    def test_killed_at_random_moments(self):
        done, of_talusd, of_workers = self.kills(12, seed=1)
        print(f"\n{of_talusd} kills of talusd, {of_workers} of workers", flush=True)


class ManyKills(Crash):
    """Many kills, over a study long enough for them."""

    KILLS = int(os.environ.get("TALUS_KILLS", "50"))
    RUNS = 20 + 2 * KILLS

    def test_killed_at_random_moments(self):
        done, of_talusd, of_workers = self.kills(self.KILLS, seed=2)
        print(f"\n{of_talusd} kills of talusd, {of_workers} of workers", flush=True)
        self.assertEqual(done, self.KILLS)

    test_a_second_talusd_is_refused = None
    test_sigterm_drains_and_the_next_one_goes_on = None
    test_what_was_checkpointed_is_resumed = None
    test_stopped_at_once = None


if __name__ == "__main__":
    main({"Crash": Crash, "ManyKills": ManyKills})
