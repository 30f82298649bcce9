#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a finished run and prints its figures. DIR/run.png shows the trajectory, the map and the
objects from two sides, and the error over time. With --overlay N, DIR/overlays.png shows N keyframes
with the outlines of their masks (dotted) and the ellipses of the mapped objects that they observe.

RUN_DIR is a folder that a program has written by --output. What is drawn is the data of its report.html;
without one, or with --groundtruth or --sequence, `hullslam view` makes the data. The run is drawn in
its own world, turned so that up is up; the ground truth is aligned to it. Where frames have no pose,
the path is dotted and the time is shaded.

Exit codes: 0 done, 2 bad usage or input.
"""

import base64
import io
import json
import pathlib
import re
import sys
import tempfile

from support import (call, exit_code, InputError, number, one_line, parser_of, programs_folder,
                     read_json, require, value_at)

require("numpy", "matplotlib")
import matplotlib  # noqa: E402
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

plt.rcParams["text.parse_math"] = False  # a `$` in a name is a dollar
DATA = re.compile(r'<script type="application/json" id="hullslam-data">(.*?)</script>', re.DOTALL)
TYPES = {"f32": "<f4", "u32": "<u4", "u8": "u1"}
ESTIMATE, MARK = "#0072b2", "#d55e00"
NEEDED = tuple(f"{part} left out" for part in ("trajectory", "keyframes", "landmarks", "objects"))


def link_run(arguments, folder):
    """Makes a run in `folder` from links, with the given ground truth and sequence."""
    files = {path.name: path for path in arguments.run_dir.iterdir()
             if path.name not in ("summary.json", "report.html")}
    if arguments.groundtruth:
        files["groundtruth.txt"] = arguments.groundtruth
    for name, path in files.items():
        (folder / name).symlink_to(path.resolve())
    summary = read_json(arguments.run_dir / "summary.json")
    if arguments.sequence:
        summary.setdefault("provenance", {})["sequence"] = str(arguments.sequence.resolve())
    (folder / "summary.json").write_text(json.dumps(summary))


def make_report(run_dir, page):
    program = programs_folder() / "hullslam"
    if not program.is_file():
        raise InputError(f"{program}: no such program; build it (cmake --build --preset release "
                         "--target hullslam_program), or run with --report")
    result = call(program, "view", run_dir, "--report", "--output", page, "--quiet")
    if result.returncode != 0:
        raise InputError(one_line(result.stderr.strip().removeprefix("error: ") or "no message", 400))


def read_report(arguments):
    """The parts of the report, by name."""
    page, is_linked = arguments.run_dir / "report.html", arguments.groundtruth or arguments.sequence
    for path in filter(None, (arguments.groundtruth, arguments.sequence)):
        if not path.exists():
            raise InputError(f"{path}: does not exist")
    with tempfile.TemporaryDirectory() as name:
        if is_linked:
            link_run(arguments, pathlib.Path(name))
        if is_linked or not page.is_file():
            page = pathlib.Path(name) / "report.html"
            make_report(name if is_linked else arguments.run_dir, page)
        try:
            return json.loads(DATA.search(page.read_text(encoding="utf-8", errors="replace"))[1])["set"]
        except (TypeError, ValueError, KeyError) as error:
            raise InputError(f"{page}: is no report of HullSLAM") from error


def rotation(quaternion):
    """The matrix of a quaternion qx, qy, qz, qw."""
    *v, w = np.asarray(quaternion, dtype=float) / np.linalg.norm(quaternion)
    return (2 * w * w - 1) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * np.cross(np.eye(3), v)


class Run:
    """What is drawn. Positions are in the world of the run."""

    def __init__(self, data, with_truth):
        self.data, self.summary = data, data.get("summary") or {}
        self.times, self.poses = self.array("trajectory", "time"), self.array("trajectory", "pose", 7)
        if not len(self.poses):
            raise InputError("the run has no poses")
        self.keyframes = self.array("keyframes", "pose", 7)[:, :3]
        self.points = self.array("landmarks", "position", 3)
        colours = self.array("landmarks", "colour", 3) / 255.0
        self.colours = colours if len(colours) else "#b0b0b0"
        self.truth = self.array("groundtruth", "position", 3)[:None if with_truth else 0]
        self.errors = np.hstack([self.array("errors", key) for key in ("time", "value")])
        self.ate = np.sqrt(np.mean(self.errors[:, 1]**2)) if len(self.errors) and with_truth else None
        is_sim3 = self.summary.get("trajectory", {}).get("alignment") == "sim3"
        self.alignment = "Sim3" if is_sim3 else "SE3"
        self.mapped = [item for item in data.get("objects", []) if item["state"] == "mapped"]
        names = sorted({item["class"] for item in data.get("objects", [])})
        self.class_colours = {name: plt.get_cmap("hsv")(i / len(names)) for i, name in enumerate(names)}
        # The index of the first pose after each stretch of frames without a pose.
        self.losses = [(loss["from"], loss["to"]) for loss in data.get("losses", [])]
        gaps = np.searchsorted(self.times[:, 0], [sum(loss) / 2 for loss in self.losses])
        self.gaps = [int(i) for i in gaps if 0 < i < len(self.times)]
        self.unit = "m" if data["run"]["unit"] == "m" else "units of the map"

    def array(self, part, key, width=1):
        """An array of numbers (n x width) of a part; empty if it is absent."""
        (kind, text), = self.data.get(part, {}).get(key, {"f32": ""}).items()
        return np.frombuffer(base64.b64decode(text), TYPES[kind]).astype(float).reshape(-1, width)


def views_of(run):
    """(title, names of the axes, directions) of two views. Forward is where the first camera looks."""
    if run.data.get("up") is None:
        return [("x and y of the run's world", "xy", np.eye(3)[[0, 1]]),
                ("x and z of the run's world", "xz", np.eye(3)[[0, 2]])]
    up = np.array(run.data["up"]) / np.linalg.norm(run.data["up"])
    turn = rotation(run.poses[0, 3:])
    rights = [np.cross(turn @ axis, up) for axis in ([0.0, 0.0, 1.0], [0.0, -1.0, 0.0])]
    right = rights[0] if np.linalg.norm(rights[0]) > 0.1 else rights[1]  # it may look up or down
    right = right / np.linalg.norm(right)
    return [("from above", ("right", "forward"), np.stack([right, np.cross(up, right)])),
            ("from behind", ("right", "up"), np.stack([right, up]))]


def ellipse_of(item, axes):
    """A polygon (65 x 2) on the parallel projection of an object."""
    half = axes @ rotation(item["rotation"]) @ np.diag(item["half_axes"])
    squares, directions = np.linalg.eigh(half @ half.T)
    turn = np.linspace(0.0, 2.0 * np.pi, 65)
    circle = np.sqrt(np.maximum(squares, 0.0))[:, None] * np.stack([np.cos(turn), np.sin(turn)])
    return axes @ item["centre"] + (directions @ circle).T


def draw_view(plot, run, title, names, axes):
    """Draws the run along one axis. Returns the labels of the objects."""
    path = axes @ run.poses[:, :3].T
    plot.scatter(*(axes @ run.points.T), c=run.colours, s=1.5, alpha=0.5, linewidths=0)
    plot.plot(*(axes @ run.truth.T), color="black", linewidth=2.6, alpha=0.4, label="ground truth")
    for i, part in enumerate(np.split(path, run.gaps, axis=1)):
        plot.plot(*part, color=ESTIMATE, linewidth=1.2, label=None if i else "HullSLAM")
    for i, gap in enumerate(run.gaps):
        plot.plot(*path[:, gap - 1:gap + 1], ":", color=ESTIMATE, label=None if i else "no pose")
    plot.plot(*(axes @ run.keyframes.T), "o", color=MARK, markersize=3, label="keyframes")
    shown = [path.T]
    if len(run.points):  # without the farthest ones
        shown.append(np.percentile(axes @ run.points.T, [3, 97], axis=1))
    for item in run.mapped:
        shown.append(ellipse_of(item, axes))
        plot.plot(*shown[-1].T, color=run.class_colours[item["class"]], linewidth=1.4)
    low, high = np.min(np.vstack(shown), axis=0), np.max(np.vstack(shown), axis=0)
    margin = 0.06 * max((high - low).max(), 0.1)
    plot.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin),
             xlabel=f"{names[0]} [{run.unit}]", ylabel=f"{names[1]} [{run.unit}]")
    plot.set_title(title, loc="left")
    plot.set_aspect("equal", adjustable="datalim")
    return [(f"{item['class']} {item['id']}", axes @ item["centre"]) for item in run.mapped]


def draw_over_time(plot, run):
    """The error or, without ground truth, the distance from the first pose."""
    for first, last in run.losses:
        plot.axvspan(first, last, color=MARK, alpha=0.15, linewidth=0)
    if run.ate is None:
        curve = np.hstack([run.times, np.linalg.norm(run.poses[:, :3] - run.poses[0, :3], axis=1,
                                                     keepdims=True)])
        plot.set(xlabel="time [s]", ylabel=f"distance from the first pose [{run.unit}]")
    else:
        curve = run.errors * [1.0, 1e3]
        plot.axhline(1e3 * run.ate, color=MARK, linewidth=1, linestyle="--")
        plot.set(xlabel="time [s]", ylabel=f"position error [mm], RMSE {1e3 * run.ate:.1f}")
    breaks = np.searchsorted(curve[:, 0], run.times[run.gaps, 0])
    plot.plot(*np.insert(curve, breaks, np.nan, axis=0).T, color=ESTIMATE, linewidth=1)
    plot.set_ylim(bottom=0.0)


def draw_labels(plot, labels):
    """Draws (text, point) unless it would cover an earlier label. Returns how many were drawn."""
    taken, frame = [], plot.get_window_extent()
    for text, point in labels:
        label = plot.text(*point, one_line(text, 40), fontsize=7, ha="center", va="center",
                          bbox={"color": "white", "alpha": 0.6, "pad": 1})
        box = label.get_window_extent()
        is_inside = frame.contains(box.x0, box.y0) and frame.contains(box.x1, box.y1)
        if is_inside and not any(box.overlaps(other) for other in taken):
            taken.append(box)
        else:
            label.remove()
    return len(taken)


def save(figure, labels, path):
    """Saves a figure with the labels [(plot, its labels)]."""
    figure.canvas.draw()  # lays out the plots
    figure.set_layout_engine("none")
    for plot, of_plot in labels:
        draw_labels(plot, of_plot)
    figure.savefig(path)


def draw(run, path, name):
    figure, plots = plt.subplot_mosaic([["left", "right"], ["time", "time"]], figsize=(13, 9),
                                       height_ratios=[3, 2], constrained_layout=True, dpi=110)
    sides = [plots["left"], plots["right"]]
    labels = [draw_view(plot, run, *view) for plot, view in zip(sides, views_of(run))]
    sides[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=8)
    draw_over_time(plots["time"], run)
    figure.suptitle(f"{one_line(name, 40)}: {len(run.poses)} poses, {len(run.keyframes)} keyframes, "
                    f"{len(run.mapped)} objects")
    save(figure, zip(sides, labels), path)


def draw_overlay(plot, picture, colours):
    """Draws a picture of the report. Returns the labels of its ellipses."""
    data, labels = io.BytesIO(base64.b64decode(picture["image"].partition(",")[2])), []
    plot.imshow(plt.imread(data, format="jpeg"), cmap="gray")
    for shape, dashes in [*((shape, ":") for shape in picture["outlines"]),
                          *((shape, "-") for shape in picture["ellipses"])]:
        points = np.reshape(shape["points"], (-1, 2))
        plot.fill(*points.T, fill=False, ls=dashes, lw=1.4, ec=colours.get(shape["class"], MARK))
        if dashes == "-":
            labels.append((f"{shape['class']} {shape['object']}", points.mean(axis=0)))
    plot.set(xlim=(-0.5, picture["width"] - 0.5), ylim=(picture["height"] - 0.5, -0.5),
             title=f"{picture['time']:.2f} s")
    return labels


def draw_overlays(run, count, path):
    """Draws `count` evenly chosen keyframes with objects. Returns their number."""
    if run.data.get("objects") and not run.data.get("images"):
        raise InputError("the report has no images of the run; give their folder by --sequence")
    images = [picture for picture in run.data.get("images", []) if picture["outlines"]]
    picks = np.linspace(0, len(images) - 1, min(count, len(images))).round().astype(int)
    if not len(picks):
        return 0
    shape = -(-len(picks) // 3), min(3, len(picks))
    figure, plots = plt.subplots(*shape, figsize=(6.4 * shape[1], 5.1 * shape[0]), squeeze=False,
                                 constrained_layout=True, dpi=100)
    for plot in plots.flat:
        plot.set_axis_off()
    save(figure, [(plot, draw_overlay(plot, images[i], run.class_colours))
                  for plot, i in zip(plots.flat, picks)], path)
    return len(picks)


def print_figures(run):
    if run.ate is not None:
        print(f"ATE RMSE         {run.ate:.4f} m ({run.alignment}, all frames, {len(run.errors)} pairs)")
    for title, keys in (("frames", ("trajectory", "frames")), ("tracked", ("trajectory", "tracked")),
                        ("tracking, ms", ("timing", "track_ms", "median")),
                        ("objects", ("objects", "count")), ("SIoU", ("objects", "siou_mean"))):
        if (value := value_at(run.summary, *keys)) is not None:
            print(f"{title:<16} {value:.4g}")


def plot_run(arguments):
    data = read_report(arguments)
    for note in data["run"]["notes"]:
        is_wanted = arguments.groundtruth and note.startswith("ground truth left out")
        if note.startswith(NEEDED) or is_wanted:  # a broken file
            raise InputError(f"{arguments.run_dir}: {one_line(note, 400)}")
        print(f"note: {note}", file=sys.stderr)
    run, out = Run(data, not arguments.no_groundtruth), arguments.out or arguments.run_dir
    print_figures(run)
    out.mkdir(parents=True, exist_ok=True)
    drawn = arguments.overlay and draw_overlays(run, arguments.overlay, out / "overlays.png")
    draw(run, out / "run.png", arguments.run_dir.resolve().name)
    print(f"picture          {out / 'run.png'}")
    if arguments.overlay:
        print(f"overlays         {out / 'overlays.png' if drawn else 'none: no objects'}")


def main(words=None):
    parser = parser_of(__doc__)
    parser.add_argument("run_dir", type=pathlib.Path, metavar="RUN_DIR")
    parser.add_argument("--groundtruth", type=pathlib.Path, metavar="FILE",
                        help="true trajectory in TUM's format (default: that of the sequence)")
    parser.add_argument("--no-groundtruth", action="store_true", help="draw the run alone")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="(default: RUN_DIR)")
    parser.add_argument("--overlay", type=number(0, kind=int), default=0, metavar="N",
                        help="draw N keyframes too")
    parser.add_argument("--sequence", type=pathlib.Path, metavar="PATH",
                        help="the sequence of the run (default: the one that summary.json names)")
    return exit_code(plot_run, parser.parse_args(words), failure=2)


if __name__ == "__main__":
    sys.exit(main())
