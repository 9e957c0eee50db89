"""A landslide like Yangbaodi: run-out at the paper's friction angle, and the angle that gives the paper's run-out."""

import numpy as np

import figures as fig
import talus_runs
from experiment import table, within

TITLE = "Landslide like Yangbaodi"
SOURCE = "[Z20] section 3.2: run-out 140 m beyond the toe, phi = 28 deg. The profile is synthetic (the paper's is a figure), so this is no independent check"
NOT_MET = ["run-out beyond the toe at 28 deg", "friction angle for 140 m"]
REMARKS = ("The synthetic profile was shaped for 140 m with walls that carried too little shear; with walls that carry all of it the slide stops short, and the "
           "profile has not been shaped again.")
TOE, RUNOUT = 102.0, 140.0


def measure(work, coarse):
    spacing = 1.0 if coarse else 0.5
    rows = []
    for phi in (24, 25, 26, 27, 28, 29):
        directory = work / f"yangbaodi-{phi}-{spacing:g}"
        result = talus_runs.run(talus_runs.CASES / "yangbaodi-like.json", directory,
                                {"particle_spacing_m": spacing, "time.fixed_step_s": 0.002 * spacing, "material.friction_angle_deg": phi})
        rows.append({"phi_deg": phi, "farthest_m": result["influence_zone_m"] - TOE, "connected_m": result["front_connected_m"] - TOE,
                     "mass_999_m": result["front_mass_999_m"] - TOE, "ending": result["ending"]})
    return {"spacing_m": spacing, "rows": rows}


def angle_for(rows):
    """Friction angle of the paper's run-out by interpolation [deg]."""
    order = sorted(rows, key=lambda r: r["connected_m"])
    return float(np.interp(RUNOUT, [r["connected_m"] for r in order], [r["phi_deg"] for r in order]))


def criteria(numbers):
    at_28 = next(r for r in numbers["rows"] if r["phi_deg"] == 28)
    return [within("run-out beyond the toe at 28 deg, connected body [m]", at_28["connected_m"], 0.9 * RUNOUT, 1.1 * RUNOUT),
            within("friction angle for 140 m [deg]", angle_for(numbers["rows"]), 27, 29)]


def section(numbers, directory):
    figure, axes = fig.plt.subplots(figsize=(4.5, 3))
    for key, name in (("farthest_m", "farthest particle"), ("connected_m", "connected body"), ("mass_999_m", "99.9 % of the mass")):
        axes.plot([r["phi_deg"] for r in numbers["rows"]], [r[key] for r in numbers["rows"]], "o-", label=name)
    axes.axhline(RUNOUT, color="k", ls=":")
    axes.set(xlabel="friction angle [deg]", ylabel="run-out beyond the toe [m]")
    axes.legend()
    rows = [[r["phi_deg"], r["farthest_m"], r["connected_m"], r["mass_999_m"]] for r in numbers["rows"]]
    return f"Spacing {numbers['spacing_m']:g} m. The connected body reaches 140 m at phi = {angle_for(numbers['rows']):.1f} deg.\n\n" + \
        table(["phi [deg]", "farthest particle [m]", "connected body [m]", "99.9 % of the mass [m]"], rows) + "\n" + fig.save(figure, directory, "yangbaodi")
