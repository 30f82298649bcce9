#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 1: gives a System images from memory and prints the poses. The camera looks at a plane
with a random texture, 1 m away, and moves to the right by 1 cm per frame.
"""

import cv2
import numpy as np

import hullslam

settings = hullslam.Settings(Camera={"fx": 500.0, "fy": 500.0, "cx": 319.5, "cy": 239.5})
slam = hullslam.System(settings, "rgbd", vocabulary=None)  # without loops

texture = np.empty((60, 100), np.uint8)
cv2.setRNGSeed(1)
cv2.randu(texture, 0, 256)
texture = cv2.resize(texture, (800, 480), interpolation=cv2.INTER_CUBIC)
depth = np.ones((480, 640), np.float32)
for i in range(20):
    image = texture[:, 5 * i:5 * i + 640]  # 5 px correspond to 1 cm
    slam.track(image, depth, timestamp=i / 30.0)
slam.finish()
for stamp, (x, y, z) in zip(slam.trajectory.timestamps, slam.trajectory.positions):
    print(f"{stamp:.3f} s: {x:.4f} {y:.4f} {z:.4f} m")
