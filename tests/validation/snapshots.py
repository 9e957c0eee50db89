"""What the experiments read from snapshots.vtkhdf."""

import json
import pathlib

import h5py
import numpy as np


class Snapshots:
    """Soil particles of a run over time; arrays by particle, in the order of their identities."""

    def __init__(self, directory):
        directory = pathlib.Path(directory)
        self.soil = json.loads((directory / "result.json").read_text())["particles"]["soil"]
        self._file = h5py.File(directory / "snapshots.vtkhdf")["VTKHDF"]
        self.times = self._file["Steps/Values"][:]

    def _soil(self, data, step, offsets):
        offset = int(self._file[offsets][step])
        return self._file[data][offset:offset + self.soil]

    def position(self, step):
        """(particles, 2) [m]"""
        return self._soil("Points", step, "Steps/PointOffsets")[:, :2]

    def field(self, name, step):
        return self._soil(f"PointData/{name}", step, f"Steps/PointDataOffsets/{name}")


def surface(position, x, spacing):
    """Height of the topmost particle in a window of two spacings around each x, half a spacing added; 0 where there is none."""
    heights = np.zeros(len(x))
    for k, at in enumerate(x):
        near = np.abs(position[:, 0] - at) < spacing
        if near.any():
            heights[k] = position[near, 1].max() + 0.5 * spacing
    return heights
