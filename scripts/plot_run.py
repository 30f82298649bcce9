#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a finished run and prints its figures. DIR/run.png shows the trajectory, the map and the
objects from two sides, the error over time, and the time of each stage.

With --overlay N, DIR/overlays.png is drawn too. It shows N keyframes with the projected ellipses of
the mapped objects and the hulls of their masks. An ellipse is solid if the keyframe observes the
object and dashed if not. Hulls are dotted.

RUN_DIR is a folder that `rgbd_tum --output` or `map_objects --output` wrote. It must contain
trajectory.txt; map.ply, keyframes.txt, objects.json and summary.json are used if they exist.

The run is aligned to the ground truth of its sequence (Umeyama 1991, pairs within 0.02 s) and drawn
from above and from the side. The alignment is SE3, or Sim3 if summary.json says so, because the scale
of a monocular run is unknown. The ground truth is the given file, else groundtruth.txt in RUN_DIR if
the run wrote one, else the file in the folder that summary.json names. Without ground truth the
vertical direction is unknown: the run is drawn in its own frame, and the views are named by the axes.

Exit codes: 0 done, 2 bad usage or input.
"""

import argparse
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import run_objects  # noqa: E402
from plot_labels import draw_labels, plain  # noqa: E402
from run_files import InputError, Summary, find_folder, read_map, read_trajectory  # noqa: E402

MAX_DIFFERENCE = 0.02  # s, between the stamps of an estimated pose and a true one
MAX_POINTS = 30000  # points of the map that are drawn at most
ESTIMATE, TRUTH, MAP, MARK = "#0072b2", "#000000", "#b0b0b0", "#d55e00"


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


def align(source, target, with_scale=False):
    """Returns s, R (3 x 3) and t (3) that minimise |s R source + t - target| (Umeyama 1991).

    `source` and `target` are n x 3, one point per row. s is 1 unless `with_scale`.
    """
    source_mean, target_mean = source.mean(axis=0), target.mean(axis=0)
    u, singular, vt = np.linalg.svd((target - target_mean).T @ (source - source_mean))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = u @ flip @ vt
    spread = np.sum((source - source_mean) ** 2)
    scale = float(singular @ np.diag(flip) / spread) if with_scale and spread > 0 else 1.0
    return scale, rotation, target_mean - scale * rotation @ source_mean


class Run:
    """Everything that is drawn. All positions are in the frame of the ground truth (z is up) or,
    without ground truth, in that of the run."""

    def __init__(self, run_dir):
        self.stamps, poses = read_trajectory(run_dir / "trajectory.txt")
        self.positions = poses[:, :3]
        # If the run got no poses from another source, the world is the camera frame of the first frame.
        self.is_first_camera = bool(np.abs(poses[0] - [0, 0, 0, 0, 0, 0, 1]).max() < 1e-6)
        self.keyframes = np.empty((0, 3))
        if (run_dir / "keyframes.txt").exists():
            self.keyframes = read_trajectory(run_dir / "keyframes.txt")[1][:, :3]
        self.points, self.colours = np.empty((0, 3)), None
        if (run_dir / "map.ply").exists():
            self.points, self.colours, dropped = read_map(run_dir / "map.ply", MAX_POINTS)
            if dropped:
                print(f"note: {dropped} points of {run_dir / 'map.ply'} are not drawn: their "
                      "positions are no numbers, or too far away", file=sys.stderr)
        self.summary = Summary(run_dir / "summary.json")
        self.gives_poses = self.summary.text("provenance", "pipeline") != "objects"
        self.camera, self.objects = run_objects.read_objects(run_dir / "objects.json")
        is_sim3 = self.summary.text("trajectory", "alignment") == "sim3"
        self.alignment = "Sim3" if is_sim3 else "SE3"
        self.truth = self.error_stamps = self.errors = None

    def align_to(self, path):
        truth_stamps, truth_poses = read_trajectory(path)
        truth = truth_poses[:, :3]
        if (np.diff(truth_stamps) < 0).any():
            raise InputError(f"{path}: the time stamps decrease")
        pairs = pair(self.stamps, truth_stamps)
        if len(pairs) < 3:
            raise InputError(f"{path}: {len(pairs)} poses are within {MAX_DIFFERENCE} s of a pose of "
                             "the run, at least 3 are needed; is it the same sequence?")
        self._move(*align(self.positions[pairs[:, 0]], truth[pairs[:, 1]],
                          self.alignment == "Sim3"))
        self.error_stamps = self.stamps[pairs[:, 0]]
        difference = self.positions[pairs[:, 0]] - truth[pairs[:, 1]]
        self.errors = np.linalg.norm(difference, axis=1)
        during = (truth_stamps >= self.stamps[0] - 1) & (truth_stamps <= self.stamps[-1] + 1)
        self.truth = truth[during]

    def _move(self, scale, rotation, translation):
        for name in ("positions", "keyframes", "points"):
            setattr(self, name, scale * getattr(self, name) @ rotation.T + translation)
        for item in self.objects:
            item.move(scale, rotation, translation)

    def ate(self):
        return float(np.sqrt(np.mean(self.errors**2)))


class View:
    """A picture of the world along one axis. It must not show a mirrored world."""

    def __init__(self, axes, title, names="xyz", is_flipped=False):
        self.axes, self.title, self.is_flipped = axes, title, is_flipped
        self.names = [names[axis] for axis in axes]


def views_of(run):
    if run.truth is not None:
        return [View([0, 1], "from above"), View([0, 2], "from the side")]
    if run.is_first_camera:
        names = ("x (right)", "y (down)", "z (forward)")
        return [View([0, 2], "x and z of the first camera", names),
                View([0, 1], "x and y of the first camera", names, is_flipped=True)]
    return [View([0, 1], "x and y of the run's world"), View([0, 2], "x and z of the run's world")]


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


def draw_view(plot, run, view):
    """Draws the run along one axis. Returns the labels of the objects."""
    axes = view.axes
    if len(run.points):
        colours = MAP if run.colours is None else run.colours
        plot.scatter(*run.points[:, axes].T, c=colours, s=1.5, alpha=0.5, linewidths=0)
    if run.truth is not None:
        plot.plot(*run.truth[:, axes].T, color=TRUTH, linewidth=2.6, alpha=0.4,
                  label="ground truth")
    plot.plot(*run.positions[:, axes].T, color=ESTIMATE, linewidth=1.2,
              label="HullSLAM" if run.gives_poses else "given poses")
    if len(run.keyframes):
        plot.plot(*run.keyframes[:, axes].T, "o", color=MARK, markersize=3, label="keyframes")
    labels = run_objects.draw_from_afar(plot, run.objects, axes)
    low, high = drawn_part(run, axes)
    plot.set_xlim(low[0], high[0])
    plot.set_ylim(*((high[1], low[1]) if view.is_flipped else (low[1], high[1])))
    plot.set_aspect("equal", adjustable="datalim")
    plot.set_xlabel(f"{view.names[0]} [m]")
    plot.set_ylabel(f"{view.names[1]} [m]")
    plot.set_title(view.title, loc="left")
    plot.grid(alpha=0.25)
    return labels


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
    plot.set_ylim(0, max(1.05e3 * run.errors.max(), 0.1))  # below 0.1 mm it is rounding
    plot.legend(loc="upper right")
    plot.grid(alpha=0.25)


def stage_times(summary):
    """(name, median, p95) in ms for tracking as a whole and for each stage whose times are known.

    A stage that took no time did not run: map_objects tracks no frames.
    """
    keys = [("tracking", ("timing", "track_ms"))]
    keys += [(name, ("timing", "stages_ms", name)) for name in summary.keys("timing", "stages_ms")]
    times = [(name, summary.number(*path, "median"), summary.number(*path, "p95"))
             for name, path in keys]
    return [(name, median, tail) for name, median, tail in times
            if median is not None and tail is not None and tail > 0.0]


def draw_times(plot, run):
    plot.set_title("time per call: median, and 95th percentile")
    plot.set_xlabel("[ms]")
    times = stage_times(run.summary)
    if not times:
        plot.text(0.5, 0.5, "no times of tracking", ha="center", transform=plot.transAxes)
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
    plot.set_yticks(rows, [plain(name) for name in names], fontsize=8)
    plot.invert_yaxis()
    plot.grid(axis="x", alpha=0.25)


def draw(run, path, name):
    figure, plots = plt.subplots(2, 2, figsize=(13, 9), height_ratios=[3, 2],
                                 constrained_layout=True, dpi=110)
    labels = [draw_view(plot, run, view) for plot, view in zip(plots[0], views_of(run))]
    plots[0, 0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, fontsize=8)
    draw_error(plots[1, 0], run)
    draw_times(plots[1, 1], run)
    title = f"{plain(name)}: {len(run.positions)} poses"
    if len(run.keyframes):
        title += f", {len(run.keyframes)} keyframes"
    if run.objects:
        title += f", {sum(item.is_mapped for item in run.objects)} objects"
    if run.errors is not None:
        title += f", ATE RMSE {run.ate():.4f} m ({run.alignment}, {len(run.errors)} pairs)"
    figure.suptitle(title)
    figure.canvas.draw()  # lays out the plots; the positions of the labels depend on this
    figure.set_layout_engine("none")
    for plot, of_plot in zip(plots[0], labels):
        draw_labels(plot, of_plot)
    figure.savefig(path)
    plt.close(figure)


def print_figures(run):
    if run.errors is not None:
        print(f"ATE RMSE         {run.ate():.4f} m ({run.alignment}, all frames, {len(run.errors)} pairs)")
    frames, tracked, lost = (run.summary.number("trajectory", key)
                             for key in ("frames", "tracked", "lost"))
    if frames is not None:
        print(f"frames           {frames:.0f}" + "".join(
            f", {name} {count:.0f}" for name, count in (("tracked", tracked), ("lost", lost))
            if count is not None))
    for name, median, tail in stage_times(run.summary)[:1]:
        print(f"{plain(name):<16} {median:.1f} ms median, {tail:.1f} ms 95th percentile")
    speed = run.summary.number("timing", "frames_per_second")
    if speed:
        print(f"whole run        {speed:.1f} frames/s")


def print_objects(run):
    count = run.summary.number("objects", "count")
    if count is None:
        return
    figures = [("SIoU", "siou_mean", ".3f", ""), ("MTD", "mtd_mean_m2", ".2e", " m2"),
               ("tangents", "tangent_mean_px", ".2f", " px")]
    values = [(name, run.summary.number("objects", key), form, unit)
              for name, key, form, unit in figures]
    text = "".join(f", {name} {value:{form}}{unit}" for name, value, form, unit in values
                   if value is not None)
    print(f"objects          {count:.0f}{text}")


def find_sequence(run, arguments):
    """The folder of the images: the given one, else the one that summary.json names; or None."""
    if arguments.sequence:
        return arguments.sequence
    name = run.summary.text("provenance", "sequence")
    return find_folder(name, arguments.run_dir) if name else None


def align_run(run, arguments, sequence):
    """Aligns the run to the given ground truth, else to that of the sequence if it fits."""
    if arguments.groundtruth:
        run.align_to(arguments.groundtruth)
        return
    if "groundtruth.txt" in run.summary.texts("files"):  # the run had to convert it
        path = arguments.run_dir / "groundtruth.txt"
    else:
        path = sequence / "groundtruth.txt" if sequence else None
    if arguments.no_groundtruth or path is None or not path.exists():
        return
    try:
        run.align_to(path)
    except InputError as error:
        print(f"note: drawn without ground truth: {error}", file=sys.stderr)


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run_dir", type=pathlib.Path, metavar="RUN_DIR")
    parser.add_argument("--groundtruth", type=pathlib.Path, metavar="FILE",
                        help="true trajectory in TUM's format (default: groundtruth.txt of the "
                             "sequence, if it exists)")
    parser.add_argument("--no-groundtruth", action="store_true",
                        help="draw the run in its own frame")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR",
                        help="folder for the pictures (default: RUN_DIR)")
    parser.add_argument("--overlay", type=int, default=0, metavar="N",
                        help="draw the objects on N keyframes")
    parser.add_argument("--sequence", type=pathlib.Path, metavar="DIR",
                        help="folder of the sequence, for its images and its ground truth (default: "
                             "the one that summary.json names; if its path is relative, it is "
                             "looked for in the working directory and in all folders above RUN_DIR)")
    arguments = parser.parse_args(words)
    out = arguments.out or arguments.run_dir
    try:
        if arguments.overlay < 0:
            raise InputError(f"--overlay is {arguments.overlay}, expected 0 or more keyframes")
        run = Run(arguments.run_dir)
        sequence = find_sequence(run, arguments)
        align_run(run, arguments, sequence)
        print_figures(run)
        print_objects(run)
        out.mkdir(parents=True, exist_ok=True)
        overlays = 0
        if arguments.overlay:
            camera, objects = run_objects.read_objects(arguments.run_dir / "objects.json")
            if sequence is None:
                raise InputError(f"{run.summary.path}: names no sequence with images; give "
                                 "--sequence")
            overlays = run_objects.draw_overlays(out / "overlays.png", sequence, camera, objects,
                                                 arguments.overlay)
        draw(run, out / "run.png", arguments.run_dir.resolve().name)
    except (InputError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"picture          {out / 'run.png'}")
    if arguments.overlay:
        print(f"overlays         {out / 'overlays.png' if overlays else 'none: no objects'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
