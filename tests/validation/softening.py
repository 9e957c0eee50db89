"""A slope that loses strength, at three spacings and by three ways to state how far; and a slump with the properties of Wyser et al. 2021."""

import math

import figures  # chooses the back end
import matplotlib.pyplot as plt
import numpy as np

import talus_runs
from experiment import at_most, table
from snapshots import Snapshots

TITLE = "Loss of strength"
SOURCE = ("no measurement: the run-out must not depend on the particle spacing. Slump: properties of Wyser, Alkhimenkov, Jaboyedoff & Podladchikov 2021, Geosci. Model Dev. 14, 7749-7774, "
          "doi:10.5194/gmd-14-7749-2021, slumping mechanics in section")
REMARKS = ("The slope fails as a whole: shear spreads over its thickness, and only in part does it run along bands. A width of the bands that goes with the spacing is then no better than a strain; both leave the run-out to the "
           "spacing. With a stated width it has no trend.\n\n"
           "The slump is a description, no comparison: we know of no published numbers of its shape, our geometry is a guess (a face of 51 degrees over the full height on a rough level bed), "
           "the cohesion is the same everywhere where the paper draws a field, and the weight acts at once.")
NOT_MET = {"displacement 0.4 m:": 0.5, "plastic": 0.3}

SPACINGS = (0.8, 0.4, 0.2)
WAYS = {"displacement 0.4 m": {"displacement_m": 0.4}, "displacement 0.4 m, bands of 1.6 m": {"displacement_m": 0.4, "band_width_m": 1.6},
        "plastic shear strain 0.25": {"plastic_shear_strain": 0.25}}
TOE = 21.325  # of the slope before it fails [m]
BED = [[0, 8.2], [14.202, 0], [60, 0]]


def slope(spacing, way):
    return {"title": f"Softening slope, {way}", "particle_spacing_m": spacing,
            "terrain": {"bed_m": BED, "left_end": "wall", "right_end": "open", "front_thickness_m": 1.2},
            "slide": {"outlines": [{"outline_m": [[0, 8.2], [14.202, 0], [21.325, 0], [9.125, 12.2], [0, 12.2]]}]},
            "material": {"density_kg_m3": 2200, "friction_angle_deg": 25, "cohesion_kPa": 10, "viscosity_Pa_s": 1500,
                         "softening": {"residual_friction_angle_deg": 15, "residual_cohesion_kPa": 0} | WAYS[way]},
            "time": {"end_s": 9}, "study": {"realizations": 1}}


FACE = 51  # [deg]
LENGTH, HEIGHT = 64.16, 12.8  # [m]
SLUMP_SPACING = 0.4


def slump(spacing):
    crest = LENGTH - 20 - HEIGHT / math.tan(math.radians(FACE))
    shear_modulus = 1e6 / (2 * (1 + 0.3))
    return {"title": "Slump", "particle_spacing_m": spacing, "terrain": {"bed_m": [[0, 0], [LENGTH, 0]], "left_end": "wall", "right_end": "wall", "wall_top_m": 15},
            "slide": {"outlines": [{"outline_m": [[0, 0], [LENGTH - 20, 0], [crest, HEIGHT], [0, HEIGHT]]}]},
            "material": {"density_kg_m3": 2700, "friction_angle_deg": 20, "cohesion_kPa": 20, "softening": {"residual_cohesion_kPa": 4, "plastic_shear_strain": 16 / 60}},
            "rheology": {"shear_modulus_Pa": shear_modulus}, "time": {"end_s": 7}, "study": {"realizations": 1}}


def measure(work, coarse):
    spacings = SPACINGS[:2] if coarse else SPACINGS
    jobs = [(way, spacing) for way in WAYS for spacing in spacings]

    def run(job):
        way, spacing = job
        result = talus_runs.run(slope(spacing, way), work / "softening" / f"{list(WAYS).index(way)}-{spacing}", threads=1)
        return {"way": way, "spacing_m": spacing, "front_m": result["front_mass_99_m"]}

    directory = work / "softening" / "slump"
    talus_runs.run(slump(2 * SLUMP_SPACING if coarse else SLUMP_SPACING), directory, threads=1)
    return {"slopes": talus_runs.in_parallel(run, jobs), "slump": shape(Snapshots(directory))}


def shape(snapshots):
    """Of the slump: what has moved by more than a metre, and how deep below the ground before."""
    last = len(snapshots.times) - 1
    start, moved = snapshots.position(0), np.hypot(*snapshots.field("displacement", last)[:, :2].T)
    slipped, end = start[moved > 1.0], snapshots.position(last)
    return {"share": float(np.mean(moved > 1.0)), "from_x_m": float(slipped[:, 0].min()), "deepest_m": float(HEIGHT - slipped[:, 1].min()), "farthest_m": float(moved.max()),
            "softened": float(np.mean(snapshots.field("cohesion_Pa", last) < 19e3)),
            "end": {"x_m": np.round(end[:, 0], 2).tolist(), "y_m": np.round(end[:, 1], 2).tolist(), "cohesion_kPa": np.round(snapshots.field("cohesion_Pa", last) / 1e3, 1).tolist()}}


def draw(end, directory):
    """Cohesion of the slump at its end, and its outline before."""
    crest = LENGTH - 20 - HEIGHT / math.tan(math.radians(FACE))
    figure, axes = plt.subplots(figsize=(9, 2.6), layout="constrained")
    dots = axes.scatter(end["x_m"], end["y_m"], s=3, c=end["cohesion_kPa"], cmap="viridis", linewidths=0)
    axes.plot([0, crest, LENGTH - 20], [HEIGHT, HEIGHT, 0], color="black", linewidth=0.8, label="ground before")
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axes.legend(loc="upper right")
    figure.colorbar(dots, label="cohesion [kPa]")
    return figures.save(figure, directory, "softening")


def fronts(numbers, way):
    return {s["spacing_m"]: s["front_m"] for s in numbers["slopes"] if s["way"] == way}


def criteria(numbers):
    found = []
    for way in WAYS:
        of = list(fronts(numbers, way).values())
        found.append(at_most(f"{way}: range of the 99 % front over the spacings, share of its travel", (max(of) - min(of)) / (max(of) - TOE), 0.1, "the aim; set after trials of these runs"))
    return found


def section(numbers, directory):
    spacings = sorted({s["spacing_m"] for s in numbers["slopes"]}, reverse=True)
    rows = [[way] + [f"{fronts(numbers, way)[s]:.2f}" for s in spacings] for way in WAYS]
    s = numbers["slump"]
    return ("Front of 99 % of the mass of a slope of 30 degrees, c = 10 -> 0 kPa, phi = 25 -> 15 degrees, 1,500 Pa s [m]:\n\n" + table(["strength is residual after a"] + [f"{x:g} m" for x in spacings], rows) +
            f"\nSlump: {100 * s['share']:.0f} % of the soil moved by more than 1 m, from x = {s['from_x_m']:.1f} m on and down to {s['deepest_m']:.1f} m below the former ground; "
            f"the farthest particle moved by {s['farthest_m']:.1f} m, and {100 * s['softened']:.0f} % of the soil lost more than 1 kPa of its cohesion. A curved surface runs from behind the crest to the toe; a block of the face that keeps its strength rides on the softened soil.\n\n" + draw(s["end"], directory))
