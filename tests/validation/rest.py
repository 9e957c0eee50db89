"""Rest: a tank of water, a pile flatter than its friction angle, and the angle at which heaps begin to fail."""

import math

import numpy as np

import talus_runs
from experiment import at_most, table, within
from incline import slope
from snapshots import Snapshots

TITLE = "Rest and the angle of failure"
SOURCE = "closed forms: p = rho g depth; an infinite cohesionless layer fails at tan(theta) = tan(phi), with Eq. 7 as printed at sqrt(3) tan(phi)"
NOT_MET = {"pile of 15 degrees, elastic, dx = 0.05 m": 0.7, "heap fails, consistent shear rate [": 28.13, "heap fails, paper shear rate [": 54.59}  # heaps: the limit for any stress
REMARKS = ("The maximum displacement in the pile shrinks with the spacing, but less than in proportion, and its "
           "growth slows down; with the regularised model the pile creeps at a constant rate at every spacing. A "
           "heap of 20 rows (0.1 m) stands up to 5 degrees steeper than one of 40. A layer without ends fails in "
           "simple shear, and so does the heap with the consistent shear rate. With Eq. 7 as printed the heap stands "
           "some degrees steeper than the acceptance limit. This is admissible: its stress parallel to the slope can "
           "exceed the one across it, so the law `tau_y = p tan(phi)` can hold slopes up to the bound *any stress*, "
           "15 degrees above simple shear at this friction and 3 above it at the true one.")
PHI = 25.0
HEIGHT = 2.0  # of the heaps [m]
THICKNESS, LENGTH = 0.5, 24.0  # of the layers [m]


def heap(theta, spacing, seconds, **rheology):
    """Symmetric heap of slope theta [deg] on a rough floor."""
    half = HEIGHT / math.tan(math.radians(theta))
    return {"title": f"Heap of {theta:g} degrees", "particle_spacing_m": spacing,
            "terrain": {"bed_m": [[-3 * half, 0], [3 * half, 0]], "left_end": "open", "right_end": "open"},
            "slide": {"outlines": [{"outline_m": [[-half, 0], [half, 0], [0, HEIGHT]]}]},
            "material": {"density_kg_m3": 2000, "friction_angle_deg": PHI, "cohesion_Pa": 0},
            "rheology": rheology, "numerics": {"sound_speed_m_s": 10 * math.sqrt(2 * 9.81 * HEIGHT)},
            "time": {"end_s": seconds}, "study": {"realizations": 1}}


def moved(directory):
    """Displacement of every particle at the end [m]."""
    return np.linalg.norm(Snapshots(directory).field("displacement", -1), axis=1)


def gentle_pile(work, spacing):
    """Maximum displacement of a particle in 10 s and in parts of it: first the pile settles under its own weight [m]."""
    found = {}
    for law in ("elastic", "regularized"):
        directory = work / f"pile-{law}-{spacing:g}"
        case = heap(15, spacing, 10, **{"yield": law})
        case["time"]["snapshot_times_s"] = [1, 5]
        talus_runs.run(case, directory)
        snapshots = Snapshots(directory)
        farthest = lambda begin, end: float(np.linalg.norm(snapshots.position(end) - snapshots.position(begin), axis=1).max())
        found[law] = {"way": farthest(0, -1), "1 to 5 s": farthest(1, 2), "5 to 10 s": farthest(2, -1)}
    return found


def tank(work, spacing):
    depth = 1.0
    case = {"title": "Tank of water", "particle_spacing_m": spacing,
            "terrain": {"bed_m": [[0, 0], [2, 0]], "left_end": "wall", "right_end": "wall"},
            "slide": {"outlines": [{"outline_m": [[0, 0], [2, 0], [2, depth], [0, depth]]}]},
            "material": {"density_kg_m3": 1000, "friction_angle_deg": 0, "cohesion_Pa": 0, "viscosity_Pa_s": 0.001},
            "time": {"end_s": 5}, "study": {"realizations": 1}}
    directory = work / f"tank-{spacing:g}"
    result = talus_runs.run(case, directory)
    snapshots = Snapshots(directory)
    pressure, y = snapshots.field("pressure", -1), snapshots.position(-1)[:, 1]
    expected = 1000 * 9.81 * (depth - y)
    return {"rms_pressure": float(np.sqrt(np.mean((pressure - expected) ** 2)) / (1000 * 9.81 * depth)), "max_speed_m_s": result["final_max_speed_m_s"],
            "max_moved_m": float(moved(directory).max())}


def fails(work, theta, spacing, norm):
    """Whether a hundredth of the heap has moved further than one spacing in 5 s. Heaps that hold only settle, by less."""
    directory = work / f"heap-{norm}-{theta:g}-{spacing:g}"
    talus_runs.run(heap(theta, spacing, 5, shear_rate=norm), directory)
    return float(np.quantile(moved(directory), 0.99)) > spacing


def layer(theta, spacing, seconds, **rheology):
    """Layer THICKNESS thick and LENGTH long on an incline of theta [deg]: its ends do not affect its middle in time."""
    down, up = slope(theta)
    at = lambda distance, depth=0.0: list(distance * down + depth * up)
    return {"title": f"Layer at {theta:g} degrees", "particle_spacing_m": spacing,
            "terrain": {"bed_m": [at(-2), at(LENGTH + 4)], "left_end": "open", "right_end": "open"},
            "slide": {"outlines": [{"outline_m": [at(0), at(LENGTH), at(LENGTH, THICKNESS), at(0, THICKNESS)]}]},
            "material": {"density_kg_m3": 2000, "friction_angle_deg": PHI, "cohesion_Pa": 0},
            "rheology": rheology, "numerics": {"sound_speed_m_s": 10 * math.sqrt(2 * 9.81 * THICKNESS)},
            "time": {"end_s": seconds, "snapshot_times_s": [seconds - 1, seconds - 0.5]}, "study": {"realizations": 1}}


def layer_fails(work, theta, spacing, norm):
    """Whether the middle of the layer accelerates: in the last half second it moves farther than in the one before by more than 1 mm, which
    gravity gives a layer 0.02 degrees steeper than phi. A layer that holds settles by some millimetres and then sways by tenths of one."""
    directory = work / f"layer-{norm}-{theta:g}-{spacing:g}"
    talus_runs.run(layer(theta, spacing, 2, shear_rate=norm), directory)
    snapshots, down = Snapshots(directory), slope(theta)[0]
    start = (snapshots.position(0)) @ down
    middle = np.abs(start - 0.5 * LENGTH) < 1
    way = [float((snapshots.field("displacement", step)[:, :2] @ down)[middle].mean()) for step in (-3, -2, -1)]
    return (way[2] - way[1]) - (way[1] - way[0]) > 1e-3


def threshold(work, fails, spacing, norm, low, high, steps):
    """Largest slope that holds and smallest that fails [deg], by bisection."""
    tried = []
    for _ in range(steps):
        middle = round(0.5 * (low + high), 3)
        failed = fails(work, middle, spacing, norm)
        tried.append([middle, failed])
        low, high = (low, middle) if failed else (middle, high)
    return {"low": low, "high": high, "tried": tried}


NORMS = {"consistent": PHI, "paper": math.degrees(math.atan(math.sqrt(3) * math.tan(math.radians(PHI))))}


def strongest(phi):
    """Steepest slope [deg] that any admissible state of stress can hold. With x = (sigma_t - sigma_n)/(2 sigma_n) the law p tan(phi)
    allows tan^2(theta) = tan^2(phi) (1 + x)^2 - x^2, whose largest value is at tan(theta) = tan(phi)/sqrt(1 - tan^2(phi))."""
    t = math.tan(math.radians(phi))
    return math.degrees(math.atan(t / math.sqrt(1 - t * t)))


def measure(work, coarse):
    spacing, steps = (0.1, 4) if coarse else (0.05, 5)
    spacings = (0.1,) if coarse else (0.1, 0.05)
    found = {"spacing_m": spacing, "tank": tank(work, spacing), "pile": {f"{dx:g}": gentle_pile(work, dx) for dx in spacings}, "layer": {}, "heap": {}}
    for norm, angle in NORMS.items():
        found["layer"][norm] = threshold(work, layer_fails, 0.05, norm, angle - 6, angle + 6, steps)
        found["heap"][norm] = {f"{dx:g}": threshold(work, fails, dx, norm, angle - 6, strongest(angle) + 2, steps) for dx in spacings}
    return found


def edge(found):
    return 0.5 * (found["low"] + found["high"])


def criteria(numbers):
    spacing, tank_found = numbers["spacing_m"], numbers["tank"]
    found = [at_most("tank: rms error of the pressure over that at the bottom", tank_found["rms_pressure"], 0.03),
             at_most("tank: maximum particle displacement in 5 s, in spacings", tank_found["max_moved_m"] / spacing, 1.0)]
    for dx, pile in numbers["pile"].items():
        found.append(at_most(f"pile of 15 degrees, elastic, dx = {dx} m: maximum displacement in 10 s, in spacings", pile["elastic"]["way"] / float(dx), 0.5))
    for norm, angle in NORMS.items():
        heap_found = list(numbers["heap"][norm].values())[-1]
        half_step = 0.5 * (heap_found["high"] - heap_found["low"])
        found.append(within(f"layer fails, {norm} shear rate [deg]", edge(numbers["layer"][norm]), angle - 2, angle + 2))
        found.append(within(f"heap fails, {norm} shear rate [deg]", edge(heap_found), angle - 2, angle + 2))
        found.append(within(f"heap fails, {norm} shear rate, any stress [deg]", edge(heap_found), angle - 0.5 - half_step, strongest(angle) + half_step,
                            "simple shear to any stress, and half a step of the bisection"))
    return found


def section(numbers, directory):
    spacing = numbers["spacing_m"]
    text = f"Spacing {spacing:g} m. Tank of water 2 m x 1 m after 5 s: rms error of the pressure {100 * numbers['tank']['rms_pressure']:.2f} % of that at the bottom, " \
           f"fastest particle {1000 * numbers['tank']['max_speed_m_s']:.1f} mm/s.\n\n"
    text += f"Pile of 15 degrees, phi = 25 deg, {HEIGHT:g} m high, maximum particle displacement:\n\n"
    text += table(["law", "dx [m]", "in 10 s [m]", "from 1 to 5 s [m]", "from 5 to 10 s [m]", "in 10 s / dx"],
                  [[law, dx, p["way"], p["1 to 5 s"], p["5 to 10 s"], p["way"] / float(dx)] for dx, pile in numbers["pile"].items() for law, p in pile.items()])
    text += f"\nWhere slopes of phi = 25 deg begin to fail: a layer {THICKNESS:g} m thick on an incline (its middle moves faster in the last half second of 2 s than in the one before), and a heap " \
            f"{HEIGHT:g} m high (a hundredth of it has moved further than dx in 5 s):\n\n"
    rows = []
    for norm, angle in NORMS.items():
        for shape, dx, e in [("layer", "0.05", numbers["layer"][norm]), *(("heap", dx, e) for dx, e in numbers["heap"][norm].items())]:
            rows.append([shape, dx, norm, f"{angle:.1f}", f"{strongest(angle):.1f}", f"{e['low']:.1f}", f"{e['high']:.1f}"])
    return text + table(["shape", "dx [m]", "shear rate", "simple shear [deg]", "any stress [deg]", "holds at [deg]", "fails at [deg]"], rows)
