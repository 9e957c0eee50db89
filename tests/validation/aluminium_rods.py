"""Collapse of aluminium rods: final surface, toe and failure line against Bui et al. 2008."""

import numpy as np

import figures as fig
import talus_runs
from experiment import at_most, read_table, table
from snapshots import Snapshots, surface

TITLE = "Aluminium rods"
SOURCE = "Bui, Fukagawa, Sako & Ohno, Int. J. Numer. Anal. Meth. Geomech. 32 (2008) 1537-1570: phi 19.8 deg, c 0, column 0.2 x 0.1 m"
NOT_MET = ["failure line, rms over the height"]
REMARKS = "The contour of 5 mm lies below the measured failure line by a little more than the tenth of the height that was wanted."
HEIGHT, TOE = 0.1, 0.43  # [m]; the experiment's toe lies between 0.42 and 0.44


def curve(name):
    rows = [row for row in read_table("bui_2008.csv") if row["curve"] == name]
    return np.array([float(r["x_m"]) for r in rows]), np.array([float(r["y_m"]) for r in rows])


def measure(work, coarse):
    levels = []
    x, y = curve("final_surface")
    for spacing in (0.004, 0.002) if coarse else (0.004, 0.002, 0.001):
        directory = work / f"aluminium_rods-{spacing:g}"
        result = talus_runs.run(talus_runs.CASES / "aluminium-rods.json", directory, {"particle_spacing_m": spacing})
        snapshots = Snapshots(directory)
        position, displacement = snapshots.position(-1), snapshots.field("displacement", -1)
        found = surface(position, x, spacing)
        start = position - displacement[:, :2]
        levels.append({"spacing_m": spacing, "surface_m": found.tolist(), "rms_over_height": float(np.sqrt(np.mean((found - y) ** 2)) / HEIGHT),
                       "toe_m": toe(found, x, spacing), "farthest_m": result["influence_zone_m"], "connected_m": result["front_connected_m"],
                       "failure_line": failure_line(start, np.linalg.norm(displacement, axis=1), spacing)})
    return {"levels": levels}


def toe(heights, x, spacing):
    """Where the deposit becomes thinner than two rows of particles: what an eye takes for the toe of a heap of rods."""
    return float(np.interp(-2 * spacing, -heights[5:], x[5:]))


def failure_line(start, moved, spacing):
    """Height, by x of the original column, below which material moved less than 5 mm."""
    line = []
    for at in np.arange(0.01, 0.2, 0.01):
        column = np.abs(start[:, 0] - at) < spacing
        still = column & (moved < 0.005)
        line.append([round(float(at), 3), float(start[still, 1].max() + 0.5 * spacing) if still.any() else 0.0])
    return line


def criteria(numbers):
    finest = numbers["levels"][-1]
    x, y = curve("failure_line")
    line = np.array(finest["failure_line"])
    apart = np.interp(x, line[:, 0], line[:, 1]) - y
    return [at_most("surface, rms over the height", finest["rms_over_height"], 0.10),
            at_most("toe, relative error", abs(finest["toe_m"] / TOE - 1), 0.08),
            at_most("failure line, rms over the height", float(np.sqrt(np.mean(apart ** 2))) / HEIGHT, 0.10)]


def section(numbers, directory):
    figure, axes = fig.plt.subplots()
    axes.plot(*curve("final_surface"), "ko", mfc="none", label="surface, experiment")
    axes.plot(*curve("failure_line"), "k^", mfc="none", label="failure line, experiment")
    x, _ = curve("final_surface")
    for level in numbers["levels"]:
        (drawn,) = axes.plot(x, level["surface_m"], label=f"dx = {1000 * level['spacing_m']:g} mm")
        axes.plot(*np.array(level["failure_line"]).T, "--", color=drawn.get_color())
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.legend()
    rows = [[1000 * l["spacing_m"], l["rms_over_height"], l["toe_m"], l["connected_m"], l["farthest_m"]] for l in numbers["levels"]]
    return table(["dx [mm]", "surface rms / height", "toe [m]", "front of the connected body [m]", "farthest particle [m]"], rows) + \
        "\nToe: where the deposit becomes thinner than two rows (experiment 0.42-0.44 m). Dashed: contour of 5 mm of displacement.\n\n" + \
        fig.save(figure, directory, "aluminium_rods")
