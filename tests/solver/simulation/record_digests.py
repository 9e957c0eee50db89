#!/usr/bin/env python3
"""Records what test_recorded_digests.cpp compares with: the digest of many short runs, made by a given program.

usage: record_digests.py TALUS > recorded_digests.json

Run it only when results are meant to change, with a program whose results are trusted, on a processor with AVX2.
"""
import concurrent.futures
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

BED = [[0, 8.2], [14.202, 0], [60, 0]]
CASE = {
    "title": "A slope of 0.4 m particles, in two layers of different soil",
    "particle_spacing_m": 0.4,
    "particle_placement": "whole_cells",
    "terrain": {"bed_m": BED, "left_end": "wall", "right_end": "open"},
    "slide": {
        "outlines": [
            {"outline_m": [[0, 8.2], [14.202, 0], [21.325, 0], [13.125, 8.2]]},
            {
                "outline_m": [[0, 8.2], [13.125, 8.2], [9.125, 12.2], [0, 12.2]],
                "material": {
                    "density_kg_m3": 1900,
                    "friction_angle_deg": 31,
                    "cohesion_Pa": 2000,
                    "viscosity_Pa_s": 150,
                },
            },
        ]
    },
    "material": {"density_kg_m3": 2200, "friction_angle_deg": 25, "viscosity_Pa_s": 50},
    "time": {"end_s": 0.12},
}
ONE_SOIL = {"slide.outlines": [{"outline_m": [[0, 8.2], [14.202, 0], [21.325, 0], [9.125, 12.2], [0, 12.2]]}]}
FIELD = {"random_field": {"correlation_length_m": 2, "log_mean": -0.7629, "log_stdev": 0.2289, "terms": 5}}

CHOICES = {
    "rheology.yield": ["elastic", "regularized"],
    "numerics.kernel": ["wendland_c2", "cubic_spline"],
    "numerics.integrator": ["rk2", "leapfrog"],
    "numerics.density_filter": ["delta_sph", "shepard", "none"],
    "walls.slip": ["no_slip", "friction", "free_slip"],
    "walls.contact": ["always", "approaching"],
}


def combinations(choices, **fixed):
    for values in itertools.product(*choices.values()):
        keys = dict(zip(choices, values), **fixed)
        if keys.get("walls.slip") == "friction":
            keys["walls.friction_angle_deg"] = 15
        if keys.get("numerics.density_filter") == "shepard":
            keys["numerics.filter_interval_steps"] = 7
        yield keys


def rows():
    # Every choice with every other.
    yield from combinations(CHOICES)
    # The plain loops in double precision.
    some = {k: v[:2] for k, v in CHOICES.items() if k != "walls.contact"}
    for keys in combinations(some):
        yield keys | {"numerics.precision": "double", "time.end_s": 0.02}
    # The mass form of the continuity equation, in both precisions.
    mass = {"numerics.continuity": "mass"}
    for keys in combinations({k: CHOICES[k][:2] for k in ("rheology.yield", "numerics.density_filter", "walls.contact")}):
        yield keys | mass
    for yield_ in CHOICES["rheology.yield"]:
        yield mass | {"rheology.yield": yield_, "numerics.precision": "double", "time.end_s": 0.02}
    # The paper's shear rate, no cut-off of tension, other walls, lattice and start.
    for yield_ in CHOICES["rheology.yield"]:
        law = {"rheology.yield": yield_}
        yield law | {"rheology.shear_rate": "paper"}
        yield law | {"numerics.tension_cutoff": False}
        yield law | {"numerics.initial_pressure": "stress_free", "numerics.artificial_viscosity_beta": 0.5}
        yield law | {"particle_placement": "nodes", "walls.max_velocity_ratio": 3, "walls.layers": 4}
        yield law | ONE_SOIL | {"time.fixed_step_s": 0.001}
        yield law | {"time.max_step_s": 0.0005, "time.end_s": 0.05}
        # Particles of unequal mass.
        yield law | {"particle_placement": "cells"}
        yield law | {"particle_placement": "cells", "numerics.precision": "double", "time.end_s": 0.02}
        yield law | ONE_SOIL | {"particle_placement": "cells", "numerics.integrator": "leapfrog"}
    # Long enough to be sorted again, to come to rest, and to leave the terrain through an open end.
    for integrator in CHOICES["numerics.integrator"]:
        moving = {"numerics.integrator": integrator}
        yield moving | {"time.end_s": 1.5, "walls.slip": "free_slip"}
        yield moving | ONE_SOIL | {"time.end_s": 2.5, "terrain.bed_m": BED[:2] + [[22, 0]]}
        yield moving | ONE_SOIL | {"time.end_s": 1, "terrain.left_end": "open", "terrain.right_end": "wall"}
        yield moving | {
            "numerics.precision": "double",
            "terrain.bed_m": BED[:2] + [[21.4, 0]],
            "time.end_s": 0.8,
            "particle_spacing_m": 0.6,
        }
    yield {"time.end_s": 3, "time.stop_at_rest": {"speed_m_s": 2.5, "hold_s": 0.1}}
    # A random field and a closed bed.
    yield FIELD | {"study.seed": 5}
    yield {
        "terrain": {"closed": True, "bed_m": [[0, 0], [4, 0], [6, 3], [3, 6], [-1, 4]]},
        "slide.outlines": [{"outline_m": [[0.5, 0.5], [3.5, 0.5], [4, 2.5], [0.5, 2.5]]}],
        "particle_spacing_m": 0.15,
    }


def record(talus, case, keys):
    with tempfile.TemporaryDirectory() as directory:
        arguments = [f"--set={key}={json.dumps(value)}" for key, value in keys.items()]
        done = subprocess.run(
            [talus, "run", case, "--out", f"{directory}/run", "--threads", "1", "--study-worker", *arguments],
            capture_output=True,
            text=True,
        )
        if done.returncode != 0:
            raise SystemExit(f"{keys}: {done.stderr}")
        result = json.loads(pathlib.Path(directory, "run/result.json").read_text())
        return {"set": keys, "steps": result["steps"], "left": result["left_domain"], "digest": result["digest"]}


def main(talus):
    with tempfile.TemporaryDirectory() as directory, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        case = pathlib.Path(directory, "case.json")
        case.write_text(json.dumps(CASE))
        runs = list(pool.map(lambda keys: record(talus, case, keys), rows()))
    lines = ",\n".join("    " + json.dumps(run) for run in runs)
    print(f'{{\n  "case": {json.dumps(CASE)},\n  "runs": [\n{lines}\n  ]\n}}')


if __name__ == "__main__":
    main(*sys.argv[1:])
