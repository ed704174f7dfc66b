"""Compares readers of files of scans, and prints a Markdown table.

The files are written by laspy, pye57 and Open3D: a rough surface with colours, intensities, and in LAS and LAZ with classes, returns and times.
Every reader reads a file in a process of its own, from the page cache; the readers of a file take turns. Times are those of reading alone,
without the start of the process and its imports; so is memory: the most that the process had beyond what it had before, over the size of the
result. Every result has the positions as arrays of numbers, and the colours where the reader has them.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import time


def surface(points):
    """Positions and colours in arbitrary order of a scanner's lines, m."""
    import numpy as np

    side = int(points**0.5) + 1
    random = np.random.default_rng(1)
    i = np.arange(points)
    x, y = (i % side) * 0.01 + 3500.0, (i // side) * 0.01 + 8200.0
    z = 12.0 + np.sin(0.7 * x) + np.cos(0.4 * y) + random.normal(0.0, 0.003, points)
    x, y = x + random.normal(0.0, 0.002, points), y + random.normal(0.0, 0.002, points)
    code = (np.stack([np.sin(x), np.cos(y), np.sin(x + y)], axis=1) * 100 + 128 + random.normal(0.0, 4.0, (points, 3))).astype(np.uint8)
    return np.stack([x, y, z], axis=1), code


def write_las(folder, positions, code):
    import laspy
    import numpy as np

    header = laspy.LasHeader(point_format=7, version="1.4")
    header.scales, header.offsets = [0.001] * 3, [3000.0, 8000.0, 0.0]
    file = laspy.LasData(header)
    file.x, file.y, file.z = positions.T
    file.red, file.green, file.blue = code.T.astype(np.uint16) * 257
    i = np.arange(len(positions))
    file.intensity = code[:, 0].astype(np.uint16) * 16
    file.return_number, file.number_of_returns = 1 + i % 2, np.full(len(i), 2)
    file.classification = code[:, 1] % 8
    file.gps_time = i * 1e-5
    file.write(os.path.join(folder, "scan.las"))
    file.write(os.path.join(folder, "scan.laz"), laz_backend=laspy.LazBackend.LazrsParallel)


def write_e57(folder, positions, code):
    import pye57

    file = pye57.E57(os.path.join(folder, "scan.e57"), mode="w")
    data = dict(zip(["cartesianX", "cartesianY", "cartesianZ"], positions.T))
    data |= dict(zip(["colorRed", "colorGreen", "colorBlue"], code.T))
    file.write_scan_raw(data | {"intensity": code[:, 0] / 255.0})
    file.close()


def write_ply(folder, positions, code):
    import open3d

    cloud = open3d.geometry.PointCloud()
    cloud.points = open3d.utility.Vector3dVector(positions)
    cloud.colors = open3d.utility.Vector3dVector(code / 255.0)
    open3d.io.write_point_cloud(os.path.join(folder, "scan.ply"), cloud)


def read_laspy(path, backend=None):
    import laspy
    import numpy as np

    def read():
        file = laspy.read(path) if backend is None else laspy.read(path, laz_backend=getattr(laspy.LazBackend, backend))
        positions = np.stack([file.x, file.y, file.z], axis=1)
        return positions, np.stack([file.red, file.green, file.blue], axis=1)

    return read


def read_pye57(path):
    import pye57

    return lambda: list(pye57.E57(path).read_scan(0, intensity=True, colors=True, ignore_missing_fields=True).values())


def read_open3d(path):
    import numpy as np
    import open3d

    def read():
        cloud = open3d.io.read_point_cloud(path)
        return [np.asarray(cloud.points), np.asarray(cloud.colors), cloud]

    return read


READERS = {
    "laspy": read_laspy,
    "laspy, lazrs": lambda path: read_laspy(path, "LazrsParallel"),
    "laspy, laszip": lambda path: read_laspy(path, "Laszip"),
    "pye57": read_pye57,
    "Open3D": read_open3d,
}

FILES = {
    "scan.las": ["laspy"],
    "scan.laz": ["laspy, lazrs", "laspy, laszip"],
    "scan.e57": ["pye57"],
    "scan.ply": ["Open3D"],
}


def status(name):
    """A line of the process's status, bytes."""
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) * 1024 for line in file if line.startswith(name))


def measure(name, path):
    """Prints what a reader needs, as JSON."""
    read = READERS[name](path)
    before, wall, cpu = status("VmRSS"), time.perf_counter(), time.process_time()
    result = read()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    size = sum(part.nbytes for part in result if hasattr(part, "nbytes"))
    print(json.dumps({"wall": wall, "cpu": cpu, "peak": status("VmHWM") - before, "result": size, "points": len(result[0])}))


def run(command):
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1])


def summary(values):
    return f"{statistics.median(values):.2f} ({min(values):.2f}–{max(values):.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reader", help="the bench of surfel's readers")
    parser.add_argument("folder", help="for the files")
    parser.add_argument("points", type=int)
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    positions, code = surface(arguments.points)
    for write in [write_las, write_e57, write_ply]:
        write(arguments.folder, positions, code)
    del positions, code

    print("| file | reader | CPU s | wall s | memory, MB | memory / result | CPU, wall of surfel / its |")
    print("|---|---|---|---|---|---|---|")
    for file, others in FILES.items():
        path = os.path.join(arguments.folder, file)
        commands = {"surfel": [arguments.reader, "--once", path]}
        commands |= {name: [sys.executable, __file__, "--measure", name, path] for name in others}
        runs = {name: [] for name in commands}
        for _ in range(arguments.repeats + 1):
            for name, command in commands.items():
                runs[name].append(run(command))
        for name, all_runs in runs.items():
            # The first turn fills the page cache.
            all_runs = all_runs[1:]
            assert all(one["points"] == arguments.points for one in all_runs), name
            of = {key: [one[key] for one in all_runs] for key in all_runs[0]}
            own = runs["surfel"][1:]
            ratios = [statistics.median(a[key] / b[key] for a, b in zip(own, all_runs)) for key in ("cpu", "wall")]
            peak = statistics.median(of["peak"])
            cells = [file, name, summary(of["cpu"]), summary(of["wall"]), f"{peak / 1e6:.0f}", f"{peak / of['result'][0]:.2f}"]
            cells.append("" if name == "surfel" else ", ".join(f"{ratio:.2f}" for ratio in ratios))
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "--measure":
        measure(sys.argv[2], sys.argv[3])
    else:
        main()
