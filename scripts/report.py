#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes report.html for a finished run or a saved map. The program `view` does the work."""

import argparse
import pathlib
import subprocess
import sys

from run_programs import programs_folder


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run_dir", metavar="RUN_DIR", help="output folder of a run, or a map file")
    parser.add_argument("--output", help="the file (default: report.html in RUN_DIR)")
    parser.add_argument("--programs", type=pathlib.Path, default=programs_folder(),
                        metavar="FOLDER",
                        help="(default: those of this installation or of build/release/bin)")
    arguments = parser.parse_args()
    program = arguments.programs / "view"
    if not program.is_file():
        print(f"error: {program}: no such program; build it (cmake --build --preset release) or "
              "give its folder by --programs", file=sys.stderr)
        return 2
    command = [str(program), arguments.run_dir, "--report"]
    if arguments.output:
        command += ["--output", arguments.output]
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
