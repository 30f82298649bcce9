#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""report.py RUN_DIR|MAP [--output FILE]: the short form of the program `view RUN_DIR|MAP --report`."""

import os
import sys

from support import programs_folder

if __name__ == "__main__":
    program = programs_folder() / "view"
    if not program.is_file():
        print(f"error: {program}: no such program; build it (cmake --build --preset release)",
              file=sys.stderr)
        sys.exit(2)
    os.execv(program, [str(program), "--report", *sys.argv[1:]])
