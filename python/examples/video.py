#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Monocular SLAM on a video file or a webcam, with objects if a network is given.

    video.py walk.mp4 --settings camera.yaml
    video.py 0 --fov 65 --model yolov8n-seg.pt          # camera 0, masks from Ultralytics

The masks come from Ultralytics (pip install ultralytics), which is only imported with --model.
"""

import argparse
import math
import sys
import time

import cv2

import hullslam


def camera_of(fov, width, height):
    """The settings of a camera without distortion whose horizontal field of view is `fov` degrees."""
    if not 10.0 <= fov <= 170.0:
        sys.exit(f"error: --fov is {fov}, expected a number of degrees from 10 to 170")
    focal = 0.5 * width / math.tan(math.radians(0.5 * fov))
    return hullslam.Settings(Camera={"fx": focal, "fy": focal, "cx": 0.5 * (width - 1),
                                     "cy": 0.5 * (height - 1), "width": width, "height": height})


class Segmenter:
    """Masks of a network of Ultralytics."""

    def __init__(self, model):
        try:
            from ultralytics import YOLO
        except ImportError:
            sys.exit("error: --model needs Ultralytics, which is not installed: "
                     "pip install ultralytics")
        self._model = YOLO(model)

    def __call__(self, image):
        (result,) = self._model(image, verbose=False)
        if result.masks is None:
            return None
        found = [(outline, result.names[int(number)], float(score))
                 for outline, number, score in zip(result.masks.xy, result.boxes.cls,
                                                   result.boxes.conf)
                 if len(outline) >= 3]
        outlines, classes, scores = zip(*found) if found else ([], [], [])
        return hullslam.Masks.from_outlines(outlines, classes, scores)


def frames_of(capture, is_live):
    """Time stamps (s) and images."""
    begin, last = time.monotonic(), -1.0
    while True:
        is_good, image = capture.read()
        if not is_good:
            return
        stamp = time.monotonic() - begin if is_live else 1e-3 * capture.get(cv2.CAP_PROP_POS_MSEC)
        if stamp > last:  # some files repeat a time stamp
            yield stamp, image
            last = stamp


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("video", help="file, or the number of a camera")
    camera = parser.add_mutually_exclusive_group(required=True)
    camera.add_argument("--settings", metavar="FILE", help="settings file of the camera")
    camera.add_argument("--fov", type=float, metavar="DEGREES", help="horizontal field of view")
    parser.add_argument("--model", metavar="FILE", help="a network of Ultralytics, for masks")
    parser.add_argument("--output", default="trajectory.txt", metavar="FILE")
    arguments = parser.parse_args()

    is_live = arguments.video.isdigit()
    capture = cv2.VideoCapture(int(arguments.video) if is_live else arguments.video)
    if not capture.isOpened():
        sys.exit(f"error: {arguments.video} is neither a video nor the number of a camera")
    segment = Segmenter(arguments.model) if arguments.model else None
    slam = None
    for stamp, image in frames_of(capture, is_live):
        if slam is None:
            settings = (hullslam.Settings(arguments.settings) if arguments.settings
                        else camera_of(arguments.fov, image.shape[1], image.shape[0]))
            slam = hullslam.System(settings, "mono",
                                   pipeline="realtime" if is_live else "sequential")
        try:
            result = slam.track(image, masks=segment(image) if segment else None, timestamp=stamp)
            print(f"\r{stamp:8.2f} s  {result.state}: {result.reason or ''}\033[K", end="")
        except KeyboardInterrupt:
            break
    print()
    if slam is None:
        sys.exit(f"error: {arguments.video} has no image")
    slam.finish()
    if len(slam.map.keyframes) == 0:
        sys.exit(f"error: no map could be made: {result.reason}")
    slam.trajectory.write(arguments.output)
    print(f"{len(slam.trajectory)} poses, {slam.map}")
    for thing in slam.map.objects:
        print(thing)


if __name__ == "__main__":
    try:
        main()
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
