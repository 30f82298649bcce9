#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 4: a network makes masks while frames are tracked. It is slower than the camera, so it
gets the newest image when it is free, and its masks are added when they are ready.

    04_late_masks.py SEQUENCE NETWORK
"""

import sys
from concurrent.futures import ThreadPoolExecutor

import hullslam


def run(folder, network):
    settings = hullslam.Settings(hullslam.default_settings(folder))
    sequence = hullslam.open_tum(folder, settings)
    segmenter = hullslam.Segmenter(network)

    slam = hullslam.System(settings, "rgbd", pipeline="threaded")
    slam.await_masks(True)
    worker = ThreadPoolExecutor(1)
    shown = masks = None  # the frame whose image the network has, and its masks to come
    for i, frame in enumerate(sequence):
        result = slam.track(frame.image, frame.depth, timestamp=frame.timestamp)
        if masks is not None and masks.done():
            slam.add_masks(shown, masks.result())
            masks = None
        if masks is None:
            shown = result.frame
            masks = worker.submit(segmenter.segment, sequence.colour(i))
    slam.add_masks(shown, masks.result())
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
