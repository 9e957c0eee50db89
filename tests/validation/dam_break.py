"""Water column: front against Martin & Moyce 1952."""

import math

import numpy as np

import figures as fig
import talus_runs
from experiment import at_most, read_table, table
from snapshots import Snapshots

TITLE = "Water dam break"
SOURCE = "Martin & Moyce, Phil. Trans. R. Soc. A 244 (1952) 312-324, n^2 = 2; T = t sqrt(2 g/a), Z = front/a"
NOT_MET = {"rms error of the front, T <= 3": 0.17, "rms error, finest over coarsest": 2.0}
REMARKS = ("The computed front is ahead of the measured one from the start, and more so at finer spacings. In the "
           "model the dam vanishes at once and the water has almost no friction on the floor; in the experiment the "
           "dam takes time to open, and the origin of time was set, not observed. A single delay of the release for "
           "all points (0.22 in T, or 12 ms) removes most of the difference. Without it the limit of 8 % is not met, "
           "and the error has grown with every refinement, towards that of water on a frictionless floor. A smaller "
           "error would not mean a better model: with gravity at 0.8 of its value or with ten times the artificial "
           "viscosity it was 5.9 and 7.0 % at a/40 (each tried once), compared with 9.7. A delay can hide such an "
           "error only in part: the limit for the delayed front is twice the difference between the experiment's two "
           "sizes, which gravity at 0.8 exceeds. The energy shows that the water moves correctly: the potential "
           "energy becomes kinetic energy. With the whole jump of velocity the artificial viscosity took 11 % of it until "
           "T = 2, mostly in a layer on the floor, and so hid a part of the missing gate: the error was 9.7 % at a/40. "
           "Now it takes 1 %, and the error is that of water without friction, which the limit of the unmet criterion "
           "follows. (These limits were set after the runs, from the reasons given.) The shipped case `dam-break.json` has `free_slip` walls; "
           "here they are `no_slip`, the default.")
A = 0.05715  # width of the column [m]
LATEST = 3.0
ENERGY_AT = 2.0  # T


def measure(work, coarse):
    levels = []
    for per_a in (20, 40) if coarse else (20, 40, 80):
        levels.append(collapse(work, per_a, "no_slip"))
    return {"levels": levels, "frictionless": collapse(work, levels[-1]["spacings_in_a"], "free_slip")}


def collapse(work, per_a, slip):
    directory = work / f"dam_break-{slip}-{per_a}"
    talus_runs.run(talus_runs.CASES / "dam-break.json", directory, {"particle_spacing_m": A / per_a, "walls.slip": slip})
    history = talus_runs.history(directory)
    T = [t * math.sqrt(2 * 9.81 / A) for t in history["time_s"]]
    Z = [(front + 0.5 * A / per_a) / A for front in history["front_m"]]
    return {"spacings_in_a": per_a, "T": T, "Z": Z, "rms": rms_error(T, Z), "kept": energy_kept(directory, history), **after_delay(T, Z)}


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


SERIES = ("MM1952_n2_2_a1.125in", "MM1952_n2_2_a2.25in")


def points(series):
    """T and Z of one size of the experiment."""
    rows = [row for row in read_table("martin_moyce_1952.csv") if row["source"] == series]
    return np.array([float(r["T"]) for r in rows]), np.array([float(r["Z"]) for r in rows])


def scatter():
    """Relative rms difference of the experiment's two sizes up to T = 3, the smaller one's points against the other's line."""
    (T, Z), (other_T, other_Z) = map(points, SERIES)
    common = (T <= LATEST) & (T >= other_T[0]) & (T <= other_T[-1])
    line = np.interp(T[common], other_T, other_Z)
    return float(np.sqrt(np.mean((Z[common] / line - 1) ** 2)))


def criteria(numbers):
    levels = numbers["levels"]
    finest = f"a/{levels[-1]['spacings_in_a']}"
    return [at_most(f"rms error of the front, T <= 3, {finest}", levels[-1]["rms"], 0.08),
            at_most("rms error, finest over coarsest", levels[-1]["rms"] / levels[0]["rms"], 1.0),
            at_most(f"rms error with the release delayed, T <= 3, {finest}", levels[-1]["rms_after_delay"], 2 * scatter(), "twice the scatter of the experiment"),
            at_most(f"energy lost until T = 2, {finest}", 1 - levels[-1]["kept"], 0.02, "water has almost no friction")]


def section(numbers, directory):
    figure, axes = fig.plt.subplots()
    for series, marker in zip(SERIES, "os"):
        axes.plot(*points(series), marker, mfc="none", color="k",
                  label=f"Martin & Moyce, a = {series.split('_a')[1][:-2]} in")
    for level in numbers["levels"]:
        axes.plot(level["T"], level["Z"], label=f"a/{level['spacings_in_a']}")
    axes.plot(numbers["frictionless"]["T"], numbers["frictionless"]["Z"], ":", label=f"a/{numbers['frictionless']['spacings_in_a']}, frictionless")
    axes.set(xlabel="time T = t sqrt(2 g / a)", ylabel="front Z = x / a", xlim=(0, 4), ylim=(1, 6))
    axes.legend()
    rows = [[l["spacings_in_a"], slip, l["rms"], l["delay"], l["rms_after_delay"], l["kept"]]
            for l, slip in [*((l, "no slip") for l in numbers["levels"]), (numbers["frictionless"], "free slip")]]
    return table(["particles across a", "walls", "rms error of Z, T <= 3", "delay of the release in T", "rms error with it", "kinetic energy over what gravity gave, T = 2"], rows) + \
        f"\nThe experiment's two sizes differ by {100 * scatter():.1f} % (rms, T <= 3).\n\n" + fig.save(figure, directory, "dam_break")
