#!/usr/bin/env python3
"""What was computed is kept: lost and copied queues, backups, foreign files, jobs that others submit and dismiss."""

import concurrent.futures
import json
import os
import pathlib
import shutil
import sqlite3
import subprocess
import time

from daemon import TALUS, TALUSD, ServiceTest, digests, main, study

SUBMISSIONS = int(os.environ.get("TALUS_SUBMISSIONS", "60"))  # more: tests/service/README.md
CLIENTS = int(os.environ.get("TALUS_CLIENTS", "10"))


def talusd(*options, code=0):
    """talusd with a task that ends. @return its output"""
    done = subprocess.run([TALUSD, *map(str, options)], capture_output=True, text=True, timeout=120)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    return done.stdout if code == 0 else done.stderr


class Kept(ServiceTest):
    def results(self, job):
        summary = self.daemon.get(f"/jobs/{job}/results").json["summary"]["value"]
        summary.pop("effort")  # seconds
        return summary

    def wait_for_some(self, job, runs=2):
        while self.daemon.get(f"/jobs/{job}").json["realizations"]["done"] < runs:
            time.sleep(0.02)


class Keeping(Kept):
    """No result is deleted because the queue does not know it, and what was put aside can be taken back."""

    def forget_queue(self):
        for file in self.daemon.data.glob("queue.sqlite*"):
            file.unlink()

    def names(self, directory):
        return sorted(path.name for path in (self.daemon.data / directory).iterdir())

    def test_no_job_is_lost_while_others_are_submitted_and_dismissed(self):
        self.start("--max-jobs", 10**6, "--max-jobs-each", 10**6)
        for i in range(3000):  # a walk of DATA/jobs takes longer, and jobs are accepted during it
            (self.daemon.data / "jobs" / f"other-{i}").mkdir()

        def client(number):
            body = study(1, seed=number, noise_floor_replicates=0)
            path = "/processes/influence-zone/execution"
            while (reply := self.daemon.post(path, body)).status == 503:  # too many at once: it has been refused
                time.sleep(0.1)
            self.assertEqual(reply.status, 201, reply.body)
            job = reply.json["jobID"]
            if number % 3 == 0:  # each dismissal sweeps DATA/jobs
                self.daemon.request("DELETE", f"/jobs/{job}")
                return None
            return job

        with concurrent.futures.ThreadPoolExecutor(CLIENTS) as clients:
            kept = [job for job in clients.map(client, range(SUBMISSIONS)) if job]
        lost = [job for job in kept if not (self.daemon.data / "jobs" / job / "case.resolved.json").exists()]
        print(f"\nconcurrent submissions lost: {len(lost)} of {len(kept)}", flush=True)
        self.assertEqual(lost, [])
        self.assertEqual(self.daemon.wait_for(kept[0])["status"], "successful")

    def test_a_lost_queue_is_rebuilt_from_the_jobs(self):
        mark = self.dir / "mark"
        mark.write_text("")
        fake = self.dir / "talus"  # as talus, but realization 1 of the seed 9 fails while the mark is there
        fake.write_text(
            f'#!/bin/sh\nif [ "$1" = run ] && [ "$4" = 1 ] && [ "$6" = 9 ] && [ -e {mark} ]; then exit 4; fi\n'
            f'exec {TALUS} "$@"\n'
        )
        fake.chmod(0o755)
        self.start("--talus", fake)
        done = self.daemon.submit(study(4))
        failed = self.daemon.submit(study(3, seed=9))
        self.daemon.wait_for(done)
        self.daemon.wait_for(failed)
        half = self.daemon.submit(study(16, spacing=0.5, end=1.5))
        self.wait_for_some(half)
        before = {job: self.daemon.get(f"/jobs/{job}").json for job in (done, failed)}
        summary, histogram = self.results(done), self.daemon.get(f"/jobs/{done}/histogram").json["histogram"]
        self.assertEqual(self.daemon.stop(), 0)
        had = {job: digests(self.daemon.data, job) for job in (done, failed, half)}
        self.forget_queue()

        self.start("--talus", fake)
        self.assertEqual(self.names("jobs"), [])
        self.assertEqual(self.names("orphans"), sorted(had))
        self.assertEqual(self.daemon.get("/readyz").json["orphans"], 3)
        self.assertIn(b"talus_orphans 3", self.daemon.get("/metrics").body)
        self.assertIn("another talusd", talusd("--data", self.daemon.data, "--adopt", code=5))
        self.assertEqual(self.daemon.stop(), 0)
        said = talusd("--data", self.daemon.data, "--adopt")
        self.assertIn(f"adopted {done}: 4 of 4 realizations done, 0 failed\n", said)
        self.assertIn(f"adopted {failed}: {len(had[failed])} of 3 realizations done, 1 failed\n", said)

        self.start("--talus", fake)
        self.assertEqual(self.daemon.get("/readyz").json, {"status": "ready"})
        for job in (done, failed):
            info = self.daemon.wait_for(job)
            for key in ("status", "message", "title", "seed", "realizations", "quality", "created"):
                self.assertEqual(info[key], before[job][key], key)
        self.assertEqual([job["jobID"] for job in self.daemon.get("/jobs").json["jobs"]], [half, failed, done])
        self.assertEqual(self.results(done), summary)
        self.assertEqual(self.daemon.get(f"/jobs/{done}/histogram").json["histogram"], histogram)
        self.assertEqual(self.daemon.wait_for(half)["realizations"], {"planned": 16, "done": 16, "failed": 0})
        for job, kept in had.items():
            self.assertEqual({index: digests(self.daemon.data, job)[index] for index in kept}, kept)
        self.assertEqual(self.daemon.get(f"/jobs/{done}/realizations/0").json["attempt"], 1)
        mark.unlink()
        self.daemon.post(f"/jobs/{failed}/retry")
        self.assertEqual(self.daemon.wait_for(failed)["status"], "successful")

    def test_a_queue_that_is_put_back_gets_its_directories_back(self):
        self.start()
        job = self.daemon.submit(study(3))
        self.daemon.wait_for(job)
        summary = self.results(job)
        self.daemon.stop()
        away = self.dir / "away"
        away.mkdir()
        for file in self.daemon.data.glob("queue.sqlite*"):
            file.rename(away / file.name)
        self.start()
        self.daemon.stop()
        self.forget_queue()
        for file in away.iterdir():
            file.rename(self.daemon.data / file.name)
        self.assertIn(f"adopted {job}: directory returned", talusd("--data", self.daemon.data, "--adopt"))
        self.start()
        self.assertEqual(self.results(job), summary)
        self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations/0/field").status, 200)

    def test_data_copied_without_the_write_ahead_log(self):
        self.start()
        jobs = [self.daemon.submit(study(3, seed=seed)) for seed in (7, 8)]
        for job in jobs:
            self.daemon.wait_for(job)
        summaries = [self.results(job) for job in jobs]
        copy = self.dir / "copy"
        shutil.copytree(self.daemon.data, copy, ignore=shutil.ignore_patterns("*-wal", "*-shm"))
        self.daemon.stop()
        self.daemon.data.rename(self.dir / "original")
        copy.rename(self.daemon.data)
        said = talusd("--data", self.daemon.data, "--adopt")  # puts aside, and takes back
        self.assertEqual(said.count("adopted"), 2, said)
        self.start()
        for job, summary in zip(jobs, summaries):
            self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
            self.assertEqual(self.results(job), summary)

    def test_a_damaged_write_ahead_log(self):
        """SQLite falls back to what came before the damage, here to a queue without jobs."""
        self.start()
        jobs = [self.daemon.submit(study(2, seed=seed)) for seed in (7, 8)]
        for job in jobs:
            self.daemon.wait_for(job)
        summaries = [self.results(job) for job in jobs]
        self.daemon.kill()
        log = self.daemon.data / "queue.sqlite-wal"
        content = bytearray(log.read_bytes())
        self.assertGreater(len(content), 4096)
        content[100] ^= 1  # in the first frame
        log.write_bytes(content)
        self.start()
        self.assertEqual(self.daemon.get("/jobs").json["jobs"], [])
        self.assertEqual(self.daemon.get("/readyz").json["orphans"], 2)
        self.daemon.stop()
        self.assertEqual(talusd("--data", self.daemon.data, "--adopt").count("adopted"), 2)
        self.start()
        for job, summary in zip(jobs, summaries):
            self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
            self.assertEqual(self.results(job), summary)

    def test_a_backup_is_restored_with_jobs_before_and_after_it(self):
        self.start()
        data, backup = self.daemon.data, self.dir / "backup"
        before = self.daemon.submit(study(3))
        self.daemon.wait_for(before)
        gone = self.daemon.submit(study(1))
        self.daemon.request("DELETE", f"/jobs/{gone}")
        during = self.daemon.submit(study(16, spacing=0.5, end=1.5, seed=8))
        self.wait_for_some(during)
        self.assertIn("2 jobs", talusd("--data", data, "--backup", backup))
        self.assertEqual(sorted(p.name for p in backup.iterdir()), ["jobs", "queue.sqlite"])
        self.assertFalse((backup / "jobs" / during / "work").exists())
        self.assertIn("not an empty directory", talusd("--data", data, "--backup", backup, code=5))
        after = self.daemon.submit(study(3, seed=9))
        self.daemon.wait_for(after)
        self.daemon.wait_for(during)
        summaries = {job: self.results(job) for job in (before, during, after)}
        self.daemon.kill()

        # As service/README.md says: the backup becomes the data directory, newer jobs are adopted from the old one.
        old = self.dir / "old"
        data.rename(old)
        backup.rename(data)
        (data / "orphans").mkdir()
        (old / "jobs" / after).rename(data / "orphans" / after)
        self.assertIn(f"adopted {after}: 3 of 3", talusd("--data", data, "--adopt"))
        self.start()
        for job, summary in summaries.items():
            self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
            self.assertEqual(self.results(job), summary)
        self.assertEqual(self.daemon.get(f"/jobs/{gone}").json["status"], "dismissed")

    def test_a_backup_without_a_queue_or_a_place(self):
        self.assertIn("there is no queue", talusd("--data", self.dir, "--backup", self.dir / "b", code=5))
        self.start()
        (self.dir / "file").write_text("mine")
        self.assertIn("not an empty directory",
                      talusd("--data", self.daemon.data, "--backup", self.dir / "file", code=5))
        self.assertEqual((self.dir / "file").read_text(), "mine")

    def test_foreign_files_are_put_aside(self):
        self.start()
        job = self.daemon.submit(study(2))
        self.daemon.wait_for(job)
        self.daemon.stop()
        data, mine = self.daemon.data, self.dir / "mine"
        mine.mkdir()
        (mine / "important.txt").write_text("mine")
        (data / "notes.txt").write_text("mine")
        for place in ("jobs/notes", "jobs/new-0123", "jobs/new-notes", "scratch/notes", "orphans/notes"):
            (data / place).mkdir(parents=True)
            (data / place / "important.txt").write_text(place)
        (data / "jobs/list.txt").write_text("mine")
        (data / "jobs/link").symlink_to(mine)
        for ours in ("jobs/new-" + 32 * "0", "scratch/" + 16 * "a", "scratch/command-" + 16 * "b"):
            (data / ours).mkdir()
            (data / ours / "case.json").write_text("{}")
        self.start()
        self.assertEqual(self.names("jobs"), [job])
        self.assertEqual(self.names("scratch"), [])
        aside = ["link", "list.txt", "new-0123", "new-notes", "notes", "notes-2", "notes-3"]
        self.assertEqual(self.names("orphans"), aside)
        self.assertEqual({(data / f"orphans/notes{n}/important.txt").read_text() for n in ("", "-2", "-3")},
                         {"jobs/notes", "scratch/notes", "orphans/notes"})
        self.assertEqual((mine / "important.txt").read_text(), "mine")
        self.assertEqual((data / "notes.txt").read_text(), "mine")
        self.assertIn("moved_to", self.daemon.log_text())
        self.daemon.stop()
        said = talusd("--data", data, "--adopt")
        self.assertEqual(said.count("left "), len(aside), said)
        self.assertEqual(self.names("orphans"), aside)

    def test_a_job_record_that_is_damaged_or_missing(self):
        self.start()
        job = self.daemon.submit(study(2))
        self.daemon.wait_for(job)
        self.daemon.stop()
        record = self.daemon.data / "jobs" / job / "job.json"
        whole = record.read_bytes()
        record.unlink()
        self.start()  # as after an upgrade from a version without it
        self.daemon.stop()
        self.assertEqual({**json.loads(whole), "created_ms": 0, "checksum": 0},
                         {**json.loads(record.read_bytes()), "created_ms": 0, "checksum": 0})
        self.forget_queue()
        record.write_bytes(whole.replace(b'"seed": 7', b'"seed": 8'))
        self.assertIn("is damaged", talusd("--data", self.daemon.data, "--adopt"))
        aside = self.daemon.data / "orphans" / job / "job.json"
        aside.write_bytes(whole)
        self.assertIn(f"adopted {job}", talusd("--data", self.daemon.data, "--adopt"))

    def test_a_damaged_queue_is_refused_with_what_to_do(self):
        self.start()
        job = self.daemon.submit(study(2))
        self.daemon.wait_for(job)
        self.daemon.stop()
        queue = self.daemon.data / "queue.sqlite"
        connection = sqlite3.connect(queue)
        size = connection.execute("PRAGMA page_size").fetchone()[0]
        root = connection.execute("SELECT rootpage FROM sqlite_schema WHERE name = 'runs'").fetchone()[0]
        connection.close()
        pages = bytearray(queue.read_bytes())
        pages[(root - 1) * size + 3] ^= 4  # the number of cells of the page
        queue.write_bytes(pages)
        refused = talusd("--data", self.daemon.data, "--listen", "127.0.0.1:0", "--talus", TALUS, code=5)
        self.assertIn("is damaged", refused)
        self.assertIn("--adopt", refused)
        self.forget_queue()
        self.assertIn(f"adopted {job}: 2 of 2", talusd("--data", self.daemon.data, "--adopt"))


class Repair(Kept):
    """Files of a job that are damaged or lost: results are run again, the rest is made again, and retry says the truth."""

    def job_files(self, job):
        return self.daemon.data / "jobs" / job

    def flip(self, path, old, new):
        text = path.read_bytes()
        self.assertIn(old, text, path)
        path.write_bytes(text.replace(old, new, 1))

    def test_a_result_that_is_lost_while_the_job_runs_is_run_again(self):
        self.start()
        job = self.daemon.submit(study(12, spacing=0.8, end=1.5))
        self.wait_for_some(job)
        lost = sorted(path for path in (self.job_files(job) / "runs").glob("0*.json"))[0]
        whole = json.loads(lost.read_text())["digest"]
        lost.unlink()
        self.assertEqual(self.daemon.wait_for(job)["realizations"], {"planned": 12, "done": 12, "failed": 0})
        self.assertEqual(json.loads(lost.read_text())["digest"], whole)
        self.assertIn("results_missing", (self.dir / "talusd.log").read_text())

    def test_retry_runs_lost_damaged_and_foreign_results_again(self):
        self.start()
        job = self.daemon.submit(study(5, noise_floor_replicates=2))
        self.daemon.wait_for(job)
        files, had, summary = self.job_files(job), digests(self.daemon.data, job), self.results(job)
        (files / "runs/000000.json").unlink()
        self.flip(files / "runs/000001.json", b'"digest": "', b'"digest": "0')
        self.flip(files / "runs/000002.json", b'"steps": 1', b'"steps": 2')
        shutil.copy(files / "floor/2.json", files / "runs/000003.json")
        (files / "floor/1.json").write_text("{")
        self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").json["realizations"],
                         {"planned": 5, "done": 1, "failed": 0})
        info = self.daemon.wait_for(job)
        self.assertEqual((info["status"], info["realizations"]["done"]), ("successful", 5))
        self.assertEqual(digests(self.daemon.data, job), had)
        self.assertEqual(self.results(job), summary)
        self.assertEqual([self.daemon.get(f"/jobs/{job}/realizations/{i}").json["attempt"] for i in range(5)],
                         [2, 2, 2, 2, 1])
        self.assertTrue((files / "runs/000003.json.foreign").exists())

    def test_files_that_follow_from_others_are_made_again(self):
        self.start()
        job = self.daemon.submit(study(4))
        self.daemon.wait_for(job)
        files, summary = self.job_files(job), self.results(job)
        field = self.daemon.get(f"/jobs/{job}/realizations/0/field").json
        whole = {path.name: path.read_bytes() for path in files.iterdir() if path.is_file()}
        for name in ("study.json", "plan.json", "talus-output.json", "case.resolved.json", "job.json",
                     "realizations.csv"):
            for damage in (b"", b"{", whole[name][:-40], whole[name].replace(b"0", b"1", 1)):
                (files / name).write_bytes(damage)
                self.daemon.stop()  # nothing is remembered
                self.start()
                self.assertEqual(self.results(job), summary, name)
                self.assertEqual(self.daemon.get(f"/jobs/{job}/realizations/0/field").json, field, name)
                self.assertEqual(self.daemon.get(f"/jobs/{job}/histogram").json["done"], 4, name)
                self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").status, 200, name)
                self.assertEqual(self.daemon.wait_for(job)["realizations"]["done"], 4)
                if name not in ("study.json",):  # which holds seconds
                    self.assertEqual((files / name).read_bytes(), whole[name], name)
        (files / "job.json").write_text("")
        self.flip(files / "case.resolved.json", b"1.0", b"1.5")
        self.assertIn("lost", self.problem(self.daemon.post(f"/jobs/{job}/retry"), 409)["detail"])
        for name in ("job.json", "case.resolved.json"):
            (files / name).write_bytes(whole[name])
        self.daemon.post(f"/jobs/{job}/extend", {"realizations": 1})
        self.assertEqual(self.daemon.wait_for(job)["realizations"]["done"], 5)

    def test_a_damaged_profile_is_made_again(self):
        self.start()
        job = self.daemon.submit(study(1, noise_floor_replicates=0))
        self.daemon.wait_for(job)
        path, kept = f"/jobs/{job}/realizations/0/profile", self.job_files(job) / "profiles/0.json"
        profile = self.daemon.get(path).body
        self.assertEqual(self.daemon.get(path).body, profile)
        self.flip(kept, b'"x_m":[', b'"x_m":[9')
        self.assertEqual(self.daemon.get(path).body, profile)
        kept.write_text("")
        self.assertEqual(self.daemon.get(path).body, profile)

    def test_a_job_whose_directory_is_removed_stops_and_goes_on_once_it_is_back(self):
        self.start()
        job = self.daemon.submit(study(30, spacing=0.8, end=1.5))
        self.wait_for_some(job)
        files, away = self.job_files(job), self.dir / "away"
        files.rename(away)
        info = self.daemon.wait_for(job)
        self.assertEqual(info["status"], "failed")
        self.assertIn("case.resolved.json is missing", info["message"])
        self.assertFalse(files.exists())
        self.assertEqual(info["realizations"]["failed"], 0)
        self.problem(self.daemon.post(f"/jobs/{job}/retry"), 409)
        self.daemon.stop()
        self.start()
        self.assertIn("job_directory_missing", self.daemon.log_text())
        away.rename(files)
        self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").status, 200)
        self.assertEqual(self.daemon.wait_for(job)["realizations"], {"planned": 30, "done": 30, "failed": 0})

    def test_statistics_that_could_not_be_made(self):
        self.start()
        for name, block, free in (
            ("study.json", pathlib.Path.mkdir, pathlib.Path.rmdir),
            ("realizations.csv", pathlib.Path.mkdir, pathlib.Path.rmdir),
        ):
            job = self.daemon.submit(study(8, spacing=0.8, end=1.5))
            block(self.job_files(job) / name)
            info = self.daemon.wait_for(job)
            self.assertEqual(info["status"], "failed")
            self.assertIn(name, info["message"])
            self.assertEqual(self.daemon.wait_for(self.daemon.submit())["status"], "successful")
            free(self.job_files(job) / name)
            self.assertEqual(self.daemon.post(f"/jobs/{job}/retry").status, 200)
            self.assertEqual(self.daemon.wait_for(job)["status"], "successful")
            self.assertEqual(self.results(job)["realizations"]["done"], 8)


if __name__ == "__main__":
    main({"Keeping": Keeping, "Repair": Repair})
