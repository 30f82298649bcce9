#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 6: maps the first half of a sequence in TUM's format, saves the map, and finds the poses
of the second half in it without changing it.

    06_localisation.py SEQUENCE MAP
"""

import sys

import hullslam


def run(folder, map_file):
    settings = hullslam.Settings(hullslam.default_settings(folder))
    sequence = hullslam.open_tum(folder, settings)
    half = len(sequence) // 2

    first = hullslam.System(settings, "rgbd")
    for i in range(half):
        frame = sequence[i]
        first.track(frame.image, frame.depth, timestamp=frame.timestamp)
    first.finish()
    first.save_map(map_file)

    second = hullslam.System(settings, "rgbd", map=map_file, session="second visit",
                             localization=True)
    for i in range(half, len(sequence)):
        frame = sequence[i]
        result = second.track(frame.image, frame.depth, timestamp=frame.timestamp)
        if result.state == "tracked":
            x, y, z = result.world_from_cam[:3, 3]
            print(f"{result.timestamp:.3f} s: {x:.4f} {y:.4f} {z:.4f} m")
    second.finish()
    print(f"{len(second.trajectory)} of {len(sequence) - half} frames found in a map of "
          f"{len(second.map.keyframes)} keyframes")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 06_localisation.py SEQUENCE MAP")
    try:
        run(*sys.argv[1:])
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
