#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fails on an #include that goes up or sideways between the modules of HullSLAM.

A module includes only headers of its own and of modules of strictly lower levels, and of these only
the ones that its CMakeLists.txt names in LINKS. Public headers include no private headers, and
nothing of CGAL, SuiteSparse or Embree, so that users of the library need none of them.
"""

import argparse
import pathlib
import re
import sys

LEVELS = {
    "util": 0,
    "geometry": 1,
    "camera": 2, "features": 2, "estimators": 2,
    "bow": 3,
    "frame": 4,
    "costs": 5, "matching": 5,
    "map": 6,
    "objects": 7,
    "optim": 8,
    "tracking": 9, "mapping": 9, "loop": 9,
    "system": 10,
    "report": 11,
    "eval": 12,
    "io": 13,
    # A library of the programs, not of libhullslam: it sees all modules, and no module sees it.
    "synthetic": 14,
}
PROGRAM_SIDE = {"synthetic"}

KEPT_PRIVATE = re.compile(
    r"CGAL/|embree\d?/|suitesparse/|Eigen/(Cholmod|SPQR|UmfPack|KLU)Support$"
    r"|(cholmod|amd|colamd|camd|ccolamd|cs|umfpack|klu|SuiteSparse)\w*\.(h|hpp)$",
    re.IGNORECASE)
MODULE_CALL = re.compile(r"hullslam_module\(\s*\w+(?:\s+LINKS([\s\w]*?))?\s*(?=PUBLIC|PRIVATE|\))")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def source_files(root):
    """(path, module, is public header) of every C++ file of the library, in order of the path."""
    for top, public in (("include/hullslam", True), ("src", False)):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cc"):
                inside = path.relative_to(root / top).parts
                yield path, inside[0] if len(inside) > 1 else "", public


def target_module(included, quoted, path, root):
    """The module that an include names: "" where it has none, None for a header from outside."""
    parts = included.split("/")
    if parts[0] == "hullslam":
        return parts[1] if len(parts) > 2 else ""
    if quoted and len(parts) > 1 and parts[0] in LEVELS:
        return parts[0]
    if quoted:
        beside = (path.parent / included).resolve()
        for top in (root / "src", root / "include" / "hullslam"):
            if beside.is_relative_to(top):
                return beside.relative_to(top).parts[0]
    return None


def declared_links(root):
    """The modules that each module names in LINKS, by module; without those that declare none."""
    links = {}
    for module in LEVELS:
        file = root / "src" / module / "CMakeLists.txt"
        call = MODULE_CALL.search(file.read_text(encoding="utf-8")) if file.exists() else None
        if call:
            links[module] = set((call[1] or "").split())
    return links


def fault(module, target, links):
    """Why `module` may not include a header of `target`, or None."""
    if target == module:
        return None
    if target not in LEVELS:
        return f'unknown module "{target}"'
    if LEVELS[target] < LEVELS[module]:
        if target in links.get(module, LEVELS):
            return None
        return f"{module} includes {target}, which src/{module}/CMakeLists.txt does not name in LINKS"
    way = "sideways" if LEVELS[target] == LEVELS[module] else "up"
    return (f"{module} (level {LEVELS[module]}) includes {way}: "
            f"{target} (level {LEVELS[target]})")


def check_file(path, module, public, root, links):
    where = path.relative_to(root)
    if module not in LEVELS:
        return [f'{where}: unknown module "{module}"; add it to LEVELS in check_layers.py']
    if public and module in PROGRAM_SIDE:
        return [f"{where}: {module} belongs to the programs and has no public headers"]
    faults = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        quoted, included = match[1] == '"', match[2]
        if public and KEPT_PRIVATE.match(included):
            faults.append(f"{where}:{number}: {included} in a public header")
        if public and quoted and included.split("/")[0] in LEVELS:
            faults.append(f"{where}:{number}: private header {included} in a public one")
        target = target_module(included, quoted, path, root)
        reason = None if target is None else fault(module, target, links)
        if reason:
            faults.append(f"{where}:{number}: {reason} ({included})")
    return faults


def check_tree(root):
    """The faults of the tree at `root`, one line each. A tree without sources is one."""
    root = pathlib.Path(root).resolve()
    files = list(source_files(root))
    if not files:
        return [f"{root}: no C++ files in include/hullslam or src"]
    links = declared_links(root)
    return [line for path, module, public in files
            for line in check_file(path, module, public, root, links)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", default=pathlib.Path(__file__).resolve().parent.parent,
                        help="top of the repository (default: of this script)")
    faults = check_tree(parser.parse_args().root)
    for line in faults:
        print(line, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
