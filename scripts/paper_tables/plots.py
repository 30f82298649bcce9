# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the page: box plots, errors over time, trajectories, and errors by level, as SVG
in which each figure leads to the folder of its run."""

import io

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from paper_tables.figures import FIGURES  # noqa: E402
from paper_tables.tables import median_run  # noqa: E402
from run_alignment import aligned_errors  # noqa: E402
from support import InputError, one_line, read_trajectory  # noqa: E402

COLUMNS = 3  # of panels
MAX_POINTS = 150  # of a curve
STYLE = {"svg.fonttype": "none", "font.sans-serif": ["DejaVu Sans"], "font.size": 8,
         "axes.titlesize": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False,
         "axes.spines.right": False, "text.parse_math": False}


def styles(count):
    """As many colours that can be told apart; dashes tell the later ones from the first."""
    base = plt.get_cmap("tab10").colors
    return [{"color": base[i % len(base)], "ls": "-" if i < len(base) else "--"} for i in range(count)]


def svg(figure, salt):
    """The text of a figure as an SVG element. The same figure gives the same text."""
    file = io.StringIO()
    with plt.rc_context({"svg.hashsalt": salt}):
        figure.savefig(file, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    plt.close(figure)
    return file.getvalue()[file.getvalue().index("<svg"):].rstrip() + "\n"


def panels(count, width, height):
    """A figure with this many panels and the list of them."""
    columns, rows = min(COLUMNS, count), -(-count // COLUMNS)
    figure, axes = plt.subplots(rows, columns, figsize=(width * columns, height * rows),
                                squeeze=False, layout="constrained")
    for unused in axes.flat[count:]:
        unused.set_visible(False)
    return figure, list(axes.flat[:count])


def name(text):
    return one_line(text, 40)


def link_of(run):
    return f"../runs/{run}/"


def thin(array):
    """At most MAX_POINTS rows, evenly, the last one included."""
    picks = np.linspace(0, len(array) - 1, min(len(array), MAX_POINTS)).round().astype(int)
    return array[np.unique(picks)]


def first_column(report, block):
    """The figure that ranks the rows, and its column."""
    figure = FIGURES[report.table(block).figures[0]]
    return figure, figure.columns[block["mode"]][0]


def draw_values(panel, cell, key, factor, across, along, **style):
    """A point for each run of a cell: along the axis `along` at the place `across`."""
    seeds = sorted(cell["figures"][key]["values"])
    values = [cell["figures"][key]["values"][seed] * factor for seed in seeds]
    places = [across] * len(seeds)
    points = panel.scatter(*((values, places) if along == "x" else (places, values)), **style)
    points.set_urls([link_of(cell["runs"][seed]) for seed in seeds])
    return values


# ---- box plots


def box_plot(report, block):
    """A panel for each sequence with a box for each row; each point is a run."""
    figure_of, column = first_column(report, block)
    shown = {sequence: cells for sequence, cells in block["sequences"].items()
             if any(cell["figures"].get(column.key) for cell in cells)}
    if not shown:
        return None
    figure, axes = panels(len(shown), 3.6, 0.6 + 0.2 * len(report.table(block).rows))
    for panel, (sequence, cells) in zip(axes, shown.items()):
        largest = 0.0
        for place, cell in enumerate(cells):
            if cell["figures"].get(column.key) is None:
                continue
            values = draw_values(panel, cell, column.key, figure_of.factor, place, "x", s=12,
                                 color="#0072b2", zorder=3)
            largest = max(largest, *values)
            if len(values) > 2:
                panel.boxplot([values], positions=[place], vert=False, widths=0.6, showfliers=False,
                              manage_ticks=False, medianprops={"color": "#d55e00"})
        panel.set_yticks(range(len(cells)), [name(report.label(block, cell)) for cell in cells])
        panel.set(ylim=(len(cells) - 0.5, -0.5), xlim=(0.0, 1.05 * largest or 1.0),
                  xlabel=column.heading, title=name(sequence))
    return svg(figure, f"boxes-{block['table']}-{block['mode']}")


# ---- curves of single runs


def read_run(folder, mode):
    """(seconds, errors m, estimated positions, true positions) of a run, aligned to the truth.

    Positions are those of the paired poses (n x 3). None if it has too few poses.
    """
    try:
        estimate, truth = (read_trajectory(folder / file) for file in ("out/trajectory.txt",
                                                                       "groundtruth.txt"))
    except InputError:
        return None
    found = aligned_errors(estimate, truth, mode == "mono")
    return found and (found[0] - truth[0][0], *found[1:])


def median_runs(report, block, sequence):
    """(label, name of the run) of the median run of each row of a sequence."""
    key = FIGURES["ate"].columns[block["mode"]][0].key
    return [(report.label(block, cell), cell["runs"][median_run(cell["figures"][key])])
            for cell in block["sequences"][sequence] if cell["figures"].get(key)]


def plane_of(points):
    """Two orthogonal directions (2 x 3) in which the points extend most."""
    _, _, directions = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    # The sign of a singular vector is arbitrary; its largest component is made positive.
    signs = np.sign(directions[np.arange(3), np.abs(directions).argmax(axis=1)])
    return (directions * signs[:, None])[:2]


def curves(report, block, sequence, out):
    """The error over time and the trajectories of the median runs of a sequence; None if there are
    none."""
    runs = [(label, run, read_run(out / "runs" / run, block["mode"]))
            for label, run in median_runs(report, block, sequence)]
    runs = [(label, run, read) for label, run, read in runs if read is not None]
    if not runs:
        return None
    figure, (left, right, names) = plt.subplots(1, 3, figsize=(12.0, 3.0), layout="constrained",
                                                width_ratios=(3, 2, 1))
    truth = runs[0][2][3]
    middle, plane = truth.mean(axis=0), plane_of(truth)
    right.plot(*thin((truth - middle) @ plane.T).T, color="black", lw=1.5, label="truth")
    for (label, run, (seconds, errors, positions, _)), style in zip(runs, styles(len(runs))):
        for panel, curve in ((left, np.stack([seconds, 1e3 * errors], axis=1)),
                             (right, (positions - middle) @ plane.T)):
            panel.plot(*thin(curve).T, lw=0.8, label=name(label), url=link_of(run), **style)
    left.set(xlabel="time, s", ylabel="error, mm",
             ylim=(0.0, 1.05e3 * max(read[1].max() for _, _, read in runs)))
    right.set(xlabel="m", ylabel="m")
    right.set_aspect("equal", adjustable="datalim")
    figure.suptitle(f"{name(sequence)}: the run of each row with the median error", fontsize=9)
    names.set_axis_off()
    names.legend(*right.get_legend_handles_labels(), loc="center left", frameon=False)
    return svg(figure, f"curves-{block['table']}-{block['mode']}-{sequence}")


# ---- errors by level


def level_plot(report, block):
    """A panel for each sequence and degradation: the figure of each row over the levels, from that
    without it."""
    figure_of, column = first_column(report, block)
    found = [(sequence, degradation) for sequence, cells in block["sequences"].items()
             for degradation in dict.fromkeys(cell["degradation"] for cell in cells) if degradation]
    if not found:
        return None
    figure, axes = panels(len(found), 3.4, 2.4)
    rows = report.table(block).rows
    for panel, (sequence, degradation) in zip(axes, found):
        cells = [cell for cell in block["sequences"][sequence]
                 if cell["degradation"] in (None, degradation)]
        levels = list(dict.fromkeys(report.level(block, cell) for cell in cells))
        shown = [cell for cell in cells if cell["figures"].get(column.key)]
        for row, style in zip(rows, styles(len(rows))):
            of_row = [(levels.index(report.level(block, cell)), cell) for cell in shown
                      if cell["row"] == row.variant]
            for place, cell in of_row:
                draw_values(panel, cell, column.key, figure_of.factor, place, "y", s=8,
                            color=style["color"])
            panel.plot([place for place, _ in of_row],
                       [cell["figures"][column.key]["median"] * figure_of.factor for _, cell in of_row],
                       color=style["color"], lw=1.0, label=name(row.label))
        largest = max((cell["figures"][column.key]["max"] for cell in shown), default=1.0)
        label = report.definitions.degradations[degradation].label
        panel.set_xticks(range(len(levels)), levels)
        panel.set(ylim=(0.0, 1.05 * largest * figure_of.factor), ylabel=column.heading,
                  title=name(label if len(block["sequences"]) == 1 else f"{sequence}: {label}"))
    axes[0].legend(frameon=False)
    return svg(figure, f"levels-{block['table']}-{block['mode']}")
