#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 3: maps a sequence of a stereo camera of any data set, and prints the poses.

    03_stereo.py SEQUENCE
"""

import sys

import hullslam


def run(path):
    sequence, settings = hullslam.open(path, mode="stereo")

    slam = hullslam.System(settings, sequence.mode, pipeline="threaded")
    for frame in sequence:
        slam.track(frame.image, right=frame.right, timestamp=frame.timestamp)  # both are rectified
    slam.finish()

    for stamp, (x, y, z) in zip(slam.trajectory.timestamps, slam.trajectory.positions):
        print(f"{stamp:.3f} s: {x:.3f} {y:.3f} {z:.3f} m")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: 03_stereo.py SEQUENCE")
    try:
        run(*sys.argv[1:])
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
