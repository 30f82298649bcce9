# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the page: box plots, errors over time, trajectories, and errors by level, as SVG
in which each figure leads to the folder of its run."""

import io

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from paper_tables.cells import level_text, median_run  # noqa: E402
from paper_tables.figures import FIGURES  # noqa: E402
from plot_labels import plain  # noqa: E402
from run_alignment import align, pair  # noqa: E402
from run_errors import InputError  # noqa: E402
from run_files import read_trajectory  # noqa: E402

COLUMNS = 3  # of panels
MAX_POINTS = 150  # of a curve
STYLE = {"svg.fonttype": "none", "font.sans-serif": ["DejaVu Sans"], "font.size": 8,
         "axes.titlesize": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False,
         "axes.spines.right": False}


def colours(count):
    """As many colours that can be told apart; dashes tell the later ones from the first."""
    base = plt.get_cmap("tab10").colors
    return [(base[i % len(base)], "-" if i < len(base) else "--") for i in range(count)]


def svg(figure, salt):
    """The text of a figure as an SVG element. The same figure gives the same text."""
    file = io.StringIO()
    with plt.rc_context({"svg.hashsalt": salt}):
        figure.savefig(file, format="svg", metadata=dict.fromkeys(
            ("Date", "Creator", "Format", "Type")))
    plt.close(figure)
    text = file.getvalue()
    return text[text.index("<svg"):].rstrip() + "\n"


def panels(count, width, height):
    """A figure with this many panels and the list of them."""
    columns = min(COLUMNS, count)
    rows = -(-count // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(width * columns, height * rows),
                                squeeze=False, layout="constrained")
    flat = list(axes.flat)
    for unused in flat[count:]:
        unused.set_visible(False)
    return figure, flat[:count]


def link_of(name):
    return f"../runs/{name}/"


def thin(array):
    """At most MAX_POINTS rows, evenly, the last one included."""
    if len(array) <= MAX_POINTS:
        return array
    return array[np.unique(np.linspace(0, len(array) - 1, MAX_POINTS).round().astype(int))]


# ---- box plots


def box_plot(report, block):
    """A panel for each sequence with a box for each row; each point is a run."""
    table = report.table(block)
    figure_of = FIGURES[table.figures[0]]
    column = figure_of.columns[block["mode"]][0]
    names = [name for name, cells in block["sequences"].items()
             if any(cell["figures"].get(column.key) for cell in cells)]
    if not names:
        return None
    figure, axes = panels(len(names), 3.6, 0.6 + 0.2 * len(table.rows))
    for panel, name in zip(axes, names):
        cells = block["sequences"][name]
        largest = 0.0
        for place, cell in enumerate(cells):
            entry = cell["figures"].get(column.key)
            if entry is None:
                continue
            largest = max(largest, entry["max"] * figure_of.factor)
            seeds = sorted(entry["values"])
            values = [entry["values"][seed] * figure_of.factor for seed in seeds]
            if len(values) > 2:
                panel.boxplot([values], positions=[place], vert=False, widths=0.6, showfliers=False,
                              manage_ticks=False, medianprops={"color": "#d55e00"})
            points = panel.scatter(values, [place] * len(values), s=12, color="#0072b2", zorder=3)
            points.set_urls([link_of(cell["runs"][seed]) for seed in seeds])
        panel.set_yticks(range(len(cells)), [plain(report.label(block, cell)) for cell in cells])
        panel.set_ylim(len(cells) - 0.5, -0.5)
        panel.set_xlim(0.0, 1.05 * largest or 1.0)
        panel.set_xlabel(plain(column.heading))
        panel.set_title(plain(name))
    return svg(figure, f"boxes-{block['table']}-{block['mode']}")


# ---- curves of single runs


def read_run(folder, mode):
    """(seconds, errors m, estimated positions, true positions) of a run, aligned to the truth.

    Positions are those of the paired poses (n x 3). None if it has too few poses.
    """
    try:
        stamps, poses = read_trajectory(folder / "out" / "trajectory.txt")
        truth_stamps, truth = read_trajectory(folder / "groundtruth.txt")
    except InputError:
        return None
    pairs = pair(stamps, truth_stamps)
    if len(pairs) < 3:
        return None
    source, target = poses[pairs[:, 0], :3], truth[pairs[:, 1], :3]
    scale, rotation, translation = align(source, target, mode == "mono")
    moved = scale * source @ rotation.T + translation
    seconds = stamps[pairs[:, 0]] - truth_stamps[0]
    return seconds, np.linalg.norm(moved - target, axis=1), moved, target


def median_runs(report, block, name):
    """(label, name of the run) of the median run of each row of a sequence."""
    column = FIGURES["ate"].columns[block["mode"]][0]
    return [(report.label(block, cell), cell["runs"][median_run(cell["figures"][column.key])])
            for cell in block["sequences"][name] if cell["figures"].get(column.key)]


def plane_of(points):
    """Two orthogonal directions (2 x 3) in which the points extend most."""
    _, _, directions = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    # The sign of a singular vector is arbitrary; its largest component is made positive.
    signs = np.sign(directions[np.arange(3), np.abs(directions).argmax(axis=1)])
    return (directions * signs[:, None])[:2]


def draw_errors(panel, runs, styles):
    for (label, name, run), (colour, dashes) in zip(runs, styles):
        curve = thin(np.stack([run[0], 1e3 * run[1]], axis=1))
        panel.plot(curve[:, 0], curve[:, 1], dashes, color=colour, lw=0.8, label=plain(label),
                   url=link_of(name))
    panel.set_xlabel("time, s")
    panel.set_ylabel("error, mm")
    panel.set_ylim(0.0, 1.05e3 * max(run[1].max() for _, _, run in runs))


def draw_paths(panel, runs, styles):
    truth = runs[0][2][3]
    plane = plane_of(truth)
    path = thin((truth - truth.mean(axis=0)) @ plane.T)
    panel.plot(path[:, 0], path[:, 1], color="black", lw=1.5, label="truth")
    for (label, name, run), (colour, dashes) in zip(runs, styles):
        path = thin((run[2] - truth.mean(axis=0)) @ plane.T)
        panel.plot(path[:, 0], path[:, 1], dashes, color=colour, lw=0.8, label=plain(label),
                   url=link_of(name))
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_xlabel("m")
    panel.set_ylabel("m")


def curves(report, block, name, out):
    """The error over time and the trajectories of the median runs of a sequence; None if there are
    none."""
    runs = [(label, run, read_run(out / "runs" / run, block["mode"]))
            for label, run in median_runs(report, block, name)]
    runs = [(label, run, read) for label, run, read in runs if read is not None]
    if not runs:
        return None
    figure, (left, right, names) = plt.subplots(1, 3, figsize=(12.0, 3.0), layout="constrained",
                                                width_ratios=(3, 2, 1))
    styles = colours(len(runs))
    draw_errors(left, runs, styles)
    draw_paths(right, runs, styles)
    figure.suptitle(f"{plain(name)}: the run of each row with the median error", fontsize=9)
    handles, labels = right.get_legend_handles_labels()
    names.set_axis_off()
    names.legend(handles, labels, loc="center left", frameon=False)
    return svg(figure, f"curves-{block['table']}-{block['mode']}-{name}")


# ---- errors by level


def level_plot(report, block):
    """A panel for each sequence and degradation: the figure of each row over the levels, from that
    without it."""
    table = report.table(block)
    figure_of = FIGURES[table.figures[0]]
    column = figure_of.columns[block["mode"]][0]
    found = [(sequence, name) for sequence, cells in block["sequences"].items()
             for name in dict.fromkeys(cell["degradation"] for cell in cells) if name]
    if not found:
        return None
    figure, axes = panels(len(found), 3.4, 2.4)
    for panel, (sequence, name) in zip(axes, found):
        cells = [cell for cell in block["sequences"][sequence]
                 if cell["degradation"] in (None, name)]
        levels = list(dict.fromkeys(level_text(table, report.definitions, cell) for cell in cells))
        for row, (colour, _) in zip(table.rows, colours(len(table.rows))):
            draw_levels(panel, [(levels.index(level_text(table, report.definitions, cell)), cell)
                                for cell in cells if cell["row"] == row.variant],
                        column.key, figure_of.factor, colour, row.label)
        panel.set_xticks(range(len(levels)), levels)
        largest = max((cell["figures"][column.key]["max"] for cell in cells
                       if cell["figures"].get(column.key)), default=1.0)
        panel.set_ylim(0.0, 1.05 * largest * figure_of.factor)
        panel.set_ylabel(plain(column.heading))
        label = report.definitions.degradations[name].label
        panel.set_title(plain(label if len(block["sequences"]) == 1 else f"{sequence}: {label}"))
    axes[0].legend(frameon=False)
    return svg(figure, f"levels-{block['table']}-{block['mode']}")


def draw_levels(panel, cells, key, factor, colour, label):
    """Draws a row. `cells`: (place on the axis, cell)."""
    places, medians = [], []
    for place, cell in cells:
        entry = cell["figures"].get(key)
        if entry is None:
            continue
        places.append(place)
        medians.append(entry["median"] * factor)
        seeds = sorted(entry["values"])
        points = panel.scatter([place] * len(seeds),
                               [entry["values"][seed] * factor for seed in seeds], s=8, color=colour)
        points.set_urls([link_of(cell["runs"][seed]) for seed in seeds])
    panel.plot(places, medians, color=colour, lw=1.0, label=plain(label))
