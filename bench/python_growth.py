#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracks many frames through the Python module and measures how much the memory grows.

    PYTHONPATH=build/release/python bench/python_growth.py [--frames 20000]

The camera looks at a small wall and only localises, so that the map stays as it is. What remains is
what the module and the library keep for each frame. The exit code is 1 if this is more than
--most bytes per frame (default 2000): a frame that is tracked has a pose and its times.
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests" / "python"))
import hullslam
from conftest import CAMERA, Wall


def resident_bytes():
    for line in pathlib.Path("/proc/self/status").read_text(encoding="utf-8").splitlines():
        if line.startswith("VmRSS:"):
            return 1024 * int(line.split()[1])
    raise RuntimeError("/proc/self/status has no line VmRSS")


def growth(frames, warm_up):
    """Bytes by which the memory grows per frame, after the first `warm_up` frames."""
    wall = Wall()
    settings = hullslam.Settings(Camera=CAMERA, ORBextractor={"nFeatures": 200})
    slam = hullslam.System(settings)
    begin = 0
    for i in range(frames):
        result = slam.track(wall.image(i), wall.depth, wall.masks(i), timestamp=i / 30.0)
        # Everything that a viewer would ask for must be freed again.
        assert result.state == "tracked" and result.objects
        assert len(result.matches) > 0 or i == 0  # the first frame makes the map
        if i % 100 == 0:
            assert len(slam.map.landmarks) and len(slam.map.observations)
        if i == 50:
            slam.localization = True
        if i == warm_up:
            begin = resident_bytes()
    return (resident_bytes() - begin) / (frames - warm_up)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=20000)
    parser.add_argument("--most", type=float, default=2000.0, metavar="BYTES")
    arguments = parser.parse_args()
    found = growth(arguments.frames, arguments.frames // 10)
    print(f"{arguments.frames} frames: {found:.0f} bytes per frame")
    return 1 if found > arguments.most else 0


if __name__ == "__main__":
    sys.exit(main())
