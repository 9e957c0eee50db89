#!/usr/bin/env python3
"""Whole runs over ground that is hard to hold soil off: a cliff, a ledge, a thin wall, a noisy survey.

usage: test_ground.py TALUS SOURCE_DIR
"""
import json
import random
import sys
import unittest

import h5py
import numpy as np

from cli import SOURCE, Directory, load, talus

TRIALS = SOURCE / "tests/solver/cli/trials"


def inside(positions, bed):
    """Which positions (n, 2) lie in the rock under an open bed (m, 2): an odd number of its segments lies above them."""
    start, end = bed[:-1, None], bed[1:, None]
    spans = (start[..., 0] <= positions[:, 0]) != (end[..., 0] <= positions[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        height = start[..., 1] + (positions[:, 0] - start[..., 0]) * (end[..., 1] - start[..., 1]) / (end[..., 0] - start[..., 0])
    return np.count_nonzero(spans & (height > positions[:, 1]), axis=0) % 2 == 1


class Ground(Directory):
    def run_case(self, case, *settings):
        """result.json of a run, in which no particle lies in the ground at any snapshot."""
        out = self.dir / str(len(list(self.dir.iterdir())))
        done = talus("run", case, *(word for s in settings for word in ("--set", s)), "--out", out, "--threads", 1)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = load(out / "result.json")
        self.assertEqual(result["penetrated"], 0)
        bed = np.array(load(out / "case.resolved.json")["terrain"]["bed_m"])
        with h5py.File(out / "snapshots.vtkhdf") as f:
            grid = f["VTKHDF"]
            positions = grid["Points"][:].reshape(len(grid["Steps/Values"]), -1, 3)[..., :2]
            soil = grid["PointData/is_wall"][:] == 0
        for at in positions:
            self.assertEqual(np.count_nonzero(inside(at[soil], bed)), 0)
        return result

    def without(self, name, **changes):
        """A trial with another bed."""
        case = load(TRIALS / name)
        case["terrain"].update(changes)
        path = self.dir / "changed.json"
        path.write_text(json.dumps(case))
        return path

    def test_a_cliff_at_any_spacing(self):
        for spacing in (1, 0.5, 0.25):
            self.run_case(TRIALS / "cliff.json", f"particle_spacing_m={spacing}", "time.snapshot_interval_s=0.5")

    def test_a_ledge_with_and_without_tension(self):
        for cutoff in ("true", "false"):
            self.run_case(TRIALS / "ledge.json", "particle_spacing_m=1", f"numerics.tension_cutoff={cutoff}")

    def test_a_wall_thinner_than_a_spacing_holds(self):
        wall = load(TRIALS / "thin-wall.json")["terrain"]["bed_m"]
        face = 50.0  # of a wall 0.3 m thick, at a spacing of 0.5 m
        self.assertLess(self.run_case(TRIALS / "thin-wall.json")["influence_zone_m"], face)
        free = self.run_case(self.without("thin-wall.json", bed_m=[v for v in wall if v[0] < face - 1 or v[0] > face + 1]))
        self.assertGreater(free["influence_zone_m"], face + 1)
        reasons = {reason["check"] for reason in free["quality"]["reasons"]}
        self.assertEqual(reasons, {"thin_flow"}, "2.5 particles thick, and no false alarm of the ground")
        fine = self.run_case(self.dir / "changed.json", "particle_spacing_m=0.25", "time.end_s=20")
        self.assertEqual(fine["quality"]["verdict"], "sound")
        self.assertAlmostEqual(fine["front_mass_99_m"], free["front_mass_99_m"], delta=1.0, msg="sheets that glide: 11 m")

    def test_the_noise_of_a_survey_does_not_move_the_front(self):
        """A plane that runs into a flat, 5,001 vertices, noise up to 0.2 spacings: the front of the smooth bed.

        Soil without a viscosity, at 19 m/s on such a bed, throws particles tens of metres ahead; those runs are doubtful.
        """
        fronts = []
        for noise in (0.0, 0.05, 0.1):
            draw = random.Random(7)
            bed = [[round(0.04 * i, 3), round(max(0.0, 40.0 - 0.02 * i) + draw.gauss(0.0, noise), 3)] for i in range(5001)]
            case = {"title": "noisy plane", "particle_spacing_m": 0.5, "terrain": {"bed_m": bed},
                    "slide": {"outlines": [{"outline_m": [[2, 39.6], [42, 19.6], [42, 24.1], [2, 44.1]]}]},
                    "material": {"density_kg_m3": 2000, "friction_angle_deg": 20, "viscosity_Pa_s": 1000},
                    "time": {"end_s": 10}}
            path = self.dir / f"noise-{noise}.json"
            path.write_text(json.dumps(case))
            fronts.append(self.front(path))
        self.assertLess(max(fronts) - min(fronts), 0.5)

    def front(self, case):
        done = talus("run", case, "--out", case.with_suffix(""), "--threads", 1, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)["influence_zone_m"]


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *(sys.argv[3:] or ["Ground"])], verbosity=2)
