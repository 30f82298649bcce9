#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the mapped objects of finished runs as a Markdown table. The columns are the class, the
number of observations, the largest angle between two views of the object, the half axes (longest
first), SIoU and tangent distance, all from the file objects.json of each RUN_DIR.
"""

import argparse
import pathlib
import sys

from support import InputError, exit_code, one_line, read_json

HEADER = ("| run | id | class | views | angle ° | half axes m | SIoU | SIoU mask | tangent px |\n"
          "|---|---|---|---|---|---|---|---|---|")


def number(value, form):
    return "-" if value is None else format(float(value), form)


def row(name, entry):
    axes = " ".join(f"{axis:.3f}" for axis in sorted(map(float, entry["half_axes"]), reverse=True))
    return (f"| {name} | {entry['id']} | {entry['class']} | {int(entry['observations'])} | "
            f"{number(entry['parallax_deg'], '.0f')} | {axes} | {number(entry['siou'], '.3f')} | "
            f"{number(entry['siou_mask'], '.3f')} | {number(entry['tangent_px'], '.2f')} |")


def rows(run_dir, min_angle):
    """The rows of the objects whose largest angle is at least `min_angle` degrees."""
    path = run_dir / "objects.json"
    content = read_json(path)
    try:
        return [row(run_dir.resolve().name, entry) for entry in content["objects"]
                if entry["state"] == "mapped" and (entry["parallax_deg"] or 0.0) >= min_angle]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else one_line(error)
        raise InputError(f"{path}: not a valid objects.json: {reason}") from error


def print_table(arguments):
    lines = [line for run_dir in arguments.run_dirs for line in rows(run_dir, arguments.min_angle)]
    print("\n".join([HEADER, *lines]))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run_dirs", type=pathlib.Path, metavar="RUN_DIR", nargs="+")
    parser.add_argument("--min-angle", type=float, default=0.0, metavar="DEGREES",
                        help="leave out objects whose largest angle is smaller (default 0)")
    return exit_code(print_table, parser.parse_args(), failure=2)


if __name__ == "__main__":
    sys.exit(main())
