#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 5: maps objects from masks and known poses of the camera, here the ground truth of a
sequence in TUM's format. No image is read.

    05_known_poses.py SEQUENCE MASKS
"""

import sys

import hullslam


def run(folder, mask_folder):
    settings = hullslam.Settings(hullslam.default_settings(folder))
    sequence = hullslam.open_tum(folder, settings, depth=False)
    masks = hullslam.open_masks(mask_folder, sequence)
    groundtruth = sequence.groundtruth

    mapper = hullslam.KnownPoseMapper(settings)
    for i in range(0, len(sequence), 5):  # views should differ
        timestamp = sequence.timestamps[i]
        pose = groundtruth.interpolate(timestamp, 0.1)
        if pose is not None:
            mapper.add_view(pose, masks[i], timestamp=timestamp)

    print(f"{len(mapper.map.keyframes)} views")
    for thing in mapper.map.objects:
        x, y, z = thing.world_from_object[:3, 3]
        print(f"{thing.label} at {x:.3f} {y:.3f} {z:.3f} m")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 05_known_poses.py SEQUENCE MASKS")
    try:
        run(*sys.argv[1:])
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
