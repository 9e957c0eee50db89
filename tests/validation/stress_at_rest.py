"""Stress at rest: water in a tank, soil between smooth walls, and the middle of a soil layer on an incline, against the weight above."""

import math

import numpy as np

import incline
import talus_runs
from experiment import at_most, table
from snapshots import Snapshots

TITLE = "Stress at rest"
SOURCE = "equilibrium: on a plane of theta the stress across it is rho g d cos(theta) and the shear stress rho g d sin(theta) at the depth d below the surface, measured across the layer; water has p = rho g d"
NOT_MET = {"water, dx = 0.1 m: load": 0.015, "incline, dx = 0.1 m: rms error of the stress across": 0.08, "incline, dx = 0.1 m: rms error of the shear": 0.04, "incline, dx = 0.1 m: load": 0.03}
REMARKS = ("The soil between smooth walls does not sway, and its stress is that of the weight within a hundredth. On the "
           "incline it takes the layer some seconds to come to rest, in which its shear waves are hardly damped; what the "
           "elastic law keeps of them alternates from row to row, grows with the shear modulus (3 % with 0.1 rho c^2, 8 % "
           "with the default of 0.3) and falls with the spacing (8 % with 10 rows, 5 % with 20). The load "
           "is that of the lowest row with the weight below its particles added; its error does not fall with the spacing.")
DEPTH, SECONDS = 1.0, 5.0  # [m], [s]
TIMES = [0.1 * k for k in range(30, 50)]  # over which stresses are averaged: elastic soil sways for a while [s]
THETA, PHI = 15.0, 30.0  # of the layer on an incline [deg]
LENGTH = 24.0  # of that layer [m]
WATER, SOIL = ({"density_kg_m3": 1000, "friction_angle_deg": 0, "cohesion_Pa": 0, "viscosity_Pa_s": 0.001}, {"density_kg_m3": 2000, "friction_angle_deg": PHI, "cohesion_Pa": 0, "viscosity_Pa_s": 0})


def box(material, spacing):
    return {"title": "Level layer between smooth walls", "particle_spacing_m": spacing,
            "terrain": {"bed_m": [[0, 0], [2, 0]], "left_end": "wall", "right_end": "wall"},
            "slide": {"outlines": [{"outline_m": [[0, 0], [2, 0], [2, DEPTH], [0, DEPTH]]}]},
            "material": material, "walls": {"slip": "free_slip"}, "time": {"end_s": SECONDS, "snapshot_times_s": TIMES}, "study": {"realizations": 1}}


def layer(spacing):
    case = incline.case("Layer on an incline", THETA, [(0, 0), (LENGTH, 0), (LENGTH, DEPTH), (0, DEPTH)], spacing, SECONDS, PHI, 10 * math.sqrt(2 * incline.GRAVITY * DEPTH))
    case["time"]["snapshot_times_s"] = TIMES
    return case


def measure(work, coarse):
    jobs = [(name, dx) for name in ("water", "soil", "incline") for dx in ((0.1,) if coarse else (0.1, 0.05, 0.025))]
    return {"layers": talus_runs.in_parallel(lambda job: rest(work, *job), jobs)}


def rest(work, name, spacing):
    """Errors of the mean stress over TIMES, over the stress at the bottom: root mean square in the middle half, and of the bed's load."""
    case = layer(spacing) if name == "incline" else box({"water": WATER, "soil": SOIL}[name], spacing)
    theta, length = (THETA, LENGTH) if name == "incline" else (0.0, 2.0)
    directory = work / "stress_at_rest" / f"{name}-{spacing:g}"
    talus_runs.run(case, directory, threads=1)
    snapshots, (down, up) = Snapshots(directory), incline.slope(theta)
    last = range(1, len(snapshots.times))
    position, stress = (np.mean([read(step) for step in last], axis=0) for read in (snapshots.position, lambda step: snapshots.field("stress", step)))
    middle = np.abs(snapshots.position(0) @ down - 0.5 * length) < 0.25 * length
    height, weight = position[middle] @ up, case["material"]["density_kg_m3"] * incline.GRAVITY
    across, shear = (component[middle] for component in (normal_stress(stress, up), shear_stress(stress, down, up)))
    bottom = weight * DEPTH
    due = {"across": weight * (DEPTH - height) * math.cos(math.radians(theta)), "shear": weight * (DEPTH - height) * math.sin(math.radians(theta))}
    lowest = height < spacing
    load = across[lowest] + weight * height[lowest] * math.cos(math.radians(theta))
    return {"layer": name, "spacing_m": spacing, "across": rms(across - due["across"]) / bottom, "shear": rms(shear - due["shear"]) / bottom,
            "load": float(load.mean()) / (bottom * math.cos(math.radians(theta))), "speed_m_s": float(np.linalg.norm(snapshots.field("velocity", -1), axis=1)[middle].max())}


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def normal_stress(stress, n):
    """Pressure across a plane of unit normal n; stress as (xx, yy, zz, xy, ...), positive in tension [Pa]."""
    return -(stress[:, 0] * n[0] ** 2 + stress[:, 1] * n[1] ** 2 + 2 * stress[:, 3] * n[0] * n[1])


def shear_stress(stress, t, n):
    """Along t on a plane of unit normal n, positive where the soil above is held back [Pa]."""
    return stress[:, 0] * t[0] * n[0] + stress[:, 1] * t[1] * n[1] + stress[:, 3] * (t[0] * n[1] + t[1] * n[0])


def criteria(numbers):
    found = []
    for l in numbers["layers"]:
        where = f"{l['layer']}, dx = {l['spacing_m']:g} m"
        found.append(at_most(f"{where}: rms error of the stress across the layer over that at the bottom", l["across"], 0.01))
        found.append(at_most(f"{where}: rms error of the shear stress over the same", l["shear"], 0.01))
        found.append(at_most(f"{where}: load on the bed over the weight, difference from 1", abs(l["load"] - 1), 0.01))
    return found


def section(numbers, directory):
    rows = [[l["layer"], l["spacing_m"], f"{100 * l['across']:.2f} %", f"{100 * l['shear']:.2f} %", f"{l['load']:.4f}", f"{1000 * l['speed_m_s']:.1f}"] for l in numbers["layers"]]
    return f"Layers {DEPTH:g} m deep, mean stress from {TIMES[0]:g} to {SECONDS:g} s; that on an incline of {THETA:g} degrees has phi = {PHI:g} degrees and lies on a rough bed.\n\n" + \
        table(["layer", "dx [m]", "stress across it, rms error", "shear stress, rms error", "load on the bed over the weight", "fastest particle [mm/s]"], rows)
