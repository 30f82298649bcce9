#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 4: a network makes masks while frames are tracked. It is slower than the camera, so it
gets the image of the newest keyframe when it is free, and its masks are added when they are
ready.

    04_late_masks.py SEQUENCE NETWORK
"""

import sys

import hullslam


def run(folder, network):
    settings = hullslam.Settings(hullslam.default_settings(folder))
    sequence = hullslam.open_tum(folder, settings)
    segmenter = hullslam.Segmenter(network)

    slam = hullslam.System(settings, "rgbd", pipeline="threaded")
    segmenter.attach(slam, wait=False)
    for i, frame in enumerate(sequence):
        slam.track(sequence.colour(i), frame.depth, timestamp=frame.timestamp)
    slam.finish()

    print(f"{len(slam.trajectory)} of {len(sequence)} frames have a pose")
    print(f"{slam.object_counts['detections']} detections of objects")
    for thing in [*slam.map.objects, *slam.map.candidates]:
        print(f"{thing.label} with {len(thing.keyframes)} observations")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: 04_late_masks.py SEQUENCE NETWORK")
    try:
        run(*sys.argv[1:])
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
