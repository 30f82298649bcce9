#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes report.html for a finished run or a saved map. The program `view` does the work; it is
looked for in $HULLSLAM_BIN, in build/release/bin, and as hullslam-view on the PATH."""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent


def find_program():
    """The path of the program; None if it is not built and not installed."""
    folders = [os.environ.get("HULLSLAM_BIN"), TOP / "build" / "release" / "bin"]
    for folder in folders:
        if folder and (pathlib.Path(folder) / "view").is_file():
            return pathlib.Path(folder) / "view"
    return shutil.which("hullslam-view")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run_dir", metavar="RUN_DIR", help="output folder of a run, or a map file")
    parser.add_argument("--output", help="the file (default: report.html in RUN_DIR)")
    arguments = parser.parse_args()
    program = find_program()
    if program is None:
        print("error: the program view is not found; build it, or set HULLSLAM_BIN to the folder "
              "of the programs", file=sys.stderr)
        return 2
    command = [str(program), arguments.run_dir, "--report"]
    if arguments.output:
        command += ["--output", arguments.output]
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
