"""A landslide like Yangbaodi: run-out at the paper's friction angle, and the angle that gives the paper's run-out."""

import json
import math

import numpy as np

import figures as fig
import talus_runs
from experiment import table, within
from snapshots import Snapshots

TITLE = "Yangbaodi-type landslide"
SOURCE = "[Z20] section 3.2: run-out 140 m beyond the toe, phi = 28 deg. The profile is synthetic (the paper's is a figure), so this is no independent check"
REMARKS = ("The terrain beyond the toe was shaped so that the slide runs 140 m at 28 deg with the default numerics: "
           "the first row of criteria shows that it still does, not that it must. The front is insensitive to the "
           "friction angle here: it stops on the rising ground beyond the toe, within a few spacings of 140 m for a "
           "range of angles. The energy line does not follow from the shape of the profile. Friction at the bed "
           "dissipates tan(phi) of the fall of the centre of mass per metre of travel, and more at a bend, which "
           "adds to the weight of the slide. The lower bound is a block that slides from the slide's centre and "
           "loses the factor exp(-2 tan(phi) d theta) of its energy at each bend. Shear inside the slide dissipates "
           "more; the allowance of 0.12 tan(phi) for it was set after the runs, as a check for changes. A yield "
           "stress 5 % higher or lower leaves the band. (Above 30 deg, the slope of the last stretch below the "
           "slide, part of the slide stays behind, and the energy line of the common centre of mass no longer falls "
           "below tan(phi).) This case also fixes the time step, and is run at one spacing.")
TOE, RUNOUT = 102.0, 140.0
ANGLES, FEW_ANGLES = (24, 25, 26, 27, 28, 29, 30, 31, 33), (24, 26, 28, 29, 31)  # [deg]
FLATTEST = 30.0  # stretch of the bed below the slide: steeper friction holds soil on it, and the slide no longer goes as one [deg]
INSIDE = 0.12  # what shear inside the slide may add to the energy line over tan(phi)


def measure(work, coarse):
    spacing = 1.0 if coarse else 0.5
    rows = []
    for phi in FEW_ANGLES if coarse else ANGLES:
        directory = work / f"yangbaodi-{phi}-{spacing:g}"
        result = talus_runs.run(talus_runs.CASES / "yangbaodi-like.json", directory,
                                {"particle_spacing_m": spacing, "time.fixed_step_s": 0.002 * spacing, "material.friction_angle_deg": phi})
        rows.append({"phi_deg": phi, "energy_line": energy_line(directory), "block": block_line(directory, phi), "farthest_m": result["influence_zone_m"] - TOE, "connected_m": result["front_connected_m"] - TOE,
                     "mass_999_m": result["front_mass_999_m"] - TOE, "ending": result["ending"]})
    return {"spacing_m": spacing, "rows": rows}


def energy_line(directory):
    """Fall of the centre of mass over its travel: sliding on a bed with friction alone, tan(phi)."""
    snapshots = Snapshots(directory)
    x, y = snapshots.position(-1).mean(axis=0) - snapshots.position(0).mean(axis=0)
    return float(-y / x)


def block_line(directory, phi):
    """Energy line of a block that starts below the slide's centre of mass and keeps to the bed: closed form on every straight stretch, a loss at every concave bend."""
    bed = np.array(json.loads((directory / "case.resolved.json").read_text())["terrain"]["bed_m"], dtype=float)
    mu, start = math.tan(math.radians(phi)), float(Snapshots(directory).position(0)[:, 0].mean())
    y = float(np.interp(start, *bed.T))
    points = [(start, y), *(tuple(p) for p in bed if p[0] > start)]
    energy, before = 0.0, None  # v^2/(2 g) [m]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        slope = math.atan2(y0 - y1, x1 - x0)
        if before is not None and slope < before:
            energy *= math.exp(-2 * mu * (before - slope))
        gain = (y0 - y1) - mu * (x1 - x0)
        if energy + gain <= 0:
            share = energy / -gain
            x, low = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
            return (y - low) / (x - start)
        energy, before = energy + gain, slope
    return math.nan


def angles_within(rows, distance):
    """Angles at which the connected body ends within so much of the paper's run-out [deg]."""
    return [r["phi_deg"] for r in rows if abs(r["connected_m"] - RUNOUT) <= distance]


def over_friction(row, key):
    return row[key] / math.tan(math.radians(row["phi_deg"]))


def criteria(numbers):
    at_28 = next(r for r in numbers["rows"] if r["phi_deg"] == 28)
    excess = [over_friction(r, "energy_line") - over_friction(r, "block") for r in numbers["rows"] if r["phi_deg"] < FLATTEST]
    return [within("run-out beyond the toe at 28 deg, connected body [m]", at_28["connected_m"], 0.9 * RUNOUT, 1.1 * RUNOUT, "[Z20]; the profile was shaped to it"),
            within("energy line of the centre of mass less a block's, over tan(phi), 24 to 29 deg, lowest", min(excess), 0.0, INSIDE, "a block with bends; allowance for inner shear"),
            within("energy line of the centre of mass less a block's, over tan(phi), 24 to 29 deg, highest", max(excess), 0.0, INSIDE, "a block with bends; allowance for inner shear")]


def section(numbers, directory):
    figure, axes = fig.plt.subplots(figsize=(4.5, 3))
    for key, name in (("farthest_m", "farthest particle"), ("connected_m", "connected body"), ("mass_999_m", "99.9 % of the mass")):
        axes.plot([r["phi_deg"] for r in numbers["rows"]], [r[key] for r in numbers["rows"]], "o-", label=name)
    axes.axhline(RUNOUT, color="k", ls=":")
    axes.set(xlabel="friction angle [deg]", ylabel="run-out beyond the toe [m]")
    axes.legend()
    rows = [[f"{r['phi_deg']}", *(f"{r[key]:.1f}" for key in ("farthest_m", "connected_m", "mass_999_m")), over_friction(r, "energy_line"), over_friction(r, "block")] for r in numbers["rows"]]
    near = angles_within(numbers["rows"], 2 * numbers["spacing_m"])
    said = f"{min(near)} to {max(near)} deg" if near else "none of the angles"
    return f"Spacing {numbers['spacing_m']:g} m. The connected body ends within two spacings of 140 m at {said}.\n\n" + \
        table(["phi [deg]", "farthest particle [m]", "connected body [m]", "99.9 % of the mass [m]", "energy line of the centre of mass / tan(phi)", "of a block"], rows) + "\n" + \
        fig.save(figure, directory, "yangbaodi")
