#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Example 7: what a robot needs. Maps an RGB-D sequence in TUM's format with the odometry of its
wheels, which also bridges ten images of a covered lens, saves the map while it drives, and goes
on without changing the map. ODOMETRY has poses of the camera in TUM's format.

    07_robot.py SEQUENCE ODOMETRY MAP
"""

import sys

import numpy as np

import hullslam


def motion_between(odometry, begin, end):
    """The motion of the camera and its covariance: 2 % of the way and of the turn."""
    last, now = (odometry.interpolate(stamp, 0.5) for stamp in (begin, end))
    if last is None or now is None:
        return {}
    motion = np.linalg.inv(now) @ last
    turn = np.arccos(np.clip((np.trace(motion[:3, :3]) - 1) / 2, -1, 1))
    sigmas = np.maximum(1e-4, 0.02 * np.array([turn, np.linalg.norm(motion[:3, 3])]))
    return {"motion": motion, "motion_covariance": np.diag(np.repeat(sigmas, 3)**2)}


def print_pose(name, pose):
    x, y, z = pose[:3, 3]
    print(f"{name}: {x:.2f} {y:.2f} {z:.2f} m")


def run(folder, odometry_file, map_file):
    settings = hullslam.Settings(hullslam.default_settings(folder))
    sequence = hullslam.open_tum(folder, settings)
    odometry = hullslam.read_trajectory(odometry_file)
    slam = hullslam.System(settings, "rgbd")
    half = len(sequence) // 2
    by_wheels = 0
    last = None
    for i, frame in enumerate(sequence):
        image = frame.image
        if half <= i < half + 10:
            image = np.zeros_like(image)
        if i == half + 10:
            slam.localization = True  # the place is known now
        motion = motion_between(odometry, last.timestamp, frame.timestamp) if last else {}
        last = slam.track(image, frame.depth, timestamp=frame.timestamp, **motion)
        for event in last.events:
            print(f"{last.timestamp:.3f} s: {event.kind}")
        by_wheels += last.prior == "alone"
        if i % 150 == 149:
            slam.save_map(map_file)
    print(f"{by_wheels} frames by wheels alone")
    print_pose("odometry", last.odom_from_cam)
    print_pose("map", last.map_from_odom @ last.odom_from_cam)
    slam.finish()
    slam.save_map(map_file)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: 07_robot.py SEQUENCE ODOMETRY MAP")
    try:
        run(*sys.argv[1:])
    except hullslam.InputError as error:
        sys.exit(f"error: {error}")
