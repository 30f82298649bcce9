#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a finished run and prints its figures. DIR/run.png shows the trajectory, the map and the
objects from above and from the side, the error over time, and the time of each stage.

With --overlay N, DIR/overlays.png is drawn too. It shows N keyframes with the projected ellipses of
the mapped objects and the hulls of their masks. An ellipse is solid if the keyframe observes the
object and dashed if not. Hulls are dotted.

RUN_DIR is a folder that `rgbd_tum --output` wrote. It must contain trajectory.txt; map.ply,
keyframes.txt, objects.json and summary.json are used if they exist. With --groundtruth the run is
aligned to the ground truth (SE3, Umeyama 1991, pairs within 0.02 s). Without it, the run is drawn
in the frame of the first camera.
"""

import argparse
import json
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import run_objects  # noqa: E402
from run_objects import InputError  # noqa: E402

MAX_DIFFERENCE = 0.02  # s, between the stamps of an estimated pose and a true one
MAX_POINTS = 30000  # points of the map that are drawn at most
ESTIMATE, TRUTH, MAP, MARK = "#0072b2", "#000000", "#b0b0b0", "#d55e00"
PLY_TYPES = {"float": "<f4", "float32": "<f4", "double": "<f8", "uchar": "u1", "uint8": "u1",
             "int": "<i4", "uint": "<u4", "short": "<i2", "ushort": "<u2", "char": "i1"}


def read_trajectory(path):
    """Stamps (n) and positions (n x 3) of a TUM file, which has one pose per line."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error
    rows = []
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            row = [float(word) for word in line.split()]
        except ValueError:
            row = []
        if len(row) != 8 or not np.isfinite(row).all():
            raise InputError(f"{path}:{number}: expected 8 numbers, stamp tx ty tz qx qy qz qw")
        rows.append(row[:4])
    if not rows:
        raise InputError(f"{path}: no poses")
    rows = np.array(rows)
    return rows[:, 0], rows[:, 1:]


def read_ply_header(file, path):
    """The number of vertices and the numpy type of a vertex. `file` is left at the first vertex."""
    if file.readline().strip() != b"ply":
        raise InputError(f"{path}: not a PLY file")
    count, fields, binary, element = 0, [], False, ""
    for line in iter(file.readline, b""):
        words = line.decode("ascii", "replace").split()
        if words[:1] == ["end_header"]:
            break
        if words[:1] == ["format"]:
            binary = words[1:2] == ["binary_little_endian"]
        elif words[:1] == ["element"] and len(words) == 3 and words[2].isdigit():
            element = words[1]
            count = int(words[2]) if element == "vertex" else count
        elif words[:1] == ["property"] and element == "vertex":
            if len(words) != 3 or words[1] not in PLY_TYPES:
                raise InputError(f"{path}: vertex property of an unknown type: {' '.join(words)}")
            fields.append((words[2], PLY_TYPES[words[1]]))
    if not binary or not {"x", "y", "z"} <= {name for name, _ in fields}:
        raise InputError(f"{path}: expected a binary little-endian PLY with vertices x y z")
    return count, np.dtype(fields)


def read_map(path):
    """Points (n x 3) and colours (n x 3, 0 to 1; grey if the file has no colours) of a PLY file."""
    with path.open("rb") as file:
        count, kind = read_ply_header(file, path)
        data = file.read(count * kind.itemsize)
    if len(data) < count * kind.itemsize:
        raise InputError(f"{path}: cut short; its header announces {count} vertices")
    vertices = np.frombuffer(data, kind)
    vertices = vertices[::max(1, -(-count // MAX_POINTS))]
    points = np.stack([vertices[axis].astype(float) for axis in "xyz"], axis=1)
    if not {"red", "green", "blue"} <= set(kind.names):
        return points, np.tile(matplotlib.colors.to_rgb(MAP), (len(points), 1))
    return points, np.stack([vertices[c] / 255.0 for c in ("red", "green", "blue")], axis=1)


def pair(stamps, truth_stamps):
    """Pairs of indices (k x 2) of stamps that differ by less than MAX_DIFFERENCE.

    Each stamp is in one pair at most; the pair with the smallest difference is taken first.
    """
    candidates = []
    begin = np.searchsorted(truth_stamps, stamps - MAX_DIFFERENCE)
    end = np.searchsorted(truth_stamps, stamps + MAX_DIFFERENCE, side="right")
    for i, stamp in enumerate(stamps):
        for j in range(begin[i], end[i]):
            candidates.append((abs(stamp - truth_stamps[j]), i, j))
    used_i, used_j, pairs = set(), set(), []
    for difference, i, j in sorted(candidates):
        if difference < MAX_DIFFERENCE and i not in used_i and j not in used_j:
            used_i.add(i)
            used_j.add(j)
            pairs.append((i, j))
    return np.array(sorted(pairs), dtype=int).reshape(-1, 2)


def align(source, target):
    """Returns R (3 x 3) and t (3) that minimise |R source + t - target| (Umeyama 1991).

    `source` and `target` are n x 3, one point per row.
    """
    source_mean, target_mean = source.mean(axis=0), target.mean(axis=0)
    u, _, vt = np.linalg.svd((target - target_mean).T @ (source - source_mean))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = u @ flip @ vt
    return rotation, target_mean - rotation @ source_mean


class Run:
    """Everything that is drawn. All positions are in one frame, whose third axis points up."""

    def __init__(self, run_dir, groundtruth):
        self.stamps, self.positions = read_trajectory(run_dir / "trajectory.txt")
        self.keyframes = np.empty((0, 3))
        if (run_dir / "keyframes.txt").exists():
            self.keyframes = read_trajectory(run_dir / "keyframes.txt")[1]
        self.points, self.colours = np.empty((0, 3)), np.empty((0, 3))
        if (run_dir / "map.ply").exists():
            self.points, self.colours = read_map(run_dir / "map.ply")
        self.summary = read_summary(run_dir / "summary.json")
        self.camera, self.objects = run_objects.read_objects(run_dir / "objects.json")
        self.truth = self.error_stamps = self.errors = None
        if groundtruth:
            self._align_to(groundtruth)
        else:  # from a camera frame: x right, y down, z forward
            self._move(np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]), np.zeros(3))

    def _align_to(self, path):
        truth_stamps, truth = read_trajectory(path)
        if (np.diff(truth_stamps) < 0).any():
            raise InputError(f"{path}: the time stamps decrease")
        pairs = pair(self.stamps, truth_stamps)
        if len(pairs) < 3:
            raise InputError(f"{path}: {len(pairs)} poses are within {MAX_DIFFERENCE} s of a pose of "
                             "the run, at least 3 are needed; is it the same sequence?")
        self._move(*align(self.positions[pairs[:, 0]], truth[pairs[:, 1]]))
        self.error_stamps = self.stamps[pairs[:, 0]]
        difference = self.positions[pairs[:, 0]] - truth[pairs[:, 1]]
        self.errors = np.linalg.norm(difference, axis=1)
        during = (truth_stamps >= self.stamps[0] - 1) & (truth_stamps <= self.stamps[-1] + 1)
        self.truth = truth[during]

    def _move(self, rotation, translation):
        for name in ("positions", "keyframes", "points"):
            setattr(self, name, getattr(self, name) @ rotation.T + translation)
        for item in self.objects:
            item.move(rotation, translation)

    def ate(self):
        return float(np.sqrt(np.mean(self.errors**2)))


def read_summary(path):
    if not path.exists():
        return {}
    try:
        summary = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: not valid JSON: {error}") from error
    if not isinstance(summary, dict):
        raise InputError(f"{path}: expected a JSON object")
    return summary


def drawn_part(run, axes):
    """Limits (2 x 2) of a view of the trajectory and of the map without its farthest points."""
    parts = [run.positions] + ([run.truth] if run.truth is not None else [])
    if len(run.points):
        low, high = np.percentile(run.points, [3, 97], axis=0)
        parts.append(np.stack([low, high]))
    corners = [part[:, axes] for part in parts]
    corners += [item.seen_along(axes) for item in run.objects if item.is_mapped]
    corners = np.concatenate(corners)
    low, high = corners.min(axis=0), corners.max(axis=0)
    margin = 0.06 * max((high - low).max(), 0.1)
    return low - margin, high + margin


def draw_view(plot, run, axes, names, title):
    if len(run.points):
        plot.scatter(*run.points[:, axes].T, c=run.colours, s=1.5, alpha=0.5, linewidths=0)
    if run.truth is not None:
        plot.plot(*run.truth[:, axes].T, color=TRUTH, linewidth=2.6, alpha=0.4,
                  label="ground truth")
    plot.plot(*run.positions[:, axes].T, color=ESTIMATE, linewidth=1.2, label="HullSLAM")
    if len(run.keyframes):
        plot.plot(*run.keyframes[:, axes].T, "o", color=MARK, markersize=3, label="keyframes")
    run_objects.draw_from_afar(plot, run.objects, axes)
    low, high = drawn_part(run, axes)
    plot.set_xlim(low[0], high[0])
    plot.set_ylim(low[1], high[1])
    plot.set_aspect("equal", adjustable="datalim")
    plot.set_xlabel(f"{names[0]} [m]")
    plot.set_ylabel(f"{names[1]} [m]")
    plot.set_title(title)
    plot.grid(alpha=0.25)


def draw_error(plot, run):
    plot.set_title("error over time")
    plot.set_xlabel("time [s]")
    plot.set_ylabel("position error [mm]")
    if run.errors is None:
        plot.text(0.5, 0.5, "no ground truth", ha="center", transform=plot.transAxes)
        return
    seconds = run.error_stamps - run.error_stamps[0]
    plot.plot(seconds, 1e3 * run.errors, color=ESTIMATE, linewidth=1)
    plot.axhline(1e3 * run.ate(), color=MARK, linewidth=1, linestyle="--",
                 label=f"RMSE {1e3 * run.ate():.1f} mm")
    plot.set_ylim(bottom=0)
    plot.legend(loc="upper right")
    plot.grid(alpha=0.25)


def stage_times(summary):
    """(name, median, p95) in ms for all of tracking and for each stage; without unknown ones."""
    timing = summary.get("timing") or {}
    stages = {"tracking": timing.get("track_ms"), **(timing.get("stages_ms") or {})}
    return [(name, stage["median"], stage["p95"]) for name, stage in stages.items()
            if isinstance(stage, dict) and stage.get("median") is not None
            and stage.get("p95") is not None]


def draw_times(plot, run):
    plot.set_title("time per call: median, and 95th percentile")
    plot.set_xlabel("[ms]")
    times = stage_times(run.summary)
    if not times:
        plot.text(0.5, 0.5, "no times in summary.json", ha="center", transform=plot.transAxes)
        plot.set_yticks([])
        return
    names, medians, tails = zip(*times)
    rows = np.arange(len(names))
    plot.barh(rows, tails, color=ESTIMATE, alpha=0.25)
    plot.barh(rows, medians, color=ESTIMATE)
    for row, median in zip(rows, medians):
        figures = f"{median:.0f}" if median >= 100.0 else f"{median:.3g}"
        plot.text(max(median, 0.1), row, f" {figures}", va="center", fontsize=8)
    plot.set_xscale("log")  # a pose takes milliseconds, a global bundle adjustment a second
    plot.set_xlim(left=0.1, right=3.0 * max(1.0, *tails))
    plot.set_yticks(rows, names, fontsize=8)
    plot.invert_yaxis()
    plot.grid(axis="x", alpha=0.25)


def draw(run, path, name):
    figure, plots = plt.subplots(2, 2, figsize=(13, 9), height_ratios=[3, 2],
                                 constrained_layout=True)
    names = "xyz" if run.truth is not None else ("right", "forward", "up")
    draw_view(plots[0, 0], run, [0, 1], (names[0], names[1]), "from above")
    draw_view(plots[0, 1], run, [0, 2], (names[0], names[2]), "from the side")
    plots[0, 0].legend(loc="upper left", fontsize=8)
    draw_error(plots[1, 0], run)
    draw_times(plots[1, 1], run)
    title = f"{name}: {len(run.positions)} poses"
    if len(run.keyframes):
        title += f", {len(run.keyframes)} keyframes"
    if run.objects:
        title += f", {sum(item.is_mapped for item in run.objects)} objects"
    if run.errors is not None:
        title += f", ATE RMSE {run.ate():.4f} m (SE3, {len(run.errors)} pairs)"
    figure.suptitle(title)
    figure.savefig(path, dpi=110)


def print_figures(run):
    if run.errors is not None:
        print(f"ATE RMSE         {run.ate():.4f} m (SE3, all frames, {len(run.errors)} pairs)")
    trajectory, timing = run.summary.get("trajectory") or {}, run.summary.get("timing") or {}
    if trajectory.get("frames") is not None:
        print(f"frames           {trajectory['frames']}, tracked {trajectory.get('tracked')}, "
              f"lost {trajectory.get('lost')}")
    for name, median, tail in stage_times(run.summary)[:1]:
        print(f"{name:<16} {median:.1f} ms median, {tail:.1f} ms 95th percentile")
    if timing.get("frames_per_second") is not None:
        print(f"whole run        {timing['frames_per_second']:.1f} frames/s")


def print_objects(run):
    objects = run.summary.get("objects") or {}
    if objects.get("count") is None:
        return
    figures = [("SIoU", "siou_mean", ".3f", ""), ("MTD", "mtd_mean_m2", ".2e", " m2"),
               ("tangents", "tangent_mean_px", ".2f", " px")]
    text = "".join(f", {name} {objects[key]:{form}}{unit}" for name, key, form, unit in figures
                   if objects.get(key) is not None)
    print(f"objects          {objects['count']}{text}")


def find_sequence(run, chosen):
    """The folder of the images: the one that was given, else the one named in summary.json."""
    folder = chosen or (run.summary.get("provenance") or {}).get("sequence")
    if not folder:
        raise InputError("summary.json names no sequence to take images from; give --sequence")
    return folder


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run_dir", type=pathlib.Path, metavar="RUN_DIR")
    parser.add_argument("--groundtruth", type=pathlib.Path, metavar="FILE",
                        help="true trajectory in TUM's format")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR",
                        help="folder for the pictures (default: RUN_DIR)")
    parser.add_argument("--overlay", type=int, default=0, metavar="N",
                        help="draw the objects on N keyframes")
    parser.add_argument("--sequence", type=pathlib.Path, metavar="DIR",
                        help="folder of the sequence, for its images (default: the one that "
                             "summary.json names)")
    arguments = parser.parse_args(words)
    out = arguments.out or arguments.run_dir
    try:
        if arguments.overlay < 0:
            raise InputError(f"--overlay is {arguments.overlay}, expected 0 or more keyframes")
        run = Run(arguments.run_dir, arguments.groundtruth)
        out.mkdir(parents=True, exist_ok=True)
        overlays = 0
        if arguments.overlay:
            camera, objects = run_objects.read_objects(arguments.run_dir / "objects.json")
            overlays = run_objects.draw_overlays(
                out / "overlays.png", find_sequence(run, arguments.sequence), camera, objects,
                arguments.overlay)
        draw(run, out / "run.png", arguments.run_dir.resolve().name)
    except (InputError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print_figures(run)
    print_objects(run)
    print(f"picture          {out / 'run.png'}")
    if arguments.overlay:
        print(f"overlays         {out / 'overlays.png' if overlays else 'none: no objects'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
