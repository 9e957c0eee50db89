"""A landslide like Yangbaodi: run-out at the paper's friction angle, and the angle that gives the paper's run-out."""

import math

import numpy as np

import figures as fig
import talus_runs
from experiment import table, within
from snapshots import Snapshots

TITLE = "Landslide like Yangbaodi"
SOURCE = "[Z20] section 3.2: run-out 140 m beyond the toe, phi = 28 deg. The profile is synthetic (the paper's is a figure), so this is no independent check"
REMARKS = ("The terrain beyond the toe was shaped so that the slide runs 140 m at 28 deg with the default numerics: the first two rows say that it still does, not that it "
           "must. What the profile did not decide is the energy line. Friction at the bed takes tan(phi) of the centre of mass's fall for each metre of its travel; what is "
           "sheared inside the slide, and what the bends of the bed add to the slide's weight, takes some more. (Less than 1 cannot be; the upper bound was set after a first look at 1.07 to 1.15.)")
TOE, RUNOUT = 102.0, 140.0


def measure(work, coarse):
    spacing = 1.0 if coarse else 0.5
    rows = []
    for phi in (24, 25, 26, 27, 28, 29):
        directory = work / f"yangbaodi-{phi}-{spacing:g}"
        result = talus_runs.run(talus_runs.CASES / "yangbaodi-like.json", directory,
                                {"particle_spacing_m": spacing, "time.fixed_step_s": 0.002 * spacing, "material.friction_angle_deg": phi})
        rows.append({"phi_deg": phi, "energy_line": energy_line(directory), "farthest_m": result["influence_zone_m"] - TOE, "connected_m": result["front_connected_m"] - TOE,
                     "mass_999_m": result["front_mass_999_m"] - TOE, "ending": result["ending"]})
    return {"spacing_m": spacing, "rows": rows}


def energy_line(directory):
    """Fall of the centre of mass over its travel: sliding on a bed with friction alone, tan(phi)."""
    snapshots = Snapshots(directory)
    x, y = snapshots.position(-1).mean(axis=0) - snapshots.position(0).mean(axis=0)
    return float(-y / x)


def angle_for(rows):
    """Friction angle of the paper's run-out by interpolation [deg]."""
    order = sorted(rows, key=lambda r: r["connected_m"])
    return float(np.interp(RUNOUT, [r["connected_m"] for r in order], [r["phi_deg"] for r in order]))


def criteria(numbers):
    at_28 = next(r for r in numbers["rows"] if r["phi_deg"] == 28)
    lines = [r["energy_line"] / math.tan(math.radians(r["phi_deg"])) for r in numbers["rows"]]
    return [within("run-out beyond the toe at 28 deg, connected body [m]", at_28["connected_m"], 0.9 * RUNOUT, 1.1 * RUNOUT),
            within("friction angle for 140 m [deg]", angle_for(numbers["rows"]), 27, 29),
            within("energy line of the centre of mass over tan(phi), lowest", min(lines), 1.0, 1.25),
            within("energy line of the centre of mass over tan(phi), highest", max(lines), 1.0, 1.25)]


def section(numbers, directory):
    figure, axes = fig.plt.subplots(figsize=(4.5, 3))
    for key, name in (("farthest_m", "farthest particle"), ("connected_m", "connected body"), ("mass_999_m", "99.9 % of the mass")):
        axes.plot([r["phi_deg"] for r in numbers["rows"]], [r[key] for r in numbers["rows"]], "o-", label=name)
    axes.axhline(RUNOUT, color="k", ls=":")
    axes.set(xlabel="friction angle [deg]", ylabel="run-out beyond the toe [m]")
    axes.legend()
    rows = [[r["phi_deg"], r["farthest_m"], r["connected_m"], r["mass_999_m"], r["energy_line"],
             math.tan(math.radians(r["phi_deg"]))] for r in numbers["rows"]]
    return f"Spacing {numbers['spacing_m']:g} m. The connected body reaches 140 m at phi = {angle_for(numbers['rows']):.1f} deg.\n\n" + \
        table(["phi [deg]", "farthest particle [m]", "connected body [m]", "99.9 % of the mass [m]", "energy line of the centre of mass", "tan(phi)"], rows) + "\n" + fig.save(figure, directory, "yangbaodi")
