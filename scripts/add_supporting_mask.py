#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies the masks of a sequence of make_synthetic and adds a large mask of a supporting surface.

Each frame gets one more mask, of the class `dining table`: the convex hull of the masks of all
things that stand on the table, grown by 30 px and clipped to the image. A run with these masks shows
whether a supporting surface is taken for an occluder of the things on it.

SEQUENCE_MASKS is the folder `masks` of the sequence (format yolo-seg). groundtruth_objects.json,
groundtruth.txt and camera.yaml beside it tell which masks show things on the table: those of true
objects whose lowest points are at the most frequent height or up to 0.1 m above. Without these
files, all masks count. OUT must not exist, or be an empty folder.

Exit codes: 0 done, 2 bad usage or input.
"""

import argparse
import json
import pathlib
import re
import sys

import numpy as np

from run_files import InputError, read_trajectory
from run_objects import rotation

TABLE = 60  # COCO's class `dining table`, counted from 0
MAX_STACK = 0.1  # m, the lowest point of a thing that lies on another thing on the table


def convex_hull(points):
    """The corners of the convex hull (k x 2), by Andrew's monotone chain."""
    points = sorted(map(tuple, points))
    chains = []
    for ordered in (points, points[::-1]):
        chain = []
        for x, y in ordered:
            while len(chain) > 1 and ((chain[-1][0] - chain[-2][0]) * (y - chain[-2][1])
                                      <= (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])):
                chain.pop()
            chain.append((x, y))
        chains += chain[:-1]
    return np.array(chains)


def clip(polygon, size):
    """The part of a convex polygon that is in the image, 0 to width and 0 to height."""
    for axis in (0, 1):
        for sign, bound in ((1, 0.0), (-1, -float(size[axis]))):
            inside = sign * polygon[:, axis] - bound
            kept = []
            for i, value in enumerate(inside):
                if inside[i - 1] * value < 0:  # the edge crosses the border
                    share = inside[i - 1] / (inside[i - 1] - value)
                    kept.append(polygon[i - 1] + share * (polygon[i] - polygon[i - 1]))
                if value >= 0:
                    kept.append(polygon[i])
            polygon = np.array(kept).reshape(-1, 2)
    return polygon


def surface_around(outlines, size, margin):
    """The polygon of the supporting surface in px; empty if nothing stands on it."""
    if not outlines:
        return np.empty((0, 2))
    turn = np.linspace(0.0, 2.0 * np.pi, 17)[:-1]
    disc = margin * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    corners = convex_hull(np.concatenate(outlines))
    return clip(convex_hull((corners[:, None] + disc).reshape(-1, 2)), size)


class Truth:
    """Tells which masks show things on the table."""

    def __init__(self, sequence):
        text = (sequence / "camera.yaml").read_text(encoding="utf-8")
        self.fx, self.fy, self.cx, self.cy = (
            float(re.search(rf"^Camera\.{key}: *(\S+)", text, re.MULTILINE)[1])
            for key in ("fx", "fy", "cx", "cy"))
        stamps, self.poses = read_trajectory(sequence / "groundtruth.txt")
        self.frames = {f"{stamp:.6f}": i for i, stamp in enumerate(stamps)}
        path = sequence / "groundtruth_objects.json"
        objects = json.loads(path.read_text(encoding="utf-8"))["objects"]
        lowest = []
        for item in objects:
            turn = rotation(item["world_from_object"][3:])
            height = float(np.abs(turn[2]) @ np.array(item["half_extents"]))
            lowest.append(item["world_from_object"][2] - height)
        heights, counts = np.unique(np.round(lowest, 2), return_counts=True)
        top = heights[counts.argmax()]
        # For each class the centres of its things, and whether each of them is on the table.
        self.things = {}
        for item, low in zip(objects, lowest):
            self.things.setdefault(item["class_id"], []).append(
                (np.array(item["world_from_object"][:3]), top - 0.01 < low < top + MAX_STACK))

    def is_on_table(self, stem, number, outline):
        """Whether the nearest thing of the mask's class is on the table."""
        if stem not in self.frames or number not in self.things:
            return False
        pose = self.poses[self.frames[stem]]
        best, answer = np.inf, False
        for centre, is_on_table in self.things[number]:
            x, y, z = rotation(pose[3:]).T @ (centre - pose[:3])
            if z > 0.0:
                pixel = np.array([self.fx * x / z + self.cx, self.fy * y / z + self.cy])
                distance = np.linalg.norm(outline.mean(axis=0) - pixel)
                if distance < best:
                    best, answer = distance, is_on_table
        return answer


def read_masks(path, size):
    """Lines of a mask file as (class, outline in px)."""
    masks = []
    for count, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split()
        try:
            values = [float(word) for word in words[1:]]
            outline = np.array(values[:len(values) // 2 * 2]).reshape(-1, 2) * size
            if len(outline) < 3 or not np.isfinite(outline).all():
                raise ValueError
            masks.append((int(words[0]), outline))
        except (ValueError, IndexError) as error:
            raise InputError(f"{path}:{count}: expected `class x1 y1 ... xn yn [confidence]`") \
                from error
    return masks


def parse_size(text):
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}', expected WIDTHxHEIGHT")
    return np.array([int(match[1]), int(match[2])])


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("masks", type=pathlib.Path, metavar="SEQUENCE_MASKS")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    parser.add_argument("--margin", type=float, default=30.0, metavar="PX",
                        help="how far the mask reaches beyond the things (default 30)")
    parser.add_argument("--size", type=parse_size, default="640x480", metavar="WIDTHxHEIGHT",
                        help="size of the images (default 640x480)")
    arguments = parser.parse_args(words)
    try:
        files = sorted(arguments.masks.glob("*.txt"))
        if not files:
            raise InputError(f"{arguments.masks}: contains no *.txt")
        sequence = arguments.masks.resolve().parent
        has_truth = (sequence / "groundtruth_objects.json").exists()
        truth = Truth(sequence) if has_truth else None
        arguments.out.mkdir(parents=True, exist_ok=True)
        if any(arguments.out.iterdir()):
            raise InputError(f"{arguments.out}: is not empty")
        written = added = 0
        for path in files:
            masks = read_masks(path, arguments.size) if path.name != "classes.txt" else []
            standing = [outline for number, outline in masks
                        if truth is None or truth.is_on_table(path.stem, number, outline)]
            surface = surface_around(standing, arguments.size, arguments.margin) / arguments.size
            text = path.read_text(encoding="utf-8")
            if len(surface) > 2:
                text += "\n" if text and not text.endswith("\n") else ""
                text += f"{TABLE} " + " ".join(f"{value:.6f}" for value in surface.flat) + " 1\n"
                added += 1
            written += len(masks) + (len(surface) > 2)
            (arguments.out / path.name).write_text(text, encoding="utf-8")
    except (InputError, OSError, ValueError, KeyError, TypeError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"{arguments.out}: {len(files)} files with {written} detections, {added} of them added")
    return 0


if __name__ == "__main__":
    sys.exit(main())
