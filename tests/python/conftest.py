"""The package of deploy/python and the programs of the build: $TALUS and $TALUSD name them."""

import json
import os
import pathlib
import re
import subprocess

import pytest

import talus

SOURCE = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def case():
    """A slope of some 70 particles: a run takes hundredths of a second."""
    document = json.loads((SOURCE / "tests/solver/cli/trials/small-slope.json").read_text())
    document["time"] = {"end_s": 1, "snapshot_times_s": [0.25, 0.5]}
    return document


@pytest.fixture(scope="session")
def study(case, tmp_path_factory):
    """Five realizations; nothing may change it."""
    return talus.study(case, tmp_path_factory.mktemp("study") / "five", realizations=5, workers=1, figures=False)


class Daemon:
    """A talusd on a port of its own."""

    def __init__(self, directory, *options):
        self.directory = directory
        self.log = open(directory / "talusd.log", "wb")
        self.process = subprocess.Popen(
            [
                os.environ["TALUSD"],
                "--data",
                str(directory / "data"),
                "--listen",
                "127.0.0.1:0",
                "--workers",
                "1",
                "--min-disk",
                "0",
                "--talus",
                os.environ["TALUS"],
                *map(str, options),
            ],
            stdout=subprocess.PIPE,
            stderr=self.log,
            text=True,
        )
        line = self.process.stdout.readline()
        found = re.search(r"listens on (http://127\.0\.0\.1:\d+)", line)
        assert found, f"talusd did not start: {line!r} {(directory / 'talusd.log').read_text()}"
        self.url = found[1]

    def stop(self):
        self.process.terminate()
        self.process.wait(60)
        self.process.stdout.close()
        self.log.close()


@pytest.fixture(scope="session")
def daemon(tmp_path_factory):
    started = Daemon(tmp_path_factory.mktemp("talusd"))
    yield started
    started.stop()
