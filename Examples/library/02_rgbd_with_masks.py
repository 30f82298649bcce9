#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 2: maps an RGB-D sequence in TUM's format with the masks of its objects, writes the
trajectory, measures its error and prints the objects.

    02_rgbd_with_masks.py SEQUENCE MASKS TRAJECTORY
"""

import sys

import hullslam


def print_objects(slam_map):
    for thing in slam_map.objects:
        x, y, z = thing.world_from_object[:3, 3]
        a, b, c = thing.half_axes
        print(f"{thing.label} at {x:.3f} {y:.3f} {z:.3f} m, half axes {a:.3f} {b:.3f} {c:.3f} m, "
              f"seen by {len(thing.keyframes)} keyframes")


def run(folder, mask_folder, output):
    settings = hullslam.Settings(hullslam.default_settings(folder))
    sequence = hullslam.open_tum(folder, settings)
    masks = hullslam.open_masks(mask_folder, sequence)

    slam = hullslam.System(settings, "rgbd")
    for frame, found in zip(sequence, masks):
        result = slam.track(frame.image, frame.depth, found, timestamp=frame.timestamp)
        if result.state != "tracked":
            print(f"{frame.name} is not tracked")
    slam.finish()

    trajectory = slam.trajectory
    trajectory.write(output)
    print(f"{len(trajectory)} of {len(sequence)} frames have a pose")
    print_objects(slam.map)
    if sequence.groundtruth is not None:
        errors = hullslam.evaluate_trajectory(sequence.groundtruth, trajectory)
        print(f"error {errors.ate_rmse:.4f} m over {errors.pairs} poses")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: 02_rgbd_with_masks.py SEQUENCE MASKS TRAJECTORY")
    try:
        run(*sys.argv[1:])
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
