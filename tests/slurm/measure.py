#!/usr/bin/env python3
"""What Slurm adds to short realizations: two simulated nodes of one core against two local workers, in turns.

usage: measure.py TALUSD SOURCE_DIR [REALIZATIONS [ROUNDS]]
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "service"))
from cluster import Cluster  # noqa: E402
from daemon import TALUS, case  # noqa: E402

realizations = int(sys.argv[3]) if len(sys.argv) > 3 else 200
rounds = int(sys.argv[4]) if len(sys.argv) > 4 else 3
directory = pathlib.Path(tempfile.mkdtemp(prefix="talus-slurm-"))
cluster = Cluster(directory / "cluster", 2)


def timed(name, *options):
    begin = time.monotonic()
    subprocess.run([TALUS, "study", directory / "case.json", "--out", directory / name, "--realizations", str(realizations), "--seed", "1",
                    "--no-figures", "--set", "study.noise_floor_replicates=0", *options], check=True, capture_output=True,
                   env=cluster.environment)
    seconds = time.monotonic() - begin
    runs = [json.loads(p.read_text())["wall_clock_s"] for p in (directory / name / "runs").glob("*.json")]
    shutil.rmtree(directory / name)
    return seconds, sum(runs)


try:
    cluster.start()
    (directory / "case.json").write_text(json.dumps(case(spacing=1.0, end=0.5)))
    (directory / "slurm.json").write_text("{}")
    for _ in range(rounds):
        local, local_runs = timed("local", "--workers", "2")
        slurm, slurm_runs = timed("slurm", "--executor", "slurm", "--slurm", directory / "slurm.json")
        print(f"{realizations} realizations: local {local:.1f} s (runs alone {local_runs:.1f} core-s), Slurm {slurm:.1f} s ({slurm_runs:.1f} core-s), "
              f"{1000 * (slurm - local) / realizations:.0f} ms more a realization", flush=True)
finally:
    cluster.stop()
    shutil.rmtree(directory, ignore_errors=True)
