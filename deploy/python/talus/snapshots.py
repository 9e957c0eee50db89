"""snapshots.vtkhdf as xarray. The layout is described at the top of solver/io/vtkhdf.hpp."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import h5py
import numpy as np
import xarray as xr

from talus.errors import FileError

_STRESS = ["xx", "yy", "zz", "xy", "yz", "xz"]
_AXES = {1: (), 3: ("axis",), 6: ("component",)}
_CONSTANT = ("id", "is_wall")


def read_snapshots(
    path: str | os.PathLike[str], *, walls: bool = False, fields: Sequence[str] | None = None
) -> xr.Dataset:
    """The snapshots of a run. The file may still grow, or be left by a process that was killed: its complete steps are
    read.

    Args:
        walls: also the particles of the walls
        fields: names of the arrays to read (`position` among them); None: all
    Returns:
        dimensions `time`, `particle`, and of vectors `axis` (x, y), of `stress` `component` (xx, yy, zz, xy).
        `position` and `displacement` [m], `velocity` [m/s], `density` [kg/m3], `pressure` [Pa], `friction_angle_deg`
        [deg], `shear_rate` [1/s], `stress` [Pa, positive in tension]; the attribute `units` of each has its unit.
        Coordinates `time` [s], `step`, `particle` (its number), `is_wall`. Attributes title, version, case_hash, seed
        and realization where the file has them.
    Raises:
        FileError: it is missing, damaged or not such a file, or has no field of a name
    Thread-safe as far as h5py is.
    """
    try:
        with h5py.File(path, "r", locking=False) as file:
            return _read(file, walls, fields)
    except KeyError as missing:
        raise FileError(f"{os.fspath(path)} is not a file of snapshots of Talus: {missing.args[0]}") from missing
    except OSError as error:
        raise FileError(f"{os.fspath(path)} cannot be read: {error}") from error


def _read(file: Any, walls: bool, fields: Sequence[str] | None) -> xr.Dataset:
    grid, steps = file["VTKHDF"], file["VTKHDF/Steps"]
    count = int(steps.attrs["NSteps"])
    is_wall = grid["PointData/is_wall"][:].astype(bool)
    kept = np.ones_like(is_wall) if walls else ~is_wall
    arrays = {"position": grid["Points"]} | {
        name: data for name, data in grid["PointData"].items() if name not in _CONSTANT
    }
    unknown = set(fields or ()) - set(arrays)
    if unknown:
        raise FileError(f"{file.filename} has no field {', '.join(sorted(unknown))}; it has {', '.join(arrays)}")
    variables = {}
    for name in fields if fields is not None else arrays:
        data = arrays[name]
        columns = 1 if data.ndim == 1 else data.shape[1]
        values = data[: count * len(is_wall)].reshape(count, len(is_wall), columns)[:, kept]
        shown = {1: values[..., 0], 3: values[..., :2], 6: values[..., :4]}[columns]  # the section is plane
        attributes = {"units": _text(data.attrs["units"])} if "units" in data.attrs else {}
        variables[name] = (("time", "particle", *_AXES[columns]), shown, attributes)
    coordinates = {
        "time": ("time", steps["Values"][:count], {"units": "s"}),
        "step": ("time", file["talus/step"][:count]),
        "particle": grid["PointData/id"][:][kept],
        "is_wall": ("particle", is_wall[kept]),
        "axis": ["x", "y"],
        "component": _STRESS[:4],
    }
    used = {axis for dimensions, *_ in variables.values() for axis in dimensions} | {"time", "particle"}
    coordinates = {k: v for k, v in coordinates.items() if k not in ("axis", "component") or k in used}
    return xr.Dataset(variables, coordinates, {name: _text(value) for name, value in file["talus"].attrs.items()})


def _text(value: Any) -> Any:
    """An attribute as Python's own type; text of fixed length comes as bytes."""
    if isinstance(value, bytes):
        return value.decode("utf-8")
    return value.item() if isinstance(value, np.generic) else value
