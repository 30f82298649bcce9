#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the processor time of a run through the Python module with that of rgbd_tum.

    PYTHONPATH=build/release/python bench/python_overhead.py SEQUENCE MASKS [--repeat N]

Both read the same sequence in TUM's format with the same masks, map it sequentially and write the
trajectory, whose bytes must be equal. The least time of all repetitions counts. The start of Python
(imports, settings) is left out, because a run pays it once.
"""

import argparse
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import hullslam

ROOT = pathlib.Path(__file__).resolve().parents[1]


def seconds(usage):
    return usage.ru_utime + usage.ru_stime


def run_module(sequence, masks, output):
    """Returns the processor time (s) of the run, and the number of frames."""
    settings = hullslam.Settings(hullslam.default_settings(sequence))
    begin = seconds(resource.getrusage(resource.RUSAGE_SELF))
    images = hullslam.open_tum(sequence, settings)
    slam = hullslam.System(settings)
    for frame, found in zip(images, hullslam.open_masks(masks, images)):
        slam.track(frame.image, frame.depth, found, timestamp=frame.timestamp)
    slam.finish()
    slam.trajectory.write(output)
    return seconds(resource.getrusage(resource.RUSAGE_SELF)) - begin, len(images)


def run_program(program, sequence, masks, output):
    """Returns the processor time (s) of the run."""
    command = [program, sequence, "--masks", masks, "--output", output, "--quiet"]
    with subprocess.Popen([str(word) for word in command]) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{program} has failed with exit code {process.returncode}")
    return seconds(usage)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", type=pathlib.Path)
    parser.add_argument("masks", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--program", type=pathlib.Path, metavar="FILE",
                        default=ROOT / "build" / "release" / "bin" / "rgbd_tum")
    arguments = parser.parse_args()
    module, program = [], []
    with tempfile.TemporaryDirectory() as folder:
        output, trajectory = pathlib.Path(folder) / "out", pathlib.Path(folder) / "a.txt"
        for _ in range(arguments.repeat):
            program.append(run_program(arguments.program, arguments.sequence, arguments.masks,
                                       output))
            time, frames = run_module(arguments.sequence, arguments.masks, trajectory)
            module.append(time)
            if trajectory.read_bytes() != (output / "trajectory.txt").read_bytes():
                sys.exit("the trajectories differ")
    print(f"{frames} frames, the same trajectories to the byte; processor time per frame: "
          f"rgbd_tum {1e3 * min(program) / frames:.2f} ms, Python {1e3 * min(module) / frames:.2f} ms, "
          f"ratio {min(module) / min(program):.3f}")


if __name__ == "__main__":
    main()
