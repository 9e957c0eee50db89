#!/usr/bin/env python3
"""VTK's own reader, not ours, reads the snapshots; every array at every step must follow from the formulas of known_frame.hpp.
The XDMF sidecar is read twice: its hyperslabs by hand, with h5py, and by VTK's XDMF reader where VTK has one.
usage: test_vtkhdf_vtk.py PATH/TO/write_known_snapshots"""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

ORIGIN = np.array([2_683_000.0, 1_247_000.0, 0.0])  # of far.vtkhdf
N, N_SOIL, STEPS = 3000, 2000, 70  # more steps than HDF5 puts into one chunk of the step lists


def known(channel, k):
    return (1.0 if channel % 2 == 0 else -1.0) * (4096.0 * channel + np.arange(N) + k / 64.0)


def expected(k):
    """Arrays of step k by name, as VTK must show them."""
    def vector(channel):
        return np.column_stack([known(channel, k), known(channel + 1, k), np.zeros(N)])

    return {
        "Points": vector(0),
        "displacement": vector(2),
        "velocity": vector(4),
        "density": known(6, k),
        "pressure": known(7, k),
        "friction_angle_deg": np.arange(N) % 128 / 4.0 + k / 64.0,
        "cohesion_Pa": known(13, k),
        "shear_rate": known(8, k),
        "stress": np.column_stack([known(9, k), known(10, k), known(11, k), known(12, k), np.zeros(N), np.zeros(N)]),
        "is_wall": np.where(np.arange(N) < N_SOIL, 0, 1),
        "id": np.arange(N),
    }


def expected_in_xdmf(k):
    """The same with the stress as scalars."""
    arrays = expected(k)
    stress = arrays.pop("stress")
    for column, name in enumerate(["stress_xx", "stress_yy", "stress_zz", "stress_xy"]):
        arrays[name] = stress[:, column]
    return arrays


def compare(found, wanted, where):
    assert sorted(found) == sorted(wanted), f"{where}: arrays {sorted(found)}, wanted {sorted(wanted)}"
    for name, values in wanted.items():
        got = np.asarray(found[name])
        assert got.shape == values.shape, f"{where}: {name} has shape {got.shape}, wanted {values.shape}"
        # Everything is exact in float32 but the angle, which was in radians once.
        tolerance = 1e-5 if name == "friction_angle_deg" else 0.0
        worst = np.abs(got.astype(float) - values).max()
        assert worst <= tolerance, f"{where}: {name} is off by {worst}"


def arrays_of(grid):
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    return arrays | {"Points": vtk_to_numpy(grid.GetPoints().GetData())}


def check_times(times):
    assert len(times) == STEPS and all(t == k / 10 for k, t in enumerate(times)), f"times {times}"


def check_vtkhdf(path):
    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    check_times(times)
    for k in [*range(STEPS), 3, STEPS - 1, 0]:  # and back again: a person drags the slider
        reader.UpdateTimeStep(times[k])
        grid = reader.GetOutput()
        assert grid.GetClassName() == "vtkUnstructuredGrid" and grid.GetNumberOfCells() == N
        assert grid.GetCellType(N - 1) == 1 and grid.GetCell(N - 1).GetPointId(0) == N - 1, "the last cell is not its vertex"
        assert grid.GetPointData().GetArray("density").GetDataTypeAsString() == "float"
        compare(arrays_of(grid), expected(k), f"{path} step {k}")


def hyperslab(item, directory):
    """What an XDMF reader does with <DataItem ItemType="HyperSlab">."""
    selection, source = item.findall("DataItem")
    start, stride, count = np.array(selection.text.split(), int).reshape(3, -1)
    file, path = source.text.strip().split(":")
    with h5py.File(os.path.join(directory, file)) as h5:
        data = h5[path]
        assert list(data.shape) == [int(d) for d in source.get("Dimensions").split()], f"{path}: shape {data.shape}"
        assert data.dtype.itemsize == int(source.get("Precision"))
        assert data.dtype.kind == {"Float": "f", "Int": "i"}[source.get("NumberType")]
        part = data[tuple(slice(s, s + c * d, d) for s, d, c in zip(start, stride, count))]
    return part.reshape([int(d) for d in item.get("Dimensions").split()])


def check_xdmf_by_hand(path):
    steps = ElementTree.parse(path).getroot().findall("Domain/Grid/Grid")
    check_times([float(step.find("Time").get("Value")) for step in steps])
    for k, step in enumerate(steps):
        assert step.find("Topology").get("NumberOfElements") == str(N)
        arrays = {a.get("Name"): hyperslab(a.find("DataItem"), os.path.dirname(path)) for a in step.findall("Attribute")}
        arrays["Points"] = hyperslab(step.find("Geometry/DataItem"), os.path.dirname(path))
        compare(arrays, expected_in_xdmf(k), f"{path} step {k}")


def check_xdmf_with_vtk(path):
    try:
        from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    except ImportError:
        return "no XDMF reader in this VTK"
    reader = vtkXdmfReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    check_times(times)
    for k in range(STEPS):
        reader.UpdateTimeStep(times[k])
        output = reader.GetOutputDataObject(0)
        grid = output if output.IsA("vtkPointSet") else output.NewIterator().GetCurrentDataObject()
        compare(arrays_of(grid), expected_in_xdmf(k), f"{path} step {k} (VTK)")
    return "XDMF too"


def check_far(directory):
    """Points on a national grid are in its coordinates, to the micrometre, in both files."""
    micrometre = np.array([1e-6, 1e-6, 0.0])
    reader = vtkHDFReader()
    reader.SetFileName(f"{directory}/far.vtkhdf")
    steps = ElementTree.parse(f"{directory}/far.xdmf").getroot().findall("Domain/Grid/Grid")
    assert len(steps) == 4, f"{len(steps)} steps"
    for k, step in enumerate(steps):
        reader.UpdateTimeStep(k / 10)
        for points in (arrays_of(reader.GetOutput())["Points"], hyperslab(step.find("Geometry/DataItem"), directory)):
            worst = np.abs(points - (expected(k)["Points"] + ORIGIN + micrometre)).max()
            assert worst < 1e-8, f"far.vtkhdf step {k}: points are off by {worst} m"


def check_points(path):
    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.Update()
    wanted = expected(1)
    compare(arrays_of(reader.GetOutput()), {"Points": wanted["Points"], "tan_phi": wanted["density"], "friction_angle_deg": wanted["shear_rate"]}, path)


def main(writer):
    with tempfile.TemporaryDirectory() as directory:
        subprocess.run([writer, directory, str(N), str(N_SOIL), str(STEPS)], check=True)
        check_vtkhdf(f"{directory}/snapshots.vtkhdf")
        check_xdmf_by_hand(f"{directory}/snapshots.xdmf")
        note = check_xdmf_with_vtk(f"{directory}/snapshots.xdmf")
        check_far(directory)
        check_points(f"{directory}/points.vtkhdf")
    print(f"VTK {vtkVersion.GetVTKVersion()} read {STEPS} steps of {N} particles, every array as written; {note}")


if __name__ == "__main__":
    main(sys.argv[1])
