"""Slabs of one to ten rows of particles on planes steeper than the friction angle: friction against tan(phi)."""

import math
from typing import NamedTuple

import numpy as np

import incline
import talus_runs
from experiment import at_most, table
from snapshots import Snapshots

TITLE = "Sliding slabs"
SOURCE = "closed form: the middle of a long slab accelerates by g (sin(theta) - cos(theta) tan(phi)), whatever its thickness, and goes half of that times t^2"
REMARKS = ("The measured acceleration is that of the second half of the time: at first the slab falls almost freely, until "
           "its elastic shear stress has reached the yield limit. Its distance therefore exceeds the closed form, by less "
           "the longer it slides.")
NOT_MET = {"steep, 1 row:": 0.08, "steep, 2 rows:": 0.05, "gentle, 3 rows: friction": 0.95, "gentle, 3 rows: distance": 0.65}


class Plane(NamedTuple):
    theta: float  # [deg]
    phi: float  # [deg]
    spacing: float  # [m]
    seconds: float
    sound_speed: float  # [m/s]


PLANES = {"steep": Plane(30, 25, 0.5, 1, 60), "gentle": Plane(10, 5, 0.5, 10, 100)}


def slab(plane, rows):
    """Case and length [m]: so long that what its ends do does not reach its middle."""
    height = rows * plane.spacing
    length = max(60, 12 * rows) * plane.spacing + 3 * math.sqrt(incline.GRAVITY * height) * plane.seconds
    outline = [(0, 0), (length, 0), (length, height), (0, height)]
    return incline.case(f"Slab of {rows} rows at {plane.theta:g} degrees", plane.theta, outline, plane.spacing, plane.seconds, plane.phi, plane.sound_speed), length


def measure(work, coarse):
    thicknesses = {"steep": (1, 2, 5), "gentle": (3,)} if coarse else {name: (1, 2, 3, 5, 10) for name in PLANES}
    jobs = [(name, rows) for name in PLANES for rows in thicknesses[name]]
    return {"slabs": talus_runs.in_parallel(lambda job: slide(work, *job), jobs)}


def slide(work, name, rows):
    plane = PLANES[name]
    case, length = slab(plane, rows)
    directory = work / "sliding_slab" / f"{name}-{rows}"
    talus_runs.run(case, directory, threads=1)
    snapshots = Snapshots(directory)
    start = snapshots.position(0) @ incline.slope(plane.theta)[0]
    found, distance = incline.motion(snapshots, plane.theta, np.abs(start - 0.5 * length) < 0.1 * length)
    return {"plane": name, "rows": rows, "friction": incline.friction(plane.theta, found) / math.tan(math.radians(plane.phi)),
            "distance_m": distance, "distance": distance / (0.5 * incline.acceleration(plane.theta, plane.phi) * plane.seconds**2)}


def where(found):
    return f"{found['plane']}, {found['rows']} row{'s' if found['rows'] > 1 else ''}"


def criteria(numbers):
    found = []
    for s in numbers["slabs"]:
        found.append(at_most(f"{where(s)}: friction over tan(phi), difference from 1", abs(s["friction"] - 1), 0.03))
        if s["plane"] == "gentle":
            found.append(at_most(f"{where(s)}: distance over the closed form's, difference from 1", abs(s["distance"] - 1), 0.05))
    return found


def section(numbers, directory):
    text = "".join(f"{name}: {p.theta:g} degrees, phi = {p.phi:g} degrees, {p.seconds:g} s, closed form {0.5 * incline.acceleration(p.theta, p.phi) * p.seconds**2:.2f} m. " for name, p in PLANES.items())
    return f"{text}Spacing {PLANES['steep'].spacing:g} m, no viscosity.\n\n" + \
        table(["plane", "rows", "friction over tan(phi)", "distance [m]", "distance over the closed form's"], [[s["plane"], s["rows"], f"{s['friction']:.3f}", f"{s['distance_m']:.3f}", f"{s['distance']:.3f}"] for s in numbers["slabs"]])
