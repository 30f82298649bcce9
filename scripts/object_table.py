#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the mapped objects of finished runs as a Markdown table. The columns are the class, the
number of observations, the largest angle between two views of the object, the half axes (longest
first), SIoU and tangent distance.

RUN_DIR is an output folder of rgbd_tum or map_objects. Its objects.json and
objects_observations.json are read.
"""

import argparse
import pathlib
import sys

from python_packages import require

require("numpy", "matplotlib")
import numpy as np  # noqa: E402

from object_entries import attach_observations  # noqa: E402
from run_files import InputError, one_line, read_json  # noqa: E402
from run_objects import rotation  # noqa: E402

HEADER = ("| run | id | class | views | angle ° | half axes m | SIoU | SIoU mask | tangent px |\n"
          "|---|---|---|---|---|---|---|---|---|")


def largest_angle(entry):
    """Largest angle at the object's centre between two cameras that observe it, degrees."""
    centre = np.array(entry["world_from_object"][:3], dtype=float)
    rays = []
    for view in entry["observations"]:
        pose = np.array(view["cam_from_world"], dtype=float)
        camera = -rotation(pose[3:]).T @ pose[:3]
        rays.append((camera - centre) / np.linalg.norm(camera - centre))
    if not rays:
        return 0.0
    cosines = np.array(rays) @ np.array(rays).T
    return float(np.degrees(np.arccos(np.clip(cosines.min(), -1.0, 1.0))))


def number(value, form):
    return "-" if value is None else format(float(value), form)


def row(name, entry):
    axes = " ".join(f"{axis:.3f}" for axis in sorted(map(float, entry["half_axes"]), reverse=True))
    return (f"| {name} | {entry['id']} | {entry['class']} | {len(entry['observations'])} | "
            f"{largest_angle(entry):.0f} | {axes} | {number(entry['siou'], '.3f')} | "
            f"{number(entry['siou_mask'], '.3f')} | {number(entry['tangent_px'], '.2f')} |")


def rows(run_dir, min_angle):
    """The rows of the objects whose largest angle is at least `min_angle` degrees."""
    path = run_dir / "objects.json"
    try:
        content = read_json(path)
        attach_observations(path, content)
        entries = content["objects"]
        return [row(run_dir.resolve().name, entry) for entry in entries
                if entry["state"] == "mapped" and largest_angle(entry) >= min_angle]
    except (ValueError, KeyError, TypeError, IndexError, AttributeError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else one_line(error)
        raise InputError(f"{path}: not a valid objects.json: {reason}") from error


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run_dirs", type=pathlib.Path, metavar="RUN_DIR", nargs="+")
    parser.add_argument("--min-angle", type=float, default=0.0, metavar="DEGREES",
                        help="leave out objects whose largest angle is smaller (default 0)")
    arguments = parser.parse_args()
    try:
        lines = [line for run_dir in arguments.run_dirs
                 for line in rows(run_dir, arguments.min_angle)]
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print("\n".join([HEADER, *lines]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
