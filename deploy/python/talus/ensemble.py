"""Runs of one case side by side on a common time axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from talus.errors import FileError
from talus.results import Run


def history_ensemble(runs: Mapping[int, Run], *, times_s: Sequence[float] | None = None) -> xr.Dataset:
    """history.csv of several runs, linearly interpolated. A run keeps its last value once it has ended.

    Args:
        runs: by index of the realization
        times_s: the common time axis [s], increasing; None: the rows of the run that lasted longest
    Returns:
        dimensions `realization`, `time` [s]; the columns of history.csv (units in their names), and `ended`: the run
        is over by then
    Raises:
        ValueError: no run; FileError: a run has no history
    """
    histories = {index: run.history for index, run in _checked(runs).items()}
    longest = max(histories.values(), key=lambda history: float(history.index[-1]))
    times = np.asarray(longest.index if times_s is None else times_s, dtype=float)
    names = [name for name in longest.columns if name != "step"]
    columns = {
        name: (("realization", "time"), np.stack([np.interp(times, h.index, h[name]) for h in histories.values()]))
        for name in names
    }
    ended = np.stack([times > float(h.index[-1]) for h in histories.values()])
    coordinates = {"realization": list(histories), "time": ("time", times, {"units": "s"})}
    return xr.Dataset(columns | {"ended": (("realization", "time"), ended)}, coordinates)


def snapshot_ensemble(
    runs: Mapping[int, Run],
    *,
    times_s: Sequence[float] | None = None,
    walls: bool = False,
    fields: Sequence[str] | None = None,
    tolerance_s: float = 0.05,
) -> xr.Dataset:
    """Snapshots of several runs of one case. Nothing is interpolated: at each time stands the first snapshot at or
    after it, or the last one of a run that had ended before. With "time.snapshots_exact": true in the case the times
    are exactly those asked for.

    Args:
        runs: by index of the realization
        times_s: the common time axis [s], increasing; None: the start and the snapshot times of the case
        walls, fields: as for `talus.read_snapshots`
        tolerance_s: how long after its time a snapshot may be [s], >= 0; one time step is typical
    Returns:
        dimensions `realization`, `time` [s], `particle`; the arrays of `talus.read_snapshots`, `time_of_snapshot` [s]
        (its own time, with dimensions `realization`, `time`) and `ended`
    Raises:
        ValueError: no run; FileError: the runs have different particles, or one has no snapshot near a time
    """
    checked = _checked(runs)
    if times_s is None:
        times_s = [0.0, *(t for t in next(iter(checked.values())).case["time"]["snapshot_times_s"] if t > 0.0)]
    axis = np.asarray(times_s, dtype=float)
    parts: list[xr.Dataset] = []
    for index, run in checked.items():
        found = run.snapshots(walls=walls, fields=fields)
        own = found["time"].to_numpy()
        at = np.minimum(np.searchsorted(own, axis), len(own) - 1)
        late = axis[(own[at] > axis + tolerance_s)]
        if len(late):
            raise FileError(
                f"{run.path} has no snapshot near {late[0]:g} s; it has {', '.join(f'{t:g}' for t in own)} s"
            )
        part = found.isel(time=at).drop_vars("step").assign_coords(time=("time", axis, {"units": "s"}))
        part["time_of_snapshot"] = ("time", own[at], {"units": "s"})
        part["ended"] = ("time", axis > own[-1])
        if parts and not np.array_equal(part["particle"], parts[0]["particle"]):
            raise FileError(
                f"{run.path} has other particles than {next(iter(checked.values())).path}: they are of different cases"
            )
        parts.append(part.expand_dims(realization=[index]))
    joined = xr.concat(
        parts,
        "realization",
        combine_attrs="drop_conflicts",
        data_vars="minimal",
        coords="minimal",
        compat="equals",
        join="exact",
    )
    return joined.drop_attrs(deep=False).assign_attrs(
        {k: v for k, v in parts[0].attrs.items() if k in ("title", "version", "seed")}
    )


def _checked(runs: Mapping[int, Run]) -> dict[int, Run]:
    if not runs:
        raise ValueError("there is no run")
    return dict(sorted(runs.items()))
