#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps a sequence in TUM's format with its objects, and measures the error of the trajectory."""

import argparse

import hullslam


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sequence", help="folder in TUM's format")
    parser.add_argument("--masks", required=True, help="folder or JSON file of masks")
    parser.add_argument("--output", default="trajectory.txt", metavar="FILE")
    arguments = parser.parse_args()

    settings = hullslam.Settings(hullslam.default_settings(arguments.sequence))
    sequence = hullslam.open_tum(arguments.sequence, settings)
    masks = hullslam.open_masks(arguments.masks, sequence)
    slam = hullslam.System(settings)
    for frame, found in zip(sequence, masks):
        result = slam.track(frame.image, frame.depth, found, timestamp=frame.timestamp)
        if result.state != "tracked":
            print(f"{frame.name}: {result.state}, {result.reason}")
    slam.finish()

    slam.trajectory.write(arguments.output)
    for thing in slam.map.objects:
        position = thing.world_from_object[:3, 3].round(2)
        print(f"{thing.label} at {position} m, half axes {thing.half_axes.round(2)} m")
    if sequence.groundtruth is not None:
        print(hullslam.evaluate_trajectory(sequence.groundtruth, slam.trajectory))


if __name__ == "__main__":
    try:
        main()
    except hullslam.InputError as error:
        raise SystemExit(f"error: {error}")
