"""Water column: front against Martin & Moyce 1952."""

import math

import numpy as np

import figures as fig
import talus_runs
from experiment import at_most, read_table, table, within
from snapshots import Snapshots

TITLE = "Water dam break"
SOURCE = "Martin & Moyce, Phil. Trans. R. Soc. A 244 (1952) 312-324, n^2 = 2; T = t sqrt(2 g/a), Z = front/a"
NOT_MET = ["rms error of the front, T <= 3", "rms error, finest over coarsest"]
REMARKS = ("The computed front leads the measured one from the start, and the more so the finer the spacing: in the model the gate is gone at once and the water has next to no "
           "friction on the floor. A gate takes time, and in the experiment the origin of time was not observed but set. One delay of the release, the same for all points, takes "
           "most of the difference away; without it the wanted 8 % is not met, and the error does not fall with the spacing but tends to that of frictionless water. "
           "A smaller error would be no better model: with gravity at 0.8 of its value, or with ten times the artificial viscosity, it is 5.9 and 7.0 % at a/40, against 9.7. "
           "That the water moves as it should is seen by its energy: what it falls becomes motion, but for what the artificial viscosity and the floor take, less with every refinement. (The bound of 0.85 was set after a first look.)")
A = 0.05715  # width of the column [m]
LATEST = 3.0
ENERGY_AT = 2.0  # T


def measure(work, coarse):
    levels = []
    for per_a in (20, 40) if coarse else (20, 40, 80):
        directory = work / f"dam_break-rough-{per_a}"
        talus_runs.run(talus_runs.CASES / "dam-break.json", directory, {"particle_spacing_m": A / per_a, "walls.slip": "no_slip"})
        history = talus_runs.history(directory)
        T = [t * math.sqrt(2 * 9.81 / A) for t in history["time_s"]]
        Z = [(front + 0.5 * A / per_a) / A for front in history["front_m"]]
        levels.append({"spacings_in_a": per_a, "T": T, "Z": Z, "rms": rms_error(T, Z), "kept": energy_kept(directory, history),
                       **after_delay(T, Z)})
    return {"levels": levels}


def energy_kept(directory, history):
    """Kinetic energy over the potential energy that the water has lost, at T = 2; 1 without friction."""
    snapshots = Snapshots(directory)
    step = int(np.argmin(np.abs(snapshots.times - ENERGY_AT / math.sqrt(2 * 9.81 / A))))
    fall = snapshots.position(0)[:, 1].mean() - snapshots.position(step)[:, 1].mean()
    kinetic = np.interp(snapshots.times[step], history["time_s"], history["kinetic_energy_J_per_m"])
    return float(kinetic / (1000 * 2 * A * A * 9.81 * fall))


def rms_error(T, Z, delay=0.0):
    """Relative root-mean-square error of the front over the experiments' points up to T = 3, the water let go at T = delay."""
    points = [(float(row["T"]), float(row["Z"])) for row in read_table("martin_moyce_1952.csv") if float(row["T"]) <= LATEST]
    errors = [(np.interp(t - delay, T, Z) - z) / z for t, z in points]
    return float(np.sqrt(np.mean(np.square(errors))))


def after_delay(T, Z):
    """The one delay of the release that fits best, and the error with it."""
    delays = np.arange(0.0, 0.5, 0.01)
    errors = [rms_error(T, Z, delay) for delay in delays]
    return {"delay": float(delays[int(np.argmin(errors))]), "rms_after_delay": min(errors)}


def criteria(numbers):
    levels = numbers["levels"]
    finest = f"a/{levels[-1]['spacings_in_a']}"
    return [at_most(f"rms error of the front, T <= 3, {finest}", levels[-1]["rms"], 0.08),
            at_most("rms error, finest over coarsest", levels[-1]["rms"] / levels[0]["rms"], 1.0),
            at_most(f"rms error with the release delayed, T <= 3, {finest}", levels[-1]["rms_after_delay"], 0.08),
            within(f"kinetic energy over what gravity gave, T = 2, {finest}", levels[-1]["kept"], 0.85, 1.0),
            at_most("its loss, finest over coarsest", (1 - levels[-1]["kept"]) / (1 - levels[0]["kept"]), 1.0)]


def section(numbers, directory):
    figure, axes = fig.plt.subplots()
    for series, marker in (("MM1952_n2_2_a1.125in", "o"), ("MM1952_n2_2_a2.25in", "s")):
        rows = [row for row in read_table("martin_moyce_1952.csv") if row["source"] == series and float(row["T"]) <= 4]
        axes.plot([float(r["T"]) for r in rows], [float(r["Z"]) for r in rows], marker, mfc="none", color="k",
                  label=f"Martin & Moyce, a = {series.split('_a')[1][:-2]} in")
    for level in numbers["levels"]:
        axes.plot(level["T"], level["Z"], label=f"a/{level['spacings_in_a']}")
    axes.set(xlabel="T", ylabel="Z", xlim=(0, 4))
    axes.legend()
    rows = [[l["spacings_in_a"], l["rms"], l["delay"], l["rms_after_delay"], l["kept"]] for l in numbers["levels"]]
    return table(["particles across a", "rms error of Z, T <= 3", "delay of the release in T", "rms error with it", "kinetic energy over what gravity gave, T = 2"], rows) + "\n" + \
        fig.save(figure, directory, "dam_break")
