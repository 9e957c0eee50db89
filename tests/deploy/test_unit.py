"""deploy/talusd.service: nothing to complain about, tight, and talusd and its workers run under its filter.

usage: test_unit.py TALUSD SOURCE_DIR
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import unittest

SOURCE = pathlib.Path(sys.argv[2])
sys.path.insert(0, str(SOURCE / "tests/service"))
import daemon  # noqa: E402

UNIT = SOURCE / "deploy/talusd.service"
FILTER = ["/usr/bin/python3", "-B", str(SOURCE / "tests/deploy/under_filter.py"), str(UNIT)]
MOST_EXPOSURE = 1.1  # systemd-analyze: 0 is sealed, 10 is open


def run(*command):
    return subprocess.run(command, capture_output=True, text=True)


class Unit(daemon.ServiceTest):
    def test_verify_says_nothing(self):
        unit = self.dir / "talusd.service"
        text = UNIT.read_text()
        self.assertIn("\nExecStart=talusd ", text)  # found in /usr/local/bin or /usr/bin
        unit.write_text(text.replace("ExecStart=talusd ", f"ExecStart={daemon.TALUSD} "))
        done = run("systemd-analyze", "verify", "--man=no", str(unit))
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))
        unit.write_text(unit.read_text().replace("LockPersonality=yes", "LockPersonality=maybe"))
        self.assertIn("maybe", run("systemd-analyze", "verify", "--man=no", str(unit)).stderr)

    def test_exposure(self):
        done = run("systemd-analyze", "security", "--offline=true", str(UNIT))
        score = float(re.search(r"Overall exposure level for talusd.service: ([\d.]+)", done.stdout)[1])
        self.assertLessEqual(score, MOST_EXPOSURE, done.stdout)

    def test_documented_drop_in(self):
        """What the unit's head shows for options of one's own is valid as it stands."""
        lines = re.findall(r"^#   (.*)$", UNIT.read_text(), re.M)
        self.assertEqual(lines[0], "[Service]")
        unit = self.dir / "talusd.service"
        shutil.copy(UNIT, unit)
        unit.write_text(unit.read_text().replace("ExecStart=talusd ", f"ExecStart={daemon.TALUSD} "))
        (self.dir / "talusd.service.d").mkdir()
        (self.dir / "talusd.service.d/own.conf").write_text("\n".join(lines) + "\n")
        done = run("systemd-analyze", "verify", "--man=no", str(unit))
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))

    def test_a_study_under_the_filter(self):
        # python keeps its process id when it becomes talusd, so that signals arrive
        self.addCleanup(setattr, daemon, "TALUSD", daemon.TALUSD)
        wrapper = self.dir / "talusd"
        wrapper.write_text(f'#!/bin/sh\nexec {" ".join(FILTER)} {daemon.TALUSD} "$@"\n')
        wrapper.chmod(0o755)
        daemon.TALUSD = str(wrapper)
        talusd = self.start()
        self.assertIn("Seccomp:\t2", pathlib.Path(f"/proc/{talusd.process.pid}/status").read_text())
        job = talusd.submit(daemon.study(spacing=0.5, end=2.0))
        worker = self.a_worker(talusd)
        info = talusd.wait_for(job)
        self.assertEqual(info["status"], "successful", info)
        self.assertNotIn("unlimited", re.search("Max address space.*", worker)[0])
        self.assertEqual(re.search(r"nice (\d+)", worker)[1], "5")
        self.assertEqual(talusd.get(f"/jobs/{job}/histogram").status, 200)
        field = talusd.get(f"/jobs/{job}/realizations/2/field?format=svg")  # gnuplot too
        self.assertEqual((field.status, field.body[:5]), (200, b"<?xml"), field.body)
        self.assertEqual(talusd.stop(), 0)
        log = (self.dir / "talusd.log").read_text()
        self.assertNotIn("not permitted", log)

    def a_worker(self, talusd):
        """Limits and niceness of a run at work."""
        for _ in range(2000):
            for process in daemon.workers_of(talusd.data):
                try:
                    limits = pathlib.Path(f"/proc/{process}/limits").read_text()
                    nice = os.getpriority(os.PRIO_PROCESS, process)
                except OSError:  # it has ended
                    continue
                if nice:  # else it has only just begun
                    return f"{limits}nice {nice}"
            time.sleep(0.005)
        self.fail("no worker with a niceness was seen")

    def test_the_filter_bites(self):
        attempt = "import ctypes,os; c=ctypes.CDLL(None,use_errno=True); print(c.{}, os.strerror(ctypes.get_errno()))"
        for call in ("chroot(b'/')", "mount(None, None, None, 0, None)", "swapoff(b'/')"):
            done = run(*FILTER, "/usr/bin/python3", "-c", attempt.format(call))
            self.assertEqual(done.stdout, "-1 Operation not permitted\n", call + done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
