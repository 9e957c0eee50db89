"""Slabs on planes: axes, cases, and the friction that an acceleration shows. Used by several experiments."""

import math

import numpy as np

GRAVITY = 9.81  # [m/s2]


def slope(theta):
    """Unit vectors down a slope of theta [deg] and away from it."""
    angle = math.radians(theta)
    return np.array([math.cos(angle), -math.sin(angle)]), np.array([math.sin(angle), math.cos(angle)])


def acceleration(theta, phi):
    """Down a plane of theta with friction angle phi, both [deg]: g (sin(theta) - cos(theta) tan(phi)) [m/s2]."""
    angle = math.radians(theta)
    return GRAVITY * (math.sin(angle) - math.cos(angle) * math.tan(math.radians(phi)))


def friction(theta, found):
    """tan of the friction angle with which a body accelerates so [m/s2] down a plane of theta [deg]."""
    angle = math.radians(theta)
    return (math.sin(angle) - found / GRAVITY) / math.cos(angle)


def case(title, theta, outline, spacing, seconds, phi, sound_speed):
    """Soil on a plane of theta [deg]. @param outline  [(distance down the slope, height above it), ...] [m]

    Snapshots at the start, at half of the time and at the end; the plane goes on as far as a body without friction.
    """
    down, up = slope(theta)
    reach = max(distance for distance, _ in outline) + 0.5 * GRAVITY * math.sin(math.radians(theta)) * seconds**2 + 10 * spacing
    at = lambda distance, height=0.0: list(distance * down + height * up)
    return {"title": title, "particle_spacing_m": spacing,
            "terrain": {"bed_m": [at(-6 * spacing), at(reach)], "left_end": "open", "right_end": "open"},
            "slide": {"outlines": [{"outline_m": [at(*vertex) for vertex in outline]}]},
            "material": {"density_kg_m3": 2000, "friction_angle_deg": phi, "cohesion_Pa": 0, "viscosity_Pa_s": 0},
            "numerics": {"sound_speed_m_s": sound_speed}, "time": {"end_s": seconds, "snapshot_times_s": [0.5 * seconds]}, "study": {"realizations": 1}}


def motion(snapshots, theta, chosen):
    """Mean acceleration in the second half of the time [m/s2] and mean distance [m] of chosen particles, down the slope."""
    down, _ = slope(theta)
    middle, end = (float((snapshots.field("velocity", step)[:, :2] @ down)[chosen].mean()) for step in (1, 2))
    return (end - middle) / float(snapshots.times[2] - snapshots.times[1]), float((snapshots.field("displacement", 2)[:, :2] @ down)[chosen].mean())
