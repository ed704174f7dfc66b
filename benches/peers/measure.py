"""Measures the CPU time and the error of a frame beside VTK's square points, and prints Markdown tables.

The time of a frame is the difference of the times (user and system) of two runs of a process, divided by the difference of their numbers of
frames, with reading back included. The programs alternate. VTK gets the points once in random order and once sorted along a Morton curve, with
points as wide as the discs of surfel. Errors are against the ray-traced surface with a box filter, and are measured for the built-in scene.
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys

FEW, MANY = 3, 13
SIZE = 1024


def cpu(command):
    """Milliseconds of user and system time of a command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def frame(command):
    """Milliseconds of a frame of a command whose last argument is the number of frames."""
    few, many = [cpu([*command, str(frames)]) for frames in (FEW, MANY)]
    return (many - few) / (MANY - FEW)


def summary(values):
    return f"{statistics.median(values):.1f} ({min(values):.1f}–{max(values):.1f})"


def errors(surfel, picture, truth):
    """RMSE and FLIP of a picture."""
    command = [surfel, "compare", picture, truth, "--background", "white", "--json", "-"]
    compared = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return [f"{compared['metrics'][name]:.4f}" for name in ("rmse", "flip")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surfel", help="the program")
    parser.add_argument("folder", help="for files in between")
    parser.add_argument("inputs", nargs="*", help="name=file=px: a PLY file and the width of its discs on the picture")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()

    eye = "1.7078,1.3663,2.7325"
    sphere = ["--eye", eye, "--target", "0,0,0"]
    cases = []
    for points, width in [(100_000, 13), (1_000_000, 4)]:
        path = os.path.join(arguments.folder, f"{points}.ply")
        subprocess.run([arguments.surfel, "convert", f"scene:bumpy-sphere?points={points}", "-o", path], check=True, stderr=subprocess.DEVNULL)
        cases.append((f"`scene:bumpy-sphere?points={points}`", path, width, sphere, ["--eye", eye]))
    for text in arguments.inputs:
        name, path, width = text.split("=")
        cases.append((name, path, float(width), [], []))

    truth = os.path.join(arguments.folder, "truth.exr")
    command = [arguments.surfel, "truth", "scene:bumpy-sphere", *sphere, "--size", f"{SIZE}x{SIZE}", "--filter", "box"]
    command += ["--shading", "color", "--background", "white", "--quiet", "-o", truth]
    subprocess.run(command, check=True)

    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "vtk_points.py")
    print("| input | surfel | VTK, shuffled | VTK, sorted | surfel / shuffled | surfel / sorted |")
    print("|---|---|---|---|---|---|")
    compared = []
    for name, path, width, camera, vtk_camera in cases:
        picture = os.path.join(arguments.folder, "picture.png")
        surfel = [arguments.surfel, "render", path, *camera, "--size", f"{SIZE}x{SIZE}", "--shading", "color"]
        surfel += ["--background", "white", "--quiet", "-o", picture, "--frames"]
        vtk = [sys.executable, script, path, "--width", str(width), *vtk_camera]
        commands = [surfel, [*vtk, "--order", "shuffled", "--frames"], [*vtk, "--order", "sorted", "--frames"]]
        for command in commands:
            cpu([*command, "1"])  # fills caches
        times = [[], [], []]
        for _ in range(arguments.repeats):
            for command, list_of_times in zip(commands, times):
                list_of_times.append(frame(command))
        ratios = [statistics.median(a / b for a, b in zip(times[0], other)) for other in times[1:]]
        columns = [name, *map(summary, times), *(f"{ratio:.2f}" for ratio in ratios)]
        print("| " + " | ".join(columns) + " |", flush=True)
        if vtk_camera:
            compared.append((name, "surfel", *errors(arguments.surfel, picture, truth)))
            subprocess.run([*commands[2], "1", "--picture", picture], check=True)
            compared.append((name, "VTK", *errors(arguments.surfel, picture, truth)))
    print("\n| input | renderer | RMSE | FLIP |\n|---|---|---|---|")
    for row in compared:
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
