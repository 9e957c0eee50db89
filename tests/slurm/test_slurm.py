#!/usr/bin/env python3
"""Studies on a real Slurm that the test starts itself.  usage: test_slurm.py TALUSD SOURCE_DIR GROUP [test names]"""
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "service"))
from cluster import Cluster  # noqa: E402
from daemon import TALUS, TALUSD, Daemon, case, digests, main  # noqa: E402

REALIZATIONS, SEED = 14, 5
CASE = case(spacing=0.3, end=4.0)  # some two seconds a run
OVER = ("successful", "failed")


def published(directory):
    """What a study says of itself, without what time it took and the checksums that cover that time."""
    study = json.loads((directory / "study.json").read_text())
    study["effort"].pop("wall_clock_s")
    study.pop("checksum")
    tables = []
    for name in ("realizations.csv", "noise_floor.csv"):
        with open(directory / name, newline="") as file:
            tables.append([{k: v for k, v in row.items() if k not in ("wall_clock_s", "checksum")} for row in csv.DictReader(file)])
    return study, tables


class SlurmTest(unittest.TestCase):
    nodes, min_job_age = 2, 300

    @classmethod
    def setUpClass(cls):
        for program in ("/usr/sbin/slurmctld", "/usr/sbin/slurmd", "/usr/sbin/munged"):
            if not os.access(program, os.X_OK):
                raise AssertionError(f"there is no {program}; deploy/install-packages.sh test")
        cls.plain = pathlib.Path(tempfile.mkdtemp(prefix="talus-slurm-"))
        cls.addClassCleanup(shutil.rmtree, cls.plain, ignore_errors=True)
        (cls.plain / "case.json").write_text(json.dumps(CASE))
        done = subprocess.run([*cls.study(cls.plain / "study"), "--workers", "2"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr

    @classmethod
    def study(cls, out):
        return [TALUS, "study", cls.plain / "case.json", "--out", out, "--realizations", str(REALIZATIONS), "--seed",
                str(SEED), "--no-figures"]

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="talus-slurm-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)
        self.cluster = Cluster(self.dir / "cluster", self.nodes, min_job_age=self.min_job_age)
        self.addCleanup(self.cluster.stop)
        self.cluster.start()
        self.configure()

    def configure(self, **more):
        (self.dir / "slurm.json").write_text(json.dumps({"partition": "batch", "poll_s": 0.25, **more}))

    def squeue(self, *options):
        return self.cluster.run("squeue", "-h", "-r", *options).split("\n")[:-1]

    def running(self):
        return self.squeue("-tR", "-o%A")

    def releases_until(self, over):
        """Every array comes held."""
        def all_released():
            for job in set(self.squeue("-tPD", "-o%F")):
                self.cluster.run("scontrol", "release", job, check=False)  # it may just have begun
            return over()

        self.cluster.wait("the end of all", all_released, 150)


class StudyTest(SlurmTest):
    def start(self, **environment):
        self.log = open(self.dir / "log", "ab")
        self.addCleanup(self.log.close)
        self.process = subprocess.Popen(
            [*self.study(self.dir / "study"), "--executor", "slurm", "--slurm", self.dir / "slurm.json"],
            env={**self.cluster.environment, **environment}, stdout=subprocess.DEVNULL, stderr=self.log)
        self.addCleanup(self.process.kill)

    def output(self):
        return (self.dir / "log").read_text()

    def ended(self):
        return len([p for p in (self.dir / "study/runs").glob("*.json")])

    def begun(self):
        """Waits until some realizations have ended and others run."""
        self.cluster.wait("the study to be under way", lambda: self.process.poll() is not None or (self.ended() > 1 and self.running()))
        self.assertIsNone(self.process.poll(), self.output())

    def finishes(self, code=0, seconds=150):
        try:
            self.assertEqual(self.process.wait(seconds), code, self.output())
        except subprocess.TimeoutExpired:
            self.fail(f"the study does not end\n{self.output()}\n{self.squeue()}\n{self.cluster.logs()}")

    def same_as_local(self):
        self.assertEqual(published(self.dir / "study"), published(self.plain / "study"))
        self.assertFalse((self.dir / "study/work").exists())


class Studies(StudyTest):
    """talus study --executor slurm"""

    def test_the_same_as_local(self):
        self.start()
        self.finishes()
        self.same_as_local()
        self.assertNotIn("trying", self.output())

    def test_a_lost_node(self):
        self.start()
        self.begun()
        self.cluster.kill_node("n1")
        self.finishes()
        self.same_as_local()

    def test_a_node_that_only_seems_lost(self):
        """Its daemon is gone, what it had started runs on beside what Slurm starts elsewhere."""
        self.start()
        self.begun()
        self.cluster.end(self.cluster.pid("slurmd-n1.pid"), signal.SIGKILL)
        self.finishes()
        self.same_as_local()

    def test_preempted(self):
        self.start()
        self.begun()
        while "requeue" not in self.cluster.logs().lower():  # runs may happen to end just when the urgent job comes
            self.assertIsNone(self.process.poll(), "nothing has been requeued before the end of the study")
            self.cluster.run("sbatch", "--partition=urgent", "--nodes=2", f"--chdir={self.dir}", "--wrap=sleep 1")
            self.cluster.wait("the urgent job to end", lambda: not self.squeue("--partition=urgent"))
        self.finishes()
        self.same_as_local()

    def test_cancelled_from_outside(self):
        self.start()
        self.begun()
        self.cluster.run("scancel", "--partition=batch")
        self.finishes()
        self.same_as_local()
        self.assertIn("lost by Slurm (CANCELLED)", self.output())

    def test_cancelled_again_and_again(self):
        """Who cancels often enough has their will: the realizations failed, and say why."""
        self.start()
        while self.process.poll() is None:
            self.cluster.run("scancel", "--partition=batch", check=False)
            time.sleep(0.1)
        self.finishes(7)
        failed = json.loads((self.dir / "study/study.json").read_text())["failures"]
        self.assertTrue(failed)
        self.assertIn("lost by Slurm (CANCELLED), 5 times", failed[0]["reason"])

    def test_the_controller_is_away(self):
        # Two tasks of a run or two at a time: without the controller the study cannot come to its end.
        self.configure(array_tasks=2, task_s=1)
        self.start()
        self.begun()
        self.cluster.stop_controller()
        self.cluster.wait("the study to notice", lambda: "waiting for Slurm" in self.output())
        time.sleep(5)
        self.assertIsNone(self.process.poll(), self.output())
        self.cluster.start_controller()
        self.finishes()
        self.same_as_local()
        self.assertIn("Slurm answers again", self.output())

    def test_killed_it_takes_over_what_runs_on(self):
        self.start()
        self.begun()
        self.process.kill()
        self.process.wait()
        left = set(self.squeue("-tPD,R", "-o%F_%K"))
        self.assertTrue(left)
        self.start()
        self.finishes()
        self.same_as_local()
        self.assertNotIn("trying", self.output())  # two at the same run would get in each other's way
        self.assertEqual({t.split()[1] for t in self.squeue("-tall", "-o%F_%K %T") if t.split()[0] in left}, {"COMPLETED"})

    def test_stopped_it_cancels_and_goes_on(self):
        self.start()
        self.begun()
        self.process.send_signal(signal.SIGTERM)
        self.finishes(6)
        self.assertEqual(self.squeue("-tPD,R"), [])
        self.start()
        self.finishes()
        self.same_as_local()

    def test_held(self):
        self.configure(sbatch_options=["--hold"])
        self.start()
        self.cluster.wait("the study to say so", lambda: "0 failed, 8 running, waits in Slurm's queue: JobHeldUser" in self.output())
        self.releases_until(lambda: self.process.poll() is not None)
        self.finishes()
        self.same_as_local()

    def test_a_directory_that_is_listed_late(self):
        """As on NFS: what is not listed yet may well be there."""
        late = pathlib.Path(TALUSD).parent.parent / "tests/late_listing.so"
        self.assertTrue(late.exists())
        self.start(LD_PRELOAD=str(late))
        self.finishes()
        self.assertNotIn("LD_PRELOAD", self.output())  # the loader says so where it cannot
        self.same_as_local()

    def test_refused_by_slurm(self):
        self.configure(partition="nowhere")
        self.start()
        self.finishes(5)
        self.assertRegex(self.output(), "Slurm takes no runs: sbatch: .*[Ii]nvalid partition")

    def test_a_bad_configuration(self):
        self.configure(poll_s="often", partition="a b", sbatch_options=["--wait", "qos"], node="n1")
        self.start()
        self.finishes(2)
        for fault in ("/poll_s is not a number", "/partition may hold", "--wait is set by Talus", "/sbatch_options/1", "/node is not a known key"):
            self.assertIn(fault, self.output())


class Forgotten(StudyTest):
    """Slurm forgets a job soon after its end."""
    min_job_age = 2

    def test_a_job_that_slurm_forgot(self):
        self.start()
        self.begun()
        self.process.kill()
        self.process.wait()
        self.cluster.run("scancel", "--partition=batch")
        self.cluster.wait("Slurm to forget", lambda: json.loads(self.cluster.run("squeue", "--json", "--states=all"))["jobs"] == [], 120)
        self.start()
        self.finishes()
        self.same_as_local()
        self.assertIn("lost by Slurm (forgotten)", self.output())


class TimeLimit(StudyTest):
    """A minute an array task, and a run that takes longer."""

    def test_checkpointed_and_resumed(self):
        (self.dir / "slow.json").write_text(json.dumps(case(spacing=0.15, end=self.end_after(60))))
        self.configure(time_limit_min=1)
        command = [TALUS, "study", self.dir / "slow.json", "--realizations", "2", "--seed", "3", "--no-figures",
                   "--set", "study.noise_floor_replicates=0", "--set", "numerics.precision=double"]
        remote = subprocess.run([*command, "--out", self.dir / "study", "--executor", "slurm", "--slurm", self.dir / "slurm.json"],
                                env=self.cluster.environment, capture_output=True, text=True, timeout=900)
        self.assertEqual(remote.returncode, 0, remote.stderr + self.cluster.logs())
        tasks = self.squeue("-tall", "-o%F_%K %T %M")
        self.assertGreater(len(tasks), 2, f"no task was broken off by the limit: {tasks}")
        local = subprocess.run([*command, "--out", self.dir / "local", "--workers", "2"], capture_output=True, text=True, timeout=900)
        self.assertEqual(local.returncode, 0, local.stderr)
        self.assertEqual(published(self.dir / "study"), published(self.dir / "local"))

    def end_after(self, seconds):
        """When the slide must end for a run to take about so long on this machine."""
        (self.dir / "short.json").write_text(json.dumps(case(spacing=0.15, end=0.3)))
        begin = time.monotonic()
        subprocess.run([TALUS, "run", self.dir / "short.json", "--out", self.dir / "short", "--threads", "1", "--realization", "0",
                        "--seed", "3", "--set", "numerics.precision=double"], check=True, capture_output=True)
        return round(0.3 * seconds / (time.monotonic() - begin), 1)


class Service(SlurmTest):
    """talusd --executor slurm"""
    nodes = 3

    def start(self, **more):
        self.daemon = Daemon(self.dir / "data", "--executor", "slurm", "--slurm", self.dir / "slurm.json",
                             environment=self.cluster.environment, **more)
        self.addCleanup(lambda: self.daemon.process.poll() is None and self.daemon.kill())

    def submit(self):
        return self.daemon.submit({"inputs": {"case": CASE, "realizations": REALIZATIONS, "seed": SEED}})

    def begun(self, job):
        self.cluster.wait("the job to be under way", lambda: len(digests(self.dir / "data", job)) > 1 and self.running())

    def finishes(self, job):
        try:
            info = self.daemon.wait_for(job, OVER, 150)
        except AssertionError as e:
            self.fail(f"{e}\n{self.daemon.log_text()}\n{self.squeue()}\n{self.cluster.logs()}")
        self.assertEqual(info["status"], "successful", info)
        return info

    def same_as_local(self, job):
        self.assertEqual(published(self.dir / "data/jobs" / job), published(self.plain / "study"))
        histogram = self.daemon.get(f"/jobs/{job}/results").json["histogram"]["value"]["histogram"]
        local = json.loads((self.plain / "study/study.json").read_text())["quantities"]["influence_zone_m"]["histogram"]
        self.assertEqual(histogram["counts"], local["counts"])
        self.assertEqual(histogram["edges"], local["edges"])

    def test_survives_the_kill_of_a_node(self):
        self.start()
        job = self.submit()
        self.begun(job)
        self.cluster.kill_node("n2")
        self.finishes(job)
        self.same_as_local(job)

    def test_killed_and_started_again(self):
        self.start()
        job = self.submit()
        self.begun(job)
        self.daemon.kill()
        before = set(self.squeue("-tall", "-o%F"))
        self.start()
        self.finishes(job)
        self.same_as_local(job)
        self.assertTrue(before)

    def test_stopped_it_leaves_the_array_running(self):
        self.start()
        job = self.submit()
        self.begun(job)
        self.assertEqual(self.daemon.stop(), 0)
        self.assertTrue(self.running())
        self.start()
        self.finishes(job)
        self.same_as_local(job)

    def test_a_held_job_says_so(self):
        self.configure(sbatch_options=["--hold"])
        self.start()
        job = self.submit()
        self.cluster.wait("the job to say so", lambda: "waits" in self.daemon.get(f"/jobs/{job}").json)
        info = self.daemon.get(f"/jobs/{job}").json
        self.assertEqual(info["waits"], "waits in Slurm's queue: JobHeldUser")
        self.assertEqual(info["message"], f"0 of {REALIZATIONS} realizations done; {info['waits']}")
        self.releases_until(lambda: self.daemon.get(f"/jobs/{job}").json["status"] in OVER)
        info = self.finishes(job)
        self.assertNotIn("waits", info)
        self.same_as_local(job)

    def test_a_dismissed_job_is_cancelled(self):
        self.start()
        job = self.submit()
        self.begun(job)
        self.daemon.request("DELETE", f"/jobs/{job}")
        self.cluster.wait("its tasks to be gone", lambda: not self.squeue("-tPD,R"))
        self.cluster.wait("its directory to be gone", lambda: not (self.dir / "data/jobs" / job).exists())


if __name__ == "__main__":
    main({"Studies": Studies, "Forgotten": Forgotten, "TimeLimit": TimeLimit, "Service": Service})
