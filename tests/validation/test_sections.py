"""test_sections.py TALUS [--fine]: every section of data/sections at two spacings, its own and twice that.

--fine takes half of it and its own, which takes minutes. Each run must end at rest with a sound verdict and no particle
in the ground; the two fronts must agree.
"""

import argparse
import json
import os
import pathlib
import sys
import tempfile

import numpy as np

PENETRATION = 0.5  # depth below the bed, in spacings, that counts as inside the ground
FRONT_SPACINGS = 3.0  # largest difference of the fronts of 99 % of the particles, in coarse spacings
FRONT_SHARE = 0.1  # the same as a share of the run-out; the larger limit counts
MOVED = 2.0  # displacement of the centre of mass, in coarse spacings, below which a section shows nothing


def bed_of(path):
    """(vertices, 2) [m]: the bed as the case gives it."""
    return np.loadtxt(path.parent / json.loads(path.read_text())["terrain"]["bed_csv"], delimiter=",", skiprows=1)


def edges_above(bed, points):
    """How many edges of the bed lie above each point; an odd number means that the point is in the ground."""
    start, end = bed[:-1, None], bed[1:, None]
    spans = (start[..., 0] <= points[:, 0]) != (end[..., 0] <= points[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (points[:, 0] - start[..., 0]) / (end[..., 0] - start[..., 0])
        height = start[..., 1] + share * (end[..., 1] - start[..., 1])
    return np.count_nonzero(spans & (height > points[:, 1]), axis=0)


def distance(bed, point):
    """Distance from a point to the bed [m]."""
    start, along = bed[:-1], np.diff(bed, axis=0)
    share = np.clip(((point - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    return float(np.linalg.norm(start + share[:, None] * along - point, axis=1).min())


def penetration(bed, points):
    """Greatest depth of a particle in the ground [m]."""
    inside = points[edges_above(bed, points) % 2 == 1]
    return max((distance(bed, point) for point in inside), default=0.0)


def run(path, spacing, work):
    """result.json of a run and what its snapshots say; fronts [m] grow in the direction of sliding."""
    import talus_runs
    from snapshots import Snapshots

    directory = work / f"{path.stem}-{spacing:g}"
    result = talus_runs.run(path, directory, {"particle_spacing_m": spacing}, threads=1)
    snapshots = Snapshots(directory)
    first, last = snapshots.position(0), snapshots.position(-1)
    moved = last[:, 0].mean() - first[:, 0].mean()
    before, after = (np.sign(moved) * snapshot[:, 0] for snapshot in (first, last))
    return {"result": result, "spacing": spacing, "depth": penetration(bed_of(path), last), "moved": abs(moved),
            "front": np.quantile(after, 0.99), "run_out": np.quantile(after, 0.99) - np.quantile(before, 0.99)}


def faults_of_run(found):
    result, spacing = found["result"], found["spacing"]
    checks = {"not at rest": not result["at_rest"],
              f"verdict {result.get('quality')}": result.get("quality", {"verdict": "sound"})["verdict"] != "sound",
              f"penetrated {result['penetrated']}": result["penetrated"] != 0,
              f"a particle {found['depth']:.3g} m in the ground": found["depth"] > PENETRATION * spacing}
    return [f"{spacing:g} m: {what}" for what, failed in checks.items() if failed]


def faults_of_pair(coarse, fine):
    faults = []
    limit = max(FRONT_SPACINGS * coarse["spacing"], FRONT_SHARE * fine["run_out"])
    if abs(coarse["front"] - fine["front"]) > limit:
        faults.append(f"fronts {coarse['front']:.2f} m and {fine['front']:.2f} m differ by more than {limit:.2f} m")
    if fine["moved"] < MOVED * coarse["spacing"]:
        faults.append(f"the centre of mass moved by {fine['moved']:.3g} m only")
    return faults


def faults_of_section(path, work, fine):
    spacing = json.loads(path.read_text())["particle_spacing_m"]
    try:
        pair = [run(path, dx, work) for dx in ((spacing, spacing / 2) if fine else (2 * spacing, spacing))]
    except RuntimeError as failure:
        return [f"{path.stem}: {failure}"]
    for found in pair:
        soil = found["result"]["particles"]["soil"]
        print(f"{path.stem}: {found['spacing']:g} m, {soil} particles, front {found['front']:.2f} m", flush=True)
    faults = [fault for found in pair for fault in faults_of_run(found)] + faults_of_pair(*pair)
    return [f"{path.stem}: {fault}" for fault in faults]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("talus")
    parser.add_argument("--fine", action="store_true")
    arguments = parser.parse_args()
    os.environ["TALUS"] = arguments.talus
    paths = sorted((pathlib.Path(__file__).resolve().parent / "data" / "sections").glob("*.json"))
    with tempfile.TemporaryDirectory() as directory:
        faults = [fault for path in paths for fault in faults_of_section(path, pathlib.Path(directory), arguments.fine)]
    if faults or not paths:
        sys.exit("\n".join(faults) or "no section found")


main()
