"""Compares the numbers that surfel reads with those of laspy, pye57 and Open3D.

`surfel convert --bare` writes what it has read: LAS as LAS; everything else as E57, which has coordinates in float64 and intensities of any
range, and as LAS, whose extra bytes have the other properties. laspy and pye57 read these files again. Every number has to be equal;
normals, of which surfel makes unit vectors in single precision, to within two of its steps. Points without a position, and the few vertices
of a mesh that none of its triangles uses, are left out.
"""

import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np


class Refused(Exception):
    """What surfel or the other says of a file that it does not read."""


def convert(program, source, target):
    run = subprocess.run([program, "convert", "--bare", "-q", source, "-o", target], capture_output=True, text=True)
    if run.returncode:
        raise Refused("surfel: " + run.stderr.strip().splitlines()[-1])
    return target


def other(read, *arguments):
    """The result of another's reader, whose errors have many types."""
    try:
        return read(*arguments)
    except Exception as error:
        raise Refused("the other: " + str(error).strip().splitlines()[0]) from error


def same(a, b):
    """Whether two columns have the same numbers; those that are not finite become 0 in LAS."""
    a, b = np.asarray(a, np.float64), np.asarray(b, np.float64)
    return a.shape == b.shape and bool(np.all((a == b) | (~np.isfinite(a) & (b == 0))))


def same_normals(a, b):
    """Whether the normals are the same, or once they are unit vectors; those that are not finite are 0."""
    a, b = np.nan_to_num(np.asarray(a, np.float64)), np.asarray(b, np.float64)
    if a.shape != b.shape:
        return False
    lengths = np.linalg.norm(a, axis=1, keepdims=True)
    units = a / np.where(lengths > 0, lengths, 1)
    return bool(np.all((a == b) | (np.abs(units - b) <= 2.0**-22)))


def las_columns(file):
    """Every dimension of a laspy file, in the names of surfel: arrays are numbered."""
    columns = {}
    for name in file.point_format.dimension_names:
        values = np.asarray(file[name])
        for index, part in enumerate(values.T if values.ndim > 1 else [values]):
            columns[f"{name}_{index}" if values.ndim > 1 else name] = part
    for names in [("nx", "ny", "nz"), ("NormalX", "NormalY", "NormalZ")]:
        if names[0] in columns:
            columns["normals"] = np.stack([columns.pop(name) for name in names], axis=1)
    if "scan_angle" in columns:
        columns["scan_angle"] = columns["scan_angle"] * 0.006
    if "scan_angle_rank" in columns:
        columns["scan_angle"] = columns.pop("scan_angle_rank").astype(np.float64)
    return columns


def of_las(program, path, folder):
    import laspy

    source = other(laspy.read, path)
    if not len(source.points):
        raise Refused("no points")
    result = laspy.read(convert(program, path, os.path.join(folder, "a.las")))
    columns, ours = las_columns(source), las_columns(result)
    for axis in "xyz":
        columns[axis], ours[axis] = np.asarray(source[axis]), np.asarray(result[axis])
    colours = ("red", "green", "blue")
    if not any(columns.get(name, np.zeros(1)).any() for name in colours):
        for name in colours:
            columns.pop(name, None), ours.pop(name, None)
    # Fields of wave packets, which surfel leaves out with a warning.
    left_out = [name for name in columns if "wave" in name or name in ("x_t", "y_t", "z_t")]
    return len(source.points), "laspy", {name: (columns[name], ours.get(name)) for name in columns if name not in left_out}


def of_e57(program, path, folder):
    import pye57

    source = other(pye57.E57, path)
    if not source.scan_count or not any(source.get_header(scan).point_count for scan in range(source.scan_count)):
        raise Refused("no points")
    result = pye57.E57(convert(program, path, os.path.join(folder, "a.e57")))
    pairs, points = {}, 0
    for scan in range(source.scan_count):
        theirs, ours = other(source.read_scan_raw, scan, True), result.read_scan_raw(scan, ignore_unsupported_fields=True)
        kept = theirs.get("cartesianInvalidState", theirs.get("sphericalInvalidState", np.zeros(1))) == 0
        kept = np.broadcast_to(kept, len(next(iter(theirs.values()))))
        header, written = source.get_header(scan), result.get_header(scan)
        pairs[f"pose {scan}"] = (np.r_[header.rotation, header.translation], np.r_[written.rotation, written.translation])
        for name, values in theirs.items():
            if "Invalid" not in name:
                pairs[f"{name} {scan}"] = (values[kept], ours.get(name))
        points += int(kept.sum())
    return points, "pye57", pairs


def vertices(path):
    """The points of a file by Open3D in float64, its other columns, and which of the points surfel keeps."""
    import open3d

    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
    columns = {name: values.numpy() for name, values in other(open3d.t.io.read_point_cloud, path).point.items()}
    positions = columns.pop("positions").astype(np.float64)
    if not path.endswith(".pcd"):
        # The reader of all columns has single precision also where the file has more.
        positions = np.asarray(other(open3d.io.read_point_cloud, path).points)
    kept = np.isfinite(positions).all(axis=1)
    if path.endswith(".ply"):
        used = np.isin(np.arange(len(positions)), np.asarray(open3d.io.read_triangle_mesh(path).triangles))
        if used.mean() >= 0.9:
            kept &= used
    return positions, columns, kept


def of_open3d(program, path, folder):
    import laspy
    import pye57

    positions, columns, kept = vertices(path)
    if not kept.any():
        raise Refused("no points")
    in_e57 = pye57.E57(convert(program, path, os.path.join(folder, "a.e57"))).read_scan_raw(0, ignore_unsupported_fields=True)
    in_las = las_columns(laspy.read(convert(program, path, os.path.join(folder, "a.las"))))
    pairs = {name: (positions[kept, axis], in_e57[f"cartesian{name.upper()}"]) for axis, name in enumerate("xyz")}
    for name, values in columns.items():
        values = values[kept]
        if name == "colors":
            codes = values if values.dtype == np.uint8 else np.round(values * 255)
            pairs |= {code: (codes[:, axis], in_e57.get(f"color{code}")) for axis, code in enumerate(["Red", "Green", "Blue"])}
        elif name == "normals":
            pairs[name] = (values, in_las.get(name))
        elif name in ("intensity", "intensities", "scalar_intensity"):
            pairs[name] = (values[:, 0], in_e57.get("intensity"))
        else:
            pairs[name] = (values[:, 0], in_las.get(name))
    return int(kept.sum()), "Open3D", pairs


READERS = {".las": of_las, ".laz": of_las, ".e57": of_e57}
READERS |= dict.fromkeys([".pcd", ".ply", ".pts", ".xyz", ".xyzn", ".xyzrgb"], of_open3d)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="surfel")
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    print("| file | reader | points | columns | that differ |")
    print("|---|---|---|---|---|")
    differ = 0
    for path in arguments.files:
        with tempfile.TemporaryDirectory() as folder:
            try:
                points, reader, pairs = READERS[os.path.splitext(path)[1]](arguments.program, path, folder)
            except Refused as reason:
                print(f"| {os.path.basename(path)} | | | | not compared: {reason} |", flush=True)
                continue
        wrong = [
            name
            for name, (theirs, ours) in pairs.items()
            if ours is None or not (same_normals if name == "normals" else same)(theirs, ours)
        ]
        differ += len(wrong)
        if len({len(column) for pair in pairs.values() for column in pair if column is not None}) > 1 and "x" in pairs:
            wrong = [f"{len(pairs['x'][0])} points there, {len(pairs['x'][1])} here"]
        print(f"| {os.path.basename(path)} | {reader} | {points} | {len(pairs)} | {', '.join(wrong)} |", flush=True)
    sys.exit(bool(differ))


if __name__ == "__main__":
    main()
