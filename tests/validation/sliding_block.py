"""A block of strong soil on a smoother wall: it rests on planes flatter than the wall's friction angle and slides as a body on steeper ones."""

import math

import numpy as np

import incline
import talus_runs
from experiment import at_most, table
from snapshots import Snapshots

TITLE = "Block on an incline"
SOURCE = "closed form: on a wall of friction angle phi a block accelerates by g (sin(theta) - cos(theta) tan(phi)) if theta > phi and rests otherwise"
NOT_MET = {"slides at": 0.2}
REMARKS = ("The soil of the block is stronger than the wall, and the middle of the block is measured, so that what its faces "
           "do has no part in it. The wall's friction is less than stated: soil within 1.1 smoothing lengths of the wall "
           "yields at the wall's angle, and the wall continues its shear stress as a constant. On a wall without slip "
           "the same soil with the wall's angle shows 0.98 to 0.99 of it. The artificial viscosity of the whole velocity "
           "jump hides the deficit by resisting the slip.")
SOIL_PHI, WALL_PHI = 45.0, 20.0  # [deg]
HEIGHT, LENGTH = 1.0, 26.0  # [m]
STEEP, FLAT = (23, 26, 30), (10, 15)  # planes [deg]
SECONDS = 2.0


def measure(work, coarse):
    spacings, angles = ((0.1,), (15, 26)) if coarse else ((0.2, 0.1, 0.05), FLAT + STEEP)
    return {"blocks": talus_runs.in_parallel(lambda job: slide(work, *job), [(theta, dx) for theta in angles for dx in spacings])}


def slide(work, theta, spacing):
    case = incline.case(f"Block at {theta:g} degrees", theta, [(0, 0), (LENGTH, 0), (LENGTH, HEIGHT), (0, HEIGHT)], spacing, SECONDS, SOIL_PHI, 30)
    directory = work / "sliding_block" / f"{theta:g}-{spacing:g}"
    talus_runs.run({**case, "walls": {"slip": "friction", "friction_angle_deg": WALL_PHI}}, directory, threads=1)
    snapshots, down = Snapshots(directory), incline.slope(theta)[0]
    middle = np.abs(snapshots.position(0) @ down - 0.5 * LENGTH) < 0.15 * LENGTH
    found, distance = incline.motion(snapshots, theta, middle)
    late = (snapshots.position(2) - snapshots.position(1)) @ down
    return {"theta": theta, "spacing_m": spacing, "friction": incline.friction(theta, found) / math.tan(math.radians(WALL_PHI)), "distance_m": distance, "late_m": abs(float(late[middle].mean()))}


def slides(block):
    return block["theta"] > WALL_PHI


def criteria(numbers):
    found = []
    for b in numbers["blocks"]:
        where = f"{b['theta']:g} degrees, dx = {b['spacing_m']:g} m"
        if slides(b):
            found.append(at_most(f"slides at {where}: friction over the wall's tan(phi), difference from 1", abs(b["friction"] - 1), 0.03))
        else:
            found.append(at_most(f"rests at {where}: mean distance in the second half of {SECONDS:g} s, in spacings", b["late_m"] / b["spacing_m"], 0.2))
    return found


def section(numbers, directory):
    rows = [[b["theta"], b["spacing_m"], f"{b['friction']:.3f}" if slides(b) else "", f"{b['distance_m']:.4f}", f"{b['late_m']:.4f}"] for b in numbers["blocks"]]
    return f"Wall of {WALL_PHI:g} degrees, soil of {SOIL_PHI:g} degrees, block {LENGTH:g} m long and {HEIGHT:g} m high, no viscosity.\n\n" + \
        table(["plane [deg]", "dx [m]", "friction over the wall's tan(phi)", f"distance in {SECONDS:g} s [m]", "of it in the second half [m]"], rows)
