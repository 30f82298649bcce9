#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes one job of a plan of scripts/reproduce_tables.py, in the working directory.

    table_job.py PLAN run|folder NAME

Snakemake starts it; there is no need to call it by hand.
"""

import sys

from paper_tables.engine import job

if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[2] not in ("run", "folder"):
        print(__doc__, end="", file=sys.stderr)
        sys.exit(2)
    sys.exit(job(sys.argv[1:]))
