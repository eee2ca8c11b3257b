"""Time to read a million particles: limpid against meshio, VTK's and NumPy's readers on the same files.

    pip install meshio numpy vtk
    python crates/limpid-io/examples/reading.py [FOLDER]

Writes the files into FOLDER (default: a temporary one), reads each five times with each program, and prints the table of
docs/formats.md: least times, so that the files come from the system's cache. Each reader gives positions, velocity and density
as arrays. limpid's memory is that of a process that reads nothing else.
"""

import os
import subprocess
import sys
import tempfile
import time

import meshio
import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

COUNT = 1_000_000
RUNS = 5


def particles():
    random = numpy.random.default_rng(1)
    positions = random.random((COUNT, 3), dtype=numpy.float32)
    return positions, random.random((COUNT, 3), dtype=numpy.float32), random.random(COUNT, dtype=numpy.float32)


def write_files(folder):
    positions, velocity, density = particles()
    path = lambda name: os.path.join(folder, name)
    cells = [("vertex", numpy.arange(COUNT).reshape(-1, 1))]
    mesh = meshio.Mesh(positions, cells, point_data={"velocity": velocity, "density": density})
    mesh.write(path("binary.vtk"), file_format="vtk42", binary=True)
    mesh.write(path("ascii.vtk"), file_format="vtk42", binary=False)
    mesh.write(path("inline_zlib.vtu"), file_format="vtu", compression="zlib")
    # meshio's PLY knows one number for each point and property.
    plain = meshio.Mesh(positions, [], point_data={"density": density})
    plain.write(path("binary.ply"), file_format="ply", binary=True)
    plain.write(path("ascii.ply"), file_format="ply", binary=False)

    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(positions))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    for name, values in [("velocity", velocity), ("density", density)]:
        array = numpy_to_vtk(values)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    for name, compressor in [("raw.vtp", None), ("lz4.vtp", vtk.vtkLZ4DataCompressor()), ("zlib.vtp", vtk.vtkZLibDataCompressor())]:
        writer = vtk.vtkXMLPolyDataWriter()
        writer.SetFileName(path(name))
        writer.SetInputData(data)
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
        writer.SetCompressor(compressor)
        writer.Write()
    numpy.savez(path("plain.npz"), positions=positions, velocity=velocity, density=density)
    numpy.savez_compressed(path("packed.npz"), positions=positions, velocity=velocity, density=density)
    names = ["binary.vtk", "ascii.vtk", "inline_zlib.vtu", "raw.vtp", "lz4.vtp", "zlib.vtp"]
    return [path(name) for name in names + ["binary.ply", "ascii.ply", "plain.npz", "packed.npz"]]


def least_ms(read):
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        read()
        times.append(1e3 * (time.perf_counter() - start))
    return min(times)


def with_meshio(path):
    if path.endswith((".vtp", ".npz")):
        return None
    return lambda: meshio.read(path)


def with_vtk(path):
    kinds = {".vtk": vtk.vtkGenericDataObjectReader, ".vtu": vtk.vtkXMLUnstructuredGridReader}
    kinds |= {".vtp": vtk.vtkXMLPolyDataReader, ".ply": vtk.vtkPLYReader}
    kind = kinds.get(os.path.splitext(path)[1])

    def read():
        reader = kind()
        reader.SetFileName(path)
        if path.endswith(".vtk"):
            reader.SetReadAllScalars(True)
            reader.SetReadAllVectors(True)
        reader.Update()
        output = reader.GetOutput()
        arrays = output.GetPointData()
        return vtk_to_numpy(output.GetPoints().GetData()), [arrays.GetArray(i) for i in range(arrays.GetNumberOfArrays())]

    return read if kind else None


def with_numpy(path):
    return (lambda: dict(numpy.load(path))) if path.endswith(".npz") else None


def main(folder):
    run = ["cargo", "run", "--quiet", "--release", "-p", "limpid-io", "--example", "time_read", "--"]
    print("| file | MB | limpid, ms | its memory, MiB | meshio, ms | VTK, ms | NumPy, ms |\n|---|---|---|---|---|---|---|")
    for path in write_files(folder):
        said = subprocess.run(run + [path], check=True, capture_output=True, text=True).stdout.split()
        assert int(said[0]) == COUNT, path
        limpid = float(said[1])
        cells = []
        for reader in (with_meshio, with_vtk, with_numpy):
            read = reader(path)
            ms = least_ms(read) if read else None
            cells.append("" if ms is None else f"{ms:.0f} ({ms / limpid:.1f} x)")
        size = os.path.getsize(path) / 1e6
        print(f"| `{os.path.basename(path)}` | {size:.0f} | {limpid:.0f} | {float(said[2]):.0f} | {' | '.join(cells)} |")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(sys.argv[1])
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(folder)
