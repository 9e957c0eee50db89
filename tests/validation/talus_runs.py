"""Runs of the talus program for the experiments: one directory a run, never run twice, safe to kill and repeat."""

import concurrent.futures
import csv
import json
import os
import pathlib
import subprocess

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
CASES = REPOSITORY / "solver" / "cases"
TALUS = os.environ.get("TALUS", str(REPOSITORY / "build" / "release" / "bin" / "talus"))


class RunFailed(RuntimeError):
    """talus ended with an exit code other than 0; the message ends with its stderr."""


def override(settings):
    """["--set", "key=value", ...] of {"key": value}; values are written as JSON."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value if isinstance(value, str) else json.dumps(value)}")]


def case_file(case, directory):
    """Path of `case`: a path stays one, a dictionary is written to directory.json."""
    if not isinstance(case, dict):
        return pathlib.Path(case)
    directory.parent.mkdir(parents=True, exist_ok=True)
    path = directory.parent / (directory.name + ".json")
    path.write_text(json.dumps(case, indent=1) + "\n")
    return path


def call(arguments):
    done = subprocess.run([TALUS, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RunFailed(f"talus {' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr[-2000:]}")
    return done.stdout


def run(case, directory, settings=None, threads=None, extra=()):
    """result.json of one run as a dictionary; a finished one is read, an interrupted one is continued."""
    directory = pathlib.Path(directory)
    arguments = ["run", case_file(case, directory), "--out", directory, "--json", *override(settings or {}), *extra]
    if threads:
        arguments += ["--threads", threads]
    if (directory / "talus-output.json").exists():
        arguments.append("--resume")
    return json.loads(call(arguments))


def study(case, directory, realizations, settings=None, workers=os.cpu_count(), seed=1, first=0):
    """study.json of a study of at least so many realizations, from number `first` on; those that are there already are kept."""
    directory = pathlib.Path(directory)
    call(["study", case_file(case, directory), "--out", directory, "--realizations", realizations, "--seed", seed, "--workers", workers,
          "--threads", 1, "--no-figures", *(["--range", first, realizations - 1] if first else []), *override(settings or {})])
    return json.loads((directory / "study.json").read_text())


def in_parallel(function, jobs):
    """[function(job), ...] with as many at a time as there are processors; for functions that wait for talus."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(function, jobs))


def history(directory):
    """Columns of history.csv by name, as lists of floats."""
    with open(pathlib.Path(directory) / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}
