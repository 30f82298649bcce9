#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the pictures of docs/architecture.md into docs/images.

architecture_modules.dot is written from modules.toml, and architecture_data_flow.dot is written by
hand. The program `dot` of Graphviz (Debian package graphviz) makes SVG files from both. With --check
nothing is drawn, and `dot` is not needed: the script fails if architecture_modules.dot does not agree
with modules.toml, or if a picture lacks a text of its .dot file.
"""

import html
import re
import shutil
import subprocess
import sys

from check_layers import LEVELS, MODULES
from support import exit_code, InputError, parser_of, SCRIPTS

IMAGES = SCRIPTS.parent / "docs" / "images"
MODULES_PICTURE = "architecture_modules"
DATA_FLOW = "architecture_data_flow"

CONTENTS = {module: content for modules in MODULES.values() for module, content in modules.items()}
# Colours of the boxes: the foundation, the parts of the map, the stages, and the parts that a user
# calls. Each colour is used from the level of the named module on.
COLOURS = (("util", "#e8f0f8"), ("frame", "#e3f2e1"), ("objects", "#fdf0d5"), ("system", "#f3e6f2"))


def colour(level, levels):
    """The colour of a module at `level`."""
    return [shade for first, shade in COLOURS if levels.get(first, 0) <= level][-1]


def cell(module, shade):
    """A table cell with the name and the content of a module."""
    content = f'  <FONT POINT-SIZE="12">{html.escape(CONTENTS.get(module, ""))}</FONT>'
    return (f'<TD BORDER="1" COLOR="#8a94a0" STYLE="ROUNDED" BGCOLOR="{shade}" '
            f'CELLPADDING="7"><B>{html.escape(module)}</B>{content}</TD>')


def rows(levels):
    """The rows of the picture, from the highest level down: (level, modules)."""
    by_level = {}
    for module, level in levels.items():
        by_level.setdefault(level, []).append(module)
    return sorted(by_level.items(), reverse=True)


def modules_dot(levels):
    """The text of architecture_modules.dot."""
    lines = [
        "// Written by scripts/draw_architecture.py from scripts/modules.toml.",
        "digraph modules {",
        '  graph [bgcolor="white", pad=0.2]',
        '  node [shape=plain, fontname="Helvetica,Arial,sans-serif", fontsize=14]',
        '  modules [label=<<TABLE BORDER="0" CELLSPACING="0" CELLPADDING="2">',
        '    <TR><TD COLSPAN="2" ALIGN="LEFT"><FONT POINT-SIZE="12">Modules and their levels. '
        "A module includes only modules of lower levels.</FONT></TD></TR>",
    ]
    for level, modules in rows(levels):
        cells = "".join(cell(module, colour(level, levels)) for module in modules)
        lines.append(f'    <TR><TD ALIGN="RIGHT">{level}</TD><TD ALIGN="LEFT"><TABLE BORDER="0" '
                     f'CELLSPACING="4" CELLPADDING="0"><TR>{cells}</TR></TABLE></TD></TR>')
    lines += ["  </TABLE>>]", "}", ""]
    return "\n".join(lines)


def words(text):
    """The words of a .dot or .svg text, without tags and entities."""
    text = re.sub(r"<[^>]*>|\\[nlr]", " ", text)
    return set(re.findall(r"\w+", html.unescape(text)))


def labels(dot):
    """The words that a .dot text shows: those of its HTML labels and of its quoted labels."""
    shown = re.findall(r"label=<(.*?)>\]", dot, re.DOTALL)
    shown += re.findall(r'label="([^"]*)"', dot)
    return set().union(*(words(text) for text in shown)) if shown else set()


def faults(folder, levels):
    """What is wrong with the stored pictures in `folder`, as a list of lines."""
    found = []
    stored = folder / f"{MODULES_PICTURE}.dot"
    if not stored.exists() or stored.read_text(encoding="utf-8") != modules_dot(levels):
        found.append(f"{stored}: is not what modules.toml says")
    for name in (MODULES_PICTURE, DATA_FLOW):
        dot, svg = folder / f"{name}.dot", folder / f"{name}.svg"
        for path in (dot, svg):
            if not path.exists():
                found.append(f"{path}: there is no such file")
        if dot.exists() and svg.exists():
            missing = labels(dot.read_text(encoding="utf-8"))
            missing -= words(svg.read_text(encoding="utf-8"))
            if missing:
                found.append(f"{svg}: lacks {', '.join(sorted(missing))}, which {dot.name} has")
    return found


def draw(folder, levels):
    """Writes architecture_modules.dot and both pictures into `folder`."""
    if shutil.which("dot") is None:
        raise InputError("the program dot is missing; install the Debian package graphviz")
    (folder / f"{MODULES_PICTURE}.dot").write_text(modules_dot(levels), encoding="utf-8")
    for name in (MODULES_PICTURE, DATA_FLOW):
        subprocess.run(["dot", "-Tsvg", f"{name}.dot", "-o", f"{name}.svg"], cwd=folder, check=True)


def run(arguments):
    if not arguments.check:
        return draw(IMAGES, LEVELS)
    if found := faults(IMAGES, LEVELS):
        print("\n".join([*found, "run scripts/draw_architecture.py"]), file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    parser = parser_of(__doc__)
    parser.add_argument("--check", action="store_true", help="only compare the stored pictures")
    sys.exit(exit_code(run, parser.parse_args()))
