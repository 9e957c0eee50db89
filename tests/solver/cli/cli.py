"""How the tests call the command line; sys.argv is TALUS SOURCE_DIR ..."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import jsonschema

TALUS, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SLOPE = SOURCE / "solver/cases/illustrative.json"
COARSE = ["--set", "particle_spacing_m=0.8", "--set", "time.end_s=3", "--set", "time.snapshot_times_s=[1,2]"]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OMP_WAIT_POLICY="passive")


def talus(*arguments, **options):
    return subprocess.run(
        [TALUS, *map(str, arguments)], capture_output=True, text=True, env=ENVIRONMENT, timeout=280, **options
    )


def start(*arguments):
    return subprocess.Popen(
        [TALUS, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT
    )


def wait_for(condition, process, what, seconds=120):
    deadline = time.monotonic() + seconds
    while not condition():
        if process.poll() is not None:
            raise AssertionError(f"ended with {process.returncode} before {what}: {process.stderr.read()}")
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {seconds} s for {what}")
        time.sleep(0.02)


def load(path):
    return json.loads(pathlib.Path(path).read_text())


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def check_schema(name, document):
    jsonschema.Draft7Validator(load(SOURCE / f"schemas/{name}.schema.json")).validate(document)


class Directory(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="talus-cli-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def case(self, **changes):
        """The coarse slope as a file with top-level members replaced."""
        document = load(SLOPE)
        document.update(particle_spacing_m=0.8)
        document["time"] = {"end_s": 3}
        document.update(changes)
        path = self.dir / "case.json"
        path.write_text(json.dumps(document))
        return path

    def run_ok(self, out, *arguments):
        done = talus("run", SLOPE, *COARSE, "--out", self.dir / out, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return load(self.dir / out / "result.json")
