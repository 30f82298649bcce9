#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws how the trajectory error of an ablation depends on a number. The variants must be named
NAME-NUMBER (with-1000, with-300, without-1000, ...). Each NAME becomes a curve over NUMBER, and
each sequence has a panel of its own.

OUT is an output folder of scripts/ablation.py. Its ablation.json is read. A point is the mean over
the runs, its bar the standard deviation. A point is hollow if runs failed, or if they tracked fewer
frames than the best variant of the sequence: its error is then that of a part of the sequence.
"""

import argparse
import json
import pathlib
import re
import sys

from support import InputError, exit_code, one_line, read_text, require

require("numpy", "matplotlib")
import matplotlib  # noqa: E402
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

plt.rcParams["text.parse_math"] = False  # a `$` in a name is a dollar

COMPLETE = 0.99  # a variant that tracks at least this share of the best one's frames


def read_points(folder):
    """{sequence: {curve: [(number, ATE mm, deviation mm, is complete), ...]}} of an ablation."""
    path = folder / "ablation.json"
    curves, most = {}, {}
    try:
        results = json.loads(read_text(path))
        for result in results:
            tracked = result["figures"]["tracked"]["mean"] or 0.0
            most[result["sequence"]] = max(most.get(result["sequence"], 0.0), tracked)
        for result in results:
            name = re.fullmatch(r"(.+)-(\d+(?:\.\d+)?)", result["variant"])
            ate = result["figures"]["ATE m"]
            if name is None or ate["mean"] is None:
                continue
            tracked = result["figures"]["tracked"]["mean"] or 0.0
            is_complete = not result["failed"] and tracked >= COMPLETE * most[result["sequence"]]
            curves.setdefault(result["sequence"], {}).setdefault(name[1], []).append(
                (float(name[2]), 1000.0 * ate["mean"], 1000.0 * ate["sd"], is_complete))
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else one_line(error)
        raise InputError(f"{path}: not a valid ablation.json: {reason}") from error
    if not curves:
        raise InputError(f"{path}: no variant named NAME-NUMBER has a trajectory error")
    return {sequence: {name: sorted(points) for name, points in named.items()}
            for sequence, named in curves.items()}


def draw_panel(axes, sequence, curves, x_label):
    for name, points in curves.items():
        numbers, errors, deviations, complete = zip(*points)
        line = axes.errorbar(numbers, errors, yerr=deviations, capsize=3, label=one_line(name, 40))
        colour = line[0].get_color()
        for number, error, is_complete in zip(numbers, errors, complete):
            axes.plot(number, error, "o", color=colour, ms=6,
                      mfc=colour if is_complete else "white")
    ticks = sorted({point[0] for points in curves.values() for point in points})
    axes.set_xscale("log")
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.invert_xaxis()
    axes.set_ylim(bottom=0.0)
    axes.set_title(one_line(sequence, 40))
    axes.set_xlabel(x_label)
    axes.set_ylabel("ATE RMSE, mm")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)


def draw(arguments):
    panels = [panel for folder in arguments.folders for panel in read_points(folder).items()]
    figure, axes = plt.subplots(1, len(panels), figsize=(5.5 * len(panels), 4.0), squeeze=False,
                                layout="constrained")
    for panel, (sequence, curves) in zip(axes[0], panels):
        draw_panel(panel, sequence, curves, arguments.x)
    figure.savefig(arguments.output, dpi=90)
    print(arguments.output)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=pathlib.Path, metavar="OUT", nargs="+")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("ablation.png"),
                        help="file of the picture (default ablation.png)")
    parser.add_argument("--x", default="number", help="label of the x axis: what the numbers are")
    return exit_code(draw, parser.parse_args(), failure=2)


if __name__ == "__main__":
    sys.exit(main())
