"""Time to read a million particles: limpid against meshio, VTK's, splashsurf's and NumPy's readers on the same files.

    pip install meshio numpy pysplashsurf vtk
    python crates/limpid-io/examples/reading.py [FOLDER]

Writes the files into FOLDER (default: a temporary one), reads each with all programs in turns, and prints the table of
docs/formats.md: least times, so that the files come from the system's cache and a busy moment harms nobody. Each reader gives
positions, velocity and density as arrays; splashsurf reads positions alone, and is timed as it converts what lies in a box without
particles. limpid's memory is that of a process that reads nothing else. As in the processes of the others, which grow larger, memory that
limpid has freed is used again and not handed back to the system.
"""

import json
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
TURNS = 6
KEEPS_MEMORY = {"MALLOC_TRIM_THRESHOLD_": "1000000000", "MALLOC_MMAP_THRESHOLD_": "1000000000"}
SPLASHSURF = """
import sys, time, pysplashsurf
start = time.perf_counter()
pysplashsurf.run_splashsurf(sys.argv[1:])
print(1e3 * (time.perf_counter() - start))
"""


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
    write_bgeo(path("bare.bgeo"), positions, velocity, density)
    with open(path("array.json"), "w") as file:
        json.dump(positions.tolist(), file)
    names = ["binary.vtk", "ascii.vtk", "inline_zlib.vtu", "raw.vtp", "lz4.vtp", "zlib.vtp", "binary.ply", "ascii.ply"]
    return [path(name) for name in names + ["bare.bgeo", "array.json", "plain.npz", "packed.npz"]]


def write_bgeo(path, positions, velocity, density):
    declared = [("velocity", 3, 5), ("density", 1, 0)]
    with open(path, "wb") as file:
        file.write(b"BgeoV" + numpy.array([5, COUNT, 0, 0, 0, len(declared), 0, 0, 0], ">i4").tobytes())
        for name, components, kind in declared:
            file.write(len(name).to_bytes(2, "big") + name.encode() + components.to_bytes(2, "big"))
            file.write(kind.to_bytes(4, "big") + bytes(4 * components))
        rows = numpy.hstack([positions, numpy.ones((COUNT, 1)), velocity, density.reshape(-1, 1)])
        file.write(rows.astype(">f4").tobytes() + b"\x00\xff")


def ms(read):
    start = time.perf_counter()
    said = read()
    # What another process reads, it times itself.
    return float(said) if isinstance(said, str) else 1e3 * (time.perf_counter() - start)


def with_meshio(path):
    if path.endswith((".vtp", ".npz", ".bgeo", ".json")):
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


def with_splashsurf(path):
    # It knows no .vtp; of the encodings of .vtu and .ply it reads what it reads.
    if path.endswith((".vtp", ".npz")):
        return None
    out = os.path.join(os.path.dirname(path), "none.vtk")
    box = ["--domain-min", "8", "8", "8", "--domain-max", "9", "9", "9"]
    command = ["splashsurf", "convert", "--quiet", "--overwrite", "--particles", path, "-o", out, *box]
    # Once in each process is all that it runs.
    return lambda: subprocess.run([sys.executable, "-c", SPLASHSURF, *command], check=True, capture_output=True, text=True).stdout


def with_numpy(path):
    return (lambda: dict(numpy.load(path))) if path.endswith(".npz") else None


def time_read(path, environment):
    command = ["cargo", "run", "--quiet", "--release", "-p", "limpid-io", "--example", "time_read", "--", path]
    said = subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout.split()
    return int(said[0]), float(said[1]), float(said[2])


def main(folder):
    print("| file | MB | limpid, ms | its memory, MiB | meshio, ms | VTK, ms | splashsurf, ms | NumPy, ms |\n" + 8 * "|---" + "|")
    for path in write_files(folder):
        readers = [reader(path) for reader in (with_meshio, with_vtk, with_splashsurf, with_numpy)]
        limpid, least = float("inf"), [float("inf")] * len(readers)
        _, _, memory = time_read(path, os.environ)
        for _ in range(TURNS):
            count, time, _ = time_read(path, os.environ | KEEPS_MEMORY)
            assert count == COUNT, path
            limpid = min(limpid, time)
            least = [min(so_far, ms(read)) if read else so_far for so_far, read in zip(least, readers)]
        others = ["" if read is None else f"{best:.0f} ({best / limpid:.1f} x)" for best, read in zip(least, readers)]
        size = os.path.getsize(path) / 1e6
        print(f"| `{os.path.basename(path)}` | {size:.0f} | {limpid:.0f} | {memory:.0f} | {' | '.join(others)} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(sys.argv[1])
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(folder)
