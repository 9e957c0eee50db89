"""A Bingham layer on an incline: profile of velocity and flux against the closed form."""

import math

import numpy as np

import figures as fig
import talus_runs
from experiment import at_least, at_most, order_of_convergence, table
from snapshots import Snapshots

TITLE = "Bingham layer on an incline"
SOURCE = "closed form: G = rho g sin(theta), plug above Y = h - tau_y/G, u = U (1 - ((y - Y)/Y)^2) below it, U = G Y^2/(2 eta), flux U (h - Y/3)"
NOT_MET = {"rms error of the profile over U": 2.75 * 0.025 / 0.5}  # 2.75 dx/h at the coarse experiment's finest spacing
REMARKS = ("The target was 1.6 dx/h of U; with the default kernel the error is within 2.5 dx/h. The profile "
           "converges, but its error is 50 % above the target.")
THICKNESS, DENSITY, TAU_Y, ETA, THETA = 0.5, 1500.0, 1000.0, 900.0, math.radians(20)
G = DENSITY * 9.81 * math.sin(THETA)
Y = THICKNESS - TAU_Y / G
U = G * Y * Y / (2 * ETA)
FLUX = U * (THICKNESS - Y / 3)


def closed_form(y):
    return np.where(y > Y, U, U * (1 - ((y - Y) / Y) ** 2))


def along(distance, depth=0.0):
    """Coordinates of a point so far down the slope, so high above the bed."""
    return [distance * math.cos(THETA) + depth * math.sin(THETA), -distance * math.sin(THETA) + depth * math.cos(THETA)]


def case(spacing):
    """A layer 7 m long, so that its ends do not affect its middle; after 2 s, twelve times rho h^2/(2.5 eta), the profile is steady."""
    return {"title": "Bingham layer on an incline", "particle_spacing_m": spacing,
            "terrain": {"bed_m": [along(-2), along(10)], "left_end": "open", "right_end": "open"},
            "slide": {"outlines": [{"outline_m": [along(0), along(7), along(7, THICKNESS), along(0, THICKNESS)]}]},
            "material": {"density_kg_m3": DENSITY, "friction_angle_deg": 0, "cohesion_Pa": TAU_Y, "viscosity_Pa_s": ETA},
            "numerics": {"sound_speed_m_s": 10 * math.sqrt(2 * 9.81 * THICKNESS)}, "time": {"end_s": 2}, "study": {"realizations": 1}}


def measure(work, coarse):
    levels = []
    for spacing in (0.05, 0.025) if coarse else (0.05, 0.025, 0.0125):
        directory = work / f"bingham_incline-{spacing:g}"
        talus_runs.run(case(spacing), directory)
        snapshots = Snapshots(directory)
        position, velocity = snapshots.position(-1), snapshots.field("velocity", -1)[:, :2]
        down = np.array([math.cos(THETA), -math.sin(THETA)])
        up = np.array([math.sin(THETA), math.cos(THETA)])
        middle = np.abs(position @ down - 3.9) < 0.5
        y, u = position[middle] @ up, velocity[middle] @ down
        rows = np.linspace(0, THICKNESS, 11)
        profile = [float(u[(y >= a) & (y < b)].mean()) for a, b in zip(rows, rows[1:])]
        levels.append({"spacing_m": spacing, "profile": profile, "rms": float(np.sqrt(np.mean((u - closed_form(y)) ** 2)) / U),
                       "flux": float(u.sum() * spacing ** 2 / 1.0)})  # particles of a stretch of 1 m, each dx^2 large
    return {"levels": levels}


def errors_of_flux(numbers):
    return [abs(level["flux"] / FLUX - 1) for level in numbers["levels"]]


def criteria(numbers):
    levels = numbers["levels"]
    order = order_of_convergence([l["spacing_m"] for l in levels], [l["rms"] for l in levels])
    return [at_most(f"rms error of the profile over U, dx = {levels[-1]['spacing_m']:g} m", levels[-1]["rms"], 1.6 * levels[-1]["spacing_m"] / THICKNESS),
            at_most("error of the flux", errors_of_flux(numbers)[-1], 2 * levels[-1]["spacing_m"] / THICKNESS),
            at_least("order of convergence of the profile", order, 0.8)]


def section(numbers, directory):
    levels = numbers["levels"]
    figure, axes = fig.plt.subplots(figsize=(4.5, 3.2))
    y = np.linspace(0, THICKNESS, 200)
    axes.plot(closed_form(y), y, "k", label="closed form")
    rows = np.linspace(0, THICKNESS, 11)
    for level in levels:
        axes.plot(level["profile"], 0.5 * (rows[1:] + rows[:-1]), "o", mfc="none", label=f"dx = {level['spacing_m']:g} m")
    axes.set(xlabel="velocity [m/s]", ylabel="height above the bed [m]")
    axes.legend()
    spacings = [l["spacing_m"] for l in levels]
    order = order_of_convergence(spacings, [l["rms"] for l in levels])
    order_flux = order_of_convergence(spacings, errors_of_flux(numbers))
    return table(["dx [m]", "rms error of the profile / U", "flux [m2/s]", f"its error (exact {FLUX:.5f})"],
                 [[l["spacing_m"], l["rms"], l["flux"], e] for l, e in zip(levels, errors_of_flux(numbers))]) + \
        f"\nObserved order: {order:.2f} of the profile, {order_flux:.2f} of the flux. The mirrored velocity of the wall is capped at 1.5 times " \
        "(`walls.max_velocity_ratio`), which lets the lowest row slip: first order.\n\n" + fig.save(figure, directory, "bingham_incline")
