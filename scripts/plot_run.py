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
the run wrote one, else the file in the folder that summary.json names.

Up is where the tops of the images are: with ground truth the nearest axis of its frame, without it
that direction itself. If the cameras do not tell, the views are named by the axes of the frame. Lengths
are in metres if the run has depth, ground truth or objects of known size. Where frames have no pose,
the path is dotted and the time is shaded.

Exit codes: 0 done, 2 bad usage or input.
"""

import argparse
import pathlib
import sys

from python_packages import require

require("numpy", "matplotlib")
import matplotlib  # noqa: E402
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import run_images  # noqa: E402
import run_objects  # noqa: E402
from plot_labels import draw_labels, plain  # noqa: E402
from run_alignment import MAX_DIFFERENCE, align, pair  # noqa: E402
from run_files import InputError, Summary, find_sequence_at, read_map, read_trajectory  # noqa: E402

MAX_POINTS = 30000  # points of the map that are drawn at most
ESTIMATE, TRUTH, MAP, MARK = "#0072b2", "#000000", "#b0b0b0", "#d55e00"
LONG_GAP = 3.5  # median steps between poses; longer ones mean that frames in between have no pose
STAGES = {  # names in summary.json and in the picture
    "frame": "frame: features, depth, masks",
    "pose": "pose of the frame",
    "map_insert": "new keyframe",
    "cull_keyframes": "removal of keyframes",
    "compact_keyframes": "less memory for keyframes",
    "check_objects": "objects: shape and validity",
    "map_landmarks": "new landmarks",
    "map_objects": "objects: matching and start",
    "map_correction": "correction of the map after a loop",
    "map_snapshot": "copy of the map for tracking",
    "local_bundle_adjustment": "local bundle adjustment",
    "loop": "loop closing",
    "loop_detection": "search for loops",
    "loop_adjustment": "adjustment of the map after a loop",
    "global_bundle_adjustment": "adjustment of the whole map",
    "known_sizes": "scale from known sizes",
    "object_changes": "objects: changes since earlier runs",
}


class Run:
    """Everything that is drawn. All positions are in the frame of the ground truth or, without
    ground truth, in that of the run."""

    def __init__(self, run_dir):
        self.stamps, poses = read_trajectory(run_dir / "trajectory.txt")
        self.positions = poses[:, :3]
        lengths = np.linalg.norm(poses[:, 3:], axis=1)
        if not ((lengths > 0.5) & (lengths < 2.0)).all():
            raise InputError(f"{run_dir / 'trajectory.txt'}: a quaternion does not have length 1")
        self.turns = np.array([run_objects.rotation(pose[3:]) for pose in poses])  # world_from_cam
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
        self.is_sim3 = self.summary.text("trajectory", "alignment") == "sim3"
        self.alignment = "Sim3" if self.is_sim3 else "SE3"
        self.truth = self.error_stamps = self.errors = None

    def unit(self):
        """Of all lengths that are drawn."""
        is_metric = (self.truth is not None or not self.is_sim3
                     or (self.summary.number("map", "known_sizes") or 0) > 0)
        return "m" if is_metric else "unknown unit"

    def gaps(self):
        """Index of the last pose before each stretch of frames without a pose."""
        steps = np.diff(self.stamps)
        if len(steps) < 2:
            return []
        return list(np.flatnonzero(steps > LONG_GAP * np.median(steps)))

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
        self.turns = rotation @ self.turns
        for item in self.objects:
            item.move(scale, rotation, translation)

    def level(self, up):
        """Turns the world so that `up` becomes z, and forward, as the first camera looks, becomes y.
        The first camera is then at the origin."""
        forward = self.turns[0] @ [0.0, 0.0, 1.0]
        if np.linalg.norm(np.cross(up, forward)) < 0.1:  # it looks up or down
            forward = self.turns[0] @ [0.0, -1.0, 0.0]
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        rotation = np.stack([right, np.cross(up, right), up])
        self._move(1.0, rotation, -rotation @ self.positions[0])

    def ate(self):
        return float(np.sqrt(np.mean(self.errors**2)))


class View:
    """A picture of the world along one axis. It must not show a mirrored world."""

    def __init__(self, axes, title, names="xyz", is_flipped=False):
        self.axes, self.title, self.is_flipped = axes, title, is_flipped
        self.names = [names[axis] for axis in axes]


def find_up(turns):
    """The unit vector that points up in the world, by the orientations of the cameras; None if they
    are held in too many ways.

    The x axes of cameras that are held upright are horizontal, whether they look ahead or down. If
    the cameras look around, up is the direction at right angles to all of them. If they do not, it
    is the mean of where the tops of the images point.
    """
    top = -turns[:, :, 1].mean(axis=0)
    if np.linalg.norm(top) < 0.5:
        return None
    rights = turns[:, :, 0]
    values, axes = np.linalg.eigh(rights.T @ rights / len(rights))
    is_level, is_unique = values[0] < 0.03, values[1] > 0.1
    if is_level and is_unique and abs(axes[:, 0] @ top) > 0.3:
        return axes[:, 0] * np.sign(axes[:, 0] @ top)
    return top / np.linalg.norm(top)


def flatness(values):
    """The largest share of the values that a fiftieth of their range contains."""
    low, high = np.percentile(values, [3, 97])
    counts, _ = np.histogram(values, bins=50, range=(low, high))
    return counts.max() / max(counts.sum(), 1)


def nearest_axis(up, points):
    """The number of the world's axis that `up` is nearest to; None if it is near to none. If it is
    between two, because the camera looked down all the time, the points decide: desks and floors
    are flat along the vertical axis."""
    near = [axis for axis in range(3) if abs(up[axis]) > np.cos(np.radians(55))]
    if len(near) > 1 and len(points) >= 500:
        return max(near, key=lambda axis: flatness(points[:, axis]))
    return max(near, key=lambda axis: abs(up[axis]), default=None)


def views_along(axis, is_up):
    """From above and from the side, if the world's axis number `axis` points up or down."""
    # Seen from above, the first axis points right and the second one up; their cross product is up.
    first, second = {0: (1, 2), 1: (0, 2), 2: (0, 1)}[axis]
    points_up = {0: True, 1: False, 2: True}[axis]  # of first x second, whether it is +axis
    return [View([first, second], "from above", is_flipped=points_up != is_up),
            View([first, axis], "from the side", is_flipped=not is_up)]


def views_of(run):
    """Two views. Without ground truth the run is levelled for them."""
    up = find_up(run.turns)
    if run.truth is not None:
        axis = None if up is None else nearest_axis(up, run.points)
        if axis is not None:
            return views_along(axis, up[axis] > 0)
        frame = "the ground truth"
    elif up is not None:
        run.level(up)
        names = ("right", "forward", "up, as the camera was held")
        return [View([0, 1], "from above", names), View([0, 2], "from behind", names)]
    else:
        frame = "the run's world"
    return [View([0, 1], f"x and y of {frame}"), View([0, 2], f"x and z of {frame}")]


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


def draw_path(plot, run, axes):
    """The estimated path; dotted from the last pose before a gap to the first one after it."""
    path, gaps = run.positions[:, axes], run.gaps()
    parts = np.split(path, np.array(gaps, dtype=int) + 1)
    for i, part in enumerate(parts):
        plot.plot(*part.T, color=ESTIMATE, linewidth=1.2,
                  label=("HullSLAM" if run.gives_poses else "given poses") if i == 0 else None)
    for i, gap in enumerate(gaps):
        plot.plot(*path[gap:gap + 2].T, color=ESTIMATE, linewidth=1.0, linestyle=":",
                  label="no pose" if i == 0 else None)


def draw_view(plot, run, view):
    """Draws the run along one axis. Returns the labels of the objects."""
    axes = view.axes
    if len(run.points):
        colours = MAP if run.colours is None else run.colours
        plot.scatter(*run.points[:, axes].T, c=colours, s=1.5, alpha=0.5, linewidths=0)
    if run.truth is not None:
        plot.plot(*run.truth[:, axes].T, color=TRUTH, linewidth=2.6, alpha=0.4,
                  label="ground truth")
    draw_path(plot, run, axes)
    if len(run.keyframes):
        plot.plot(*run.keyframes[:, axes].T, "o", color=MARK, markersize=3, label="keyframes")
    labels = run_objects.draw_from_afar(plot, run.objects, axes)
    low, high = drawn_part(run, axes)
    plot.set_xlim(low[0], high[0])
    plot.set_ylim(*((high[1], low[1]) if view.is_flipped else (low[1], high[1])))
    plot.set_aspect("equal", adjustable="datalim")
    plot.set_xlabel(f"{view.names[0]} [{run.unit()}]")
    plot.set_ylabel(f"{view.names[1]} [{run.unit()}]")
    plot.set_title(view.title, loc="left")
    plot.grid(alpha=0.25)
    return labels


def shade_gaps(plot, run):
    """Shades the times without a pose."""
    for i, gap in enumerate(run.gaps()):
        begin, end = run.stamps[gap:gap + 2] - run.stamps[0]
        plot.axvspan(begin, end, color=MARK, alpha=0.15, linewidth=0,
                     label="no pose" if i == 0 else None)


def draw_over_time(plot, run):
    """The error or, without ground truth, the distance from the first pose."""
    plot.set_xlabel("time [s]")
    plot.grid(alpha=0.25)
    shade_gaps(plot, run)
    # Without a line where there is no pose.
    breaks = np.array(run.gaps(), dtype=int) + 1
    if run.errors is None:
        plot.set_title("distance from the first pose over time", loc="left")
        plot.set_ylabel(f"distance [{run.unit()}]")
        distances = np.linalg.norm(run.positions - run.positions[0], axis=1)
        plot.plot(np.insert(run.stamps - run.stamps[0], breaks, np.nan),
                  np.insert(distances, breaks, np.nan), color=ESTIMATE, linewidth=1)
    else:
        plot.set_title("error over time", loc="left")
        plot.set_ylabel("position error [mm]")
        seconds = run.error_stamps - run.stamps[0]
        breaks = np.searchsorted(run.error_stamps, run.stamps[breaks]) if len(breaks) else breaks
        plot.plot(np.insert(seconds, breaks, np.nan), np.insert(1e3 * run.errors, breaks, np.nan),
                  color=ESTIMATE, linewidth=1)
        plot.axhline(1e3 * run.ate(), color=MARK, linewidth=1, linestyle="--",
                     label=f"RMSE {1e3 * run.ate():.1f} mm")
        plot.set_ylim(0, max(1.05e3 * run.errors.max(), 0.1))  # below 0.1 mm it is rounding
    if plot.get_legend_handles_labels()[0]:  # above the plot, where it hides nothing
        plot.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=8)


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
    plot.set_title("time per call: median, and 95th percentile", loc="left")
    plot.set_xlabel("time [ms]")
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
    plot.set_yticks(rows, [plain(STAGES.get(name, name)) for name in names], fontsize=8)
    plot.invert_yaxis()
    plot.grid(axis="x", alpha=0.25)


def describe_poses(run):
    """"40 poses", or how many of the frames have one if some were lost."""
    frames = run.summary.number("trajectory", "frames")
    if frames is None or frames <= len(run.positions):
        return f"{len(run.positions)} poses"
    return f"{len(run.positions)} of {frames:.0f} frames have a pose"


def draw(run, path, name):
    figure, plots = plt.subplots(2, 2, figsize=(13, 9), height_ratios=[3, 2],
                                 constrained_layout=True, dpi=110)
    labels = [draw_view(plot, run, view) for plot, view in zip(plots[0], views_of(run))]
    plots[0, 0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=8)
    draw_over_time(plots[1, 0], run)
    draw_times(plots[1, 1], run)
    title = f"{plain(name)}: {describe_poses(run)}"
    if len(run.keyframes):
        title += f", {len(run.keyframes)} keyframes"
    if run.objects:
        title += f", {sum(item.is_mapped for item in run.objects)} objects"
    if run.errors is not None:
        title += f", ATE RMSE {1e3 * run.ate():.1f} mm ({run.alignment}, {len(run.errors)} pairs)"
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
    return find_sequence_at(name, arguments.run_dir) if name else None


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
                        help="folder of the sequence or video file, for its images and its ground "
                             "truth (default: the one that summary.json names; if its path is "
                             "relative, it is looked for in the working directory and in all folders "
                             "above RUN_DIR)")
    parser.add_argument("--fps", type=float, metavar="N",
                        help="for overlays: images per second, if the run had --fps or if the "
                             "images are numbered and Camera.fps is not 30")
    parser.add_argument("--stamp-offset", type=float, default=0.0, metavar="SECONDS",
                        help="for overlays of a run of mono_video: its --stamp-offset")
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
            overlays = run_objects.draw_overlays(
                out / "overlays.png",
                lambda: run_images.open_images(sequence, arguments.fps, arguments.stamp_offset),
                camera, objects, arguments.overlay)
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
