#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every public header has a user outside of the library; fails if one has none.

A header is public (in include/hullslam) because someone outside of the library includes it, or
because a public header does whose own reason is such a user. Users are

* the programs and examples in Examples, and the tools, benchmarks and the Python module in tools,
  bench and python;
* tests/consumer, the program that links the installed library;
* README.md and docs: a document that names a header by its path, such as hullslam/map/map.h, tells
  its readers to include it.

The library itself (src), src/run and the other tests are no users, because they can include headers
in src. A header without a user belongs in src/<module>.
"""

import pathlib
import re
import sys

from support import check_program, reachable

USERS = ("Examples", "tools", "bench", "python", "tests/consumer")
SOURCES = {".h", ".cc", ".hpp", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*["<](hullslam/[^">]+)[">]', re.MULTILINE)
NAMED = re.compile(r"(?<![\w-])hullslam/\w+/[\w/]+\.h\b")


def public_headers(root):
    """The text of each public header by the name that an #include gives it."""
    return {str(path.relative_to(root / "include")): path.read_text(encoding="utf-8")
            for path in sorted((root / "include" / "hullslam").rglob("*.h"))}


def headers_of_users(root):
    """The names that the users include or name; they need not exist."""
    found = set()
    for folder in USERS:
        for path in (root / folder).rglob("*"):
            if path.suffix in SOURCES:
                found.update(INCLUDE.findall(path.read_text(encoding="utf-8")))
    for path in [root / "README.md", *(root / "docs").rglob("*.md")]:
        if path.exists():
            found.update(NAMED.findall(path.read_text(encoding="utf-8")))
    return found


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no headers is a fault too."""
    root = pathlib.Path(root).resolve()
    headers = public_headers(root)
    if not headers:
        return [f"{root}: no headers in include/hullslam"]
    used = reachable(headers_of_users(root), lambda name: INCLUDE.findall(headers.get(name, "")))
    return [f"include/{name}: no user of the library includes it; it belongs in "
            f"src/{pathlib.PurePath(name).parts[1]}" for name in headers if name not in used]


if __name__ == "__main__":
    sys.exit(check_program(__doc__, check_tree))
