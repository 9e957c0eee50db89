"""make_sections.py RAW: cuts the sections of this folder from the files in RAW that SOURCES.md names.

    pip download --no-deps --no-binary laspy laspy==2.7.0     # append-bug.laz, autzen_trim.laz
    apt-get source --download-only qgis                       # dtm.tif, dem.tif and hill.tif
    pip install numpy laspy lazrs tifffile imagecodecs

Every section is a case NAME.json and CSV files of chainage and elevation in metres: NAME-ground.csv, NAME-slip.csv and
NAME-bed.csv, which is the ground outside the slide and the slip surface inside it. The slip surfaces are assumed unless
SOURCES.md says otherwise.
"""

import json
import math
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
FOOT = 0.3048  # [m]


def unique_chainage(chainage, elevation):
    """(vertices, 2) [m], sorted by chainage; vertices of the same chainage, to the centimetre, become their mean."""
    at, place = np.unique(np.round(chainage, 2), return_inverse=True)
    return np.column_stack([at, np.bincount(place, weights=elevation) / np.bincount(place)])


def ground_returns(path):
    """(points, 3): coordinates of the points that the survey classified as ground (class 2), in units of the file."""
    import laspy

    cloud = laspy.read(path)
    ground = np.asarray(cloud.classification) == 2
    return np.column_stack([np.asarray(axis)[ground] for axis in (cloud.x, cloud.y, cloud.z)])


def grid(path):
    """Elevations of a GeoTIFF as float; the first row is the northernmost."""
    import tifffile

    return tifffile.imread(path).astype(float)


def clip(profile, low, high):
    return profile[(profile[:, 0] >= low) & (profile[:, 0] <= high)]


def elevation_at(profile, x):
    return np.interp(x, profile[:, 0], profile[:, 1])


def arc(ground, left, right, depth, vertices=60):
    """Circular slip surface from the ground at `left` to that at `right`, `depth` below the middle of its chord [m]."""
    ends = np.array([[x, elevation_at(ground, x)] for x in (left, right)])
    along = ends[1] - ends[0]
    half = 0.5 * np.hypot(*along)
    normal = np.array([-along[1], along[0]]) / (2 * half)
    radius = (half**2 + depth**2) / (2 * depth)
    centre = 0.5 * (ends[0] + ends[1]) + (radius - depth) * normal
    x = np.linspace(left, right, vertices)
    y = np.minimum(centre[1] - np.sqrt(radius**2 - (x - centre[0]) ** 2), elevation_at(ground, x))
    return np.column_stack([x, y])


def bed(ground, slip):
    """The ground outside the slip surface, the slip surface inside it."""
    left, right = slip[0, 0], slip[-1, 0]
    return np.vstack([ground[ground[:, 0] < left], slip, ground[ground[:, 0] > right]])


def write(path, profile):
    rows = ["chainage_m,elevation_m", *(f"{x:.3f},{y:.3f}" for x, y in profile)]
    path.write_text("\n".join(rows) + "\n")


LEFT = {"left_end": "open", "right_end": "wall"}  # ends of a section whose slide goes to the left


def case(name, title, description, spacing, material, end, terrain=None, stop=True, **rest):
    """The case as a dictionary; the run ends at rest, by the rule of `stop`, or at `end` [s]."""
    return {"title": title, "description": description, "particle_spacing_m": spacing,
            "terrain": {"bed_csv": f"{name}-bed.csv", **(terrain or {})},
            "slide": {"ground_surface_csv": f"{name}-ground.csv", "slip_surface_csv": f"{name}-slip.csv"},
            "material": material, "time": {"end_s": end, "stop_at_rest": stop}, **rest,
            "study": {"realizations": 1, "seed": 1}}


def save(name, ground, slip, document):
    write(HERE / f"{name}-ground.csv", ground)
    write(HERE / f"{name}-slip.csv", slip)
    write(HERE / f"{name}-bed.csv", bed(ground, slip))
    (HERE / f"{name}.json").write_text(json.dumps(document, indent=1) + "\n")
    print(f"{name}: {len(ground)} vertices of the ground, slide of {area(ground, slip):.1f} m2")


def area(ground, slip):
    """Area of the slide [m2]."""
    x = np.unique(np.concatenate([ground[:, 0], slip[:, 0]]))
    x = x[(x >= slip[0, 0]) & (x <= slip[-1, 0])]
    return float(np.trapezoid(elevation_at(ground, x) - elevation_at(slip, x), x))


def escarpment(raw):
    """Profile of a strip 0.3 m wide along the eastern edge of the tile, northwards: every ground return is a vertex."""
    points = ground_returns(raw / "append-bug.laz")
    points = points[points[:, 0] > 698999.7]
    return unique_chainage(points[:, 1] - 6259200, points[:, 2])


def scarp(raw):
    ground = clip(escarpment(raw), 90, 800)
    slip = arc(ground, 155, 228, 12)
    material = {"name": "slope debris", "density_kg_m3": 1900, "friction_angle_deg": 25, "cohesion_Pa": 500,
                "viscosity_Pa_s": 1500}
    save("scarp", ground, slip, case(
        "scarp", "Scarp surveyed by lidar",
        "Ground returns of an airborne lidar survey in a strip 0.3 m wide. The slip surface is assumed.",
        0.8, material, 40, numerics={"sound_speed_m_s": 120}))


def ledges(raw):
    ground = clip(escarpment(raw), 430, 760)
    slip = arc(ground, 463, 508, 6)
    material = {"name": "soft clay", "density_kg_m3": 1700, "friction_angle_deg": 14, "cohesion_Pa": 1000,
                "viscosity_Pa_s": 1000}
    save("ledges", ground, slip, case(
        "ledges", "Ledges surveyed by lidar",
        "Lower part of the survey of the case scarp: ledges of 6 and 7 m. The slip surface is assumed.",
        0.5, material, 150, stop={"speed_m_s": 0.005}, numerics={"sound_speed_m_s": 100}))


def river_bank(raw):
    """Bank of a river, southwards from the water: the slide goes to the left."""
    points = ground_returns(raw / "autzen_trim.laz") * FOOT
    east, north = points[:, 0] - 636001.76 * FOOT, points[:, 1] - 848935.85 * FOOT
    strip = np.abs(east - 90) < 1.5
    ground = clip(unique_chainage(160 - north[strip], points[strip, 2]), 10, 130)
    slip = arc(ground, 46.6, 62, 3.2)
    material = {"name": "soft clay", "density_kg_m3": 1500, "friction_angle_deg": 12, "cohesion_Pa": 500,
                "viscosity_Pa_s": 1000}
    save("river-bank", ground, slip, case(
        "river-bank", "River bank surveyed by lidar",
        "Ground returns of an airborne lidar survey in a strip 3 m wide. The slide goes to the left. "
        "The slip surface is assumed.",
        0.2, material, 20, LEFT, numerics={"sound_speed_m_s": 60}))


def valley_side(raw):
    """Row 60 of a grid of 2 m with elevations in whole metres; chainage is the easting of the British National Grid."""
    cells = np.arange(150, 420)
    ground = np.column_stack([321001 + 2 * cells, grid(raw / "dtm.tif")[60, cells]])
    slip = arc(ground, 321360, 321460, 13)
    material = {"name": "soft clay", "density_kg_m3": 1700, "friction_angle_deg": 10, "cohesion_Pa": 2000,
                "viscosity_Pa_s": 1000}
    save("valley-side", ground, slip, case(
        "valley-side", "Valley side on a national grid",
        "Elevations in whole metres on a grid of 2 m. Chainage is the easting. The slip surface is assumed.",
        0.8, material, 100, numerics={"sound_speed_m_s": 120}))


def alpine(raw):
    """Row 210 of a grid of 25 m; chainage from the western edge of the grid."""
    cells = np.arange(50, 110)
    ground = np.column_stack([25 * cells + 12.5, grid(raw / "dem.tif")[210, cells]])
    slip = arc(ground, 1662.5, 1812.5, 25)
    material = {"name": "broken rock", "density_kg_m3": 2000, "friction_angle_deg": 32,
                "mu_i": {"high_rate_friction_angle_deg": 41.6, "grain_diameter_m": 0.3}}
    save("alpine", ground, slip, case(
        "alpine", "Alpine valley with a cliff",
        "Elevations on a grid of 25 m; the slide falls over a cliff of 270 m. The slip surface is assumed.",
        3.0, material, 80, numerics={"sound_speed_m_s": 600}))


def hill(raw):
    """Column 153 of a grid of 0.0001 degrees, southwards: a hillside above a plain; the slide goes to the left."""
    cell = 1e-4 * math.pi / 180 * 6367449.146  # along the meridian [m]
    rows = np.arange(40, 130)
    ground = np.column_stack([cell * rows, grid(raw / "hill.tif")[rows, 153]])
    slip = arc(ground, 1055, 1250, 20)
    material = {"name": "soft clay", "density_kg_m3": 1600, "friction_angle_deg": 8, "viscosity_Pa_s": 1000}
    save("hill", ground, slip, case(
        "hill", "Hillside above a plain",
        "Gentle hillside; the slide goes to the left and runs out on a plain. The slip surface is assumed.",
        1.6, material, 120, LEFT, numerics={"sound_speed_m_s": 130}))


REVIEW = {  # problem 1(c): top of each soil [m], cohesion [Pa], friction angle [deg]; and the critical circle [m]
    "sand": ([[20, 25], [30, 25], [50, 35], [70, 35]], 0, 38),
    "upper clay": ([[20, 25], [30, 25], [40, 27], [50, 29], [54, 31], [70, 31]], 5300, 23),
    "lower clay": ([[20, 25], [30, 25], [40, 27], [52, 24], [70, 24]], 7200, 20)}
CENTRE, RADIUS, ENDS = (34.121, 43.254), 18.781, (29.703, 50.991)


def halved(name, cohesion, friction):
    """Material with half of the cohesion and of tan(phi)."""
    half = math.degrees(math.atan(0.5 * math.tan(math.radians(friction))))
    return {"name": name, "cohesion_Pa": 0.5 * cohesion, "friction_angle_deg": round(half, 3)}


def layered(_):
    """Problem 1(c) of the ACADS review, with half of the published strengths so that the slope fails."""
    tops = [np.array(top, float) for top, _, _ in REVIEW.values()]
    ground = np.vstack([[-20, 25], tops[0], [80, 35]])
    x = np.linspace(*ENDS, 60)
    y = CENTRE[1] - np.sqrt(RADIUS**2 - (x - CENTRE[0]) ** 2)
    slip = np.column_stack([x, np.minimum(y, elevation_at(ground, x))])
    slip[[0, -1], 1] = elevation_at(ground, ENDS)
    outlines = [{"outline_m": between(top, slip, bottom), "material": halved(name, cohesion, friction)}
                for (name, (_, cohesion, friction)), top, bottom in zip(REVIEW.items(), tops, [*tops[1:], None])]
    document = case("layered", "Slope of three soils",
                    "Problem 1(c) of the ACADS review (Giam and Donald 1989): published profile, interfaces, unit "
                    "weight and critical circle. Half of the published strengths, so that the slope fails.",
                    0.25, {"density_kg_m3": 1988, "friction_angle_deg": 20, "viscosity_Pa_s": 1000}, 20, LEFT, numerics={"sound_speed_m_s": 60})
    document["slide"] = {"outlines": outlines}
    write(HERE / "layered-bed.csv", bed(ground, slip))
    (HERE / "layered.json").write_text(json.dumps(document, indent=1) + "\n")


def crossings(line, other):
    """x where two lines cross [m]."""
    x = np.unique(np.concatenate([line[:, 0], other[:, 0]]))
    x = x[(x >= max(line[0, 0], other[0, 0])) & (x <= min(line[-1, 0], other[-1, 0]))]
    gap = elevation_at(line, x) - elevation_at(other, x)
    at = np.flatnonzero(gap[:-1] * gap[1:] < 0)
    return x[at] + (x[at + 1] - x[at]) * gap[at] / (gap[at] - gap[at + 1])


def between(top, slip, bottom):
    """Outline of what lies below `top` and above both `slip` and `bottom` [m]; it is one piece."""
    lines = [line for line in (top, slip, bottom) if line is not None]
    knots = [line[:, 0] for line in lines]
    knots += [crossings(line, other) for line in lines for other in lines if line is not other]
    x = np.unique(np.round(np.concatenate(knots), 4))
    x = x[(x >= slip[0, 0]) & (x <= slip[-1, 0])]
    upper = elevation_at(top, x)
    lower = elevation_at(slip, x)
    if bottom is not None:
        lower = np.maximum(lower, np.minimum(elevation_at(bottom, x), upper))
    thick = upper - lower > 1e-3
    first, last = np.flatnonzero(thick)[[0, -1]]
    keep = slice(max(first - 1, 0), last + 2)
    x, upper, lower = x[keep], upper[keep], lower[keep]
    outline = [*zip(x, upper), *zip(x[::-1], lower[::-1])]
    distinct = [p for p, last in zip(outline, [None, *outline]) if last is None or not np.allclose(p, last, atol=1e-6)]
    return [[round(float(x), 4), round(float(y), 4)] for x, y in distinct]


SECTIONS = (scarp, ledges, river_bank, valley_side, alpine, hill, layered)

if __name__ == "__main__":
    for section in SECTIONS:
        section(pathlib.Path(sys.argv[1]))
