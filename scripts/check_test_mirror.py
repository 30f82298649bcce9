#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that the tests mirror the headers; fails if one of these rules is broken.

1. Every public header include/hullslam/<module>/<file>.h has a test tests/<module>/<file>_test.cc.
2. Every tests/<module>/<file>_test.cc is named after such a header or after a private file
   src/<module>/<file>.h or .cc, and contains at least one test.

The folders integration, support, consumer, fuzz and scripts of tests/ are not checked.
"""

import pathlib
import re
import sys

from support import check_program

FREE = {"integration", "support", "consumer", "fuzz", "scripts"}
TEST = re.compile(r"^\s*(TYPED_)?TEST(_F|_P)?\s*\(", re.MULTILINE)


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no headers is a fault too."""
    root = pathlib.Path(root).resolve()
    public, private, tests = root / "include" / "hullslam", root / "src", root / "tests"
    headers = sorted(public.rglob("*.h"))
    if not headers:
        return [f"{root}: no headers in include/hullslam"]
    faults = []
    for header in headers:
        test = tests / header.relative_to(public).with_name(f"{header.stem}_test.cc")
        if not test.exists():
            faults.append(f"{header.relative_to(root)}: no {test.relative_to(root)}")
    for test in sorted(tests.rglob("*_test.cc")):
        inside = test.relative_to(tests)
        if inside.parts[0] in FREE:
            continue
        name = inside.stem.removesuffix("_test") + ".h"
        tested = [folder / inside.with_name(name) for folder in (public, private)]
        if not any(path.exists() for path in (*tested, tested[1].with_suffix(".cc"))):
            names = " nor ".join(str(header.relative_to(root)) for header in tested)
            faults.append(f"{test.relative_to(root)}: neither {names} nor its .cc exists")
        if not TEST.search(test.read_text(encoding="utf-8")):
            faults.append(f"{test.relative_to(root)}: contains no test")
    return faults


if __name__ == "__main__":
    sys.exit(check_program(__doc__, check_tree))
