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


def untested_headers(root):
    headers = root / "include" / "hullslam"
    for header in sorted(headers.rglob("*.h")):
        test = pathlib.Path("tests") / header.relative_to(headers).with_suffix("")
        test = test.with_name(test.name + "_test.cc")
        if not (root / test).exists():
            yield f"{header.relative_to(root)}: no {test}"


def stray_tests(root):
    tests = root / "tests"
    for test in sorted(tests.rglob("*_test.cc")):
        inside = test.relative_to(tests)
        if inside.parts[0] in FREE:
            continue
        header = inside.with_name(inside.name[:-len("_test.cc")] + ".h")
        public = pathlib.Path("include/hullslam") / header
        private = pathlib.Path("src") / header
        if not any((root / path).exists() for path in (public, private, private.with_suffix(".cc"))):
            yield f"{test.relative_to(root)}: neither {public} nor {private} nor its .cc exists"
        if not TEST.search(test.read_text(encoding="utf-8")):
            yield f"{test.relative_to(root)}: contains no test"


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no headers is a fault too."""
    root = pathlib.Path(root).resolve()
    if not any((root / "include" / "hullslam").rglob("*.h")):
        return [f"{root}: no headers in include/hullslam"]
    return [*untested_headers(root), *stray_tests(root)]


if __name__ == "__main__":
    sys.exit(check_program(__doc__, check_tree))
