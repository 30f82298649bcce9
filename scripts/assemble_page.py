#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the page of the report into one file, from the sources in web/ and three.js.

A browser imports no modules from file://, so the modules are joined to one, in the order of their
imports. Each module may only have imports such as `import { a, b } from './file.js';` and exports
such as `export function a`, `export const a` and `export class a`. Names at the top of a module
must be unique among all modules.

With --cpp the page is written as a C++ file that defines hullslam::PageTemplate().
"""

import pathlib
import re
import sys

from support import exit_code, InputError, parser_of, read_text

IMPORT = re.compile(r"^import\s*\{([^}]*)\}\s*from\s*'\./([\w.-]+)';[ \t]*\n", re.MULTILINE)
EXPORT = re.compile(r"^export (?=(?:async )?(?:function|const|let|class)\b)", re.MULTILINE)
TOP_NAME = re.compile(r"^(?:export )?(?:async )?(?:function|const|let|class) (\w+)", re.MULTILINE)
LEFT_OVER = re.compile(r"^(?:import|export)\b.*", re.MULTILINE)
CHUNK = 8000  # characters of a string in the C++ file


def in_order(folder, name, done, open_modules):
    """Adds the module and those that it imports to `done`: {name: text}, each after its imports."""
    if name in done:
        return
    path = folder / name
    if name in open_modules:
        raise InputError(f"{path}: imports itself through {' '.join(open_modules)}")
    text = read_text(path)
    for names, other in IMPORT.findall(text):
        in_order(folder, other, done, [*open_modules, name])
        exported = {match[1] for match in TOP_NAME.finditer(done[other]) if match[0].startswith("export")}
        if missing := {word.strip() for word in names.split(",") if word.strip()} - exported:
            raise InputError(f"{path}: imports {', '.join(sorted(missing))}, which {other} does not export")
    done[name] = text


def join_modules(folder, main="main.js"):
    """The text of one module with the content of all modules that `main` needs."""
    modules = {}
    in_order(folder, main, modules, [])
    owners = {}
    parts = []
    for name, text in modules.items():
        for match in TOP_NAME.finditer(text):
            if match[1] in owners:
                raise InputError(f"{folder / name}: {match[1]} is also in {owners[match[1]]}; names "
                                "at the top of modules must be unique")
            owners[match[1]] = name
        text = EXPORT.sub("", IMPORT.sub("", text))
        other = LEFT_OVER.search(text)
        if other:
            raise InputError(f"{folder / name}: \"{other[0]}\", expected import {{ a }} from "
                            "'./file.js'; or export before function, const or class")
        parts.append(text.strip())
    return "\n\n".join(parts)


def assemble(folder, three, controls):
    """The page. Its data, @DATA@, is left to the program that writes a report."""
    page = read_text(folder / "index.html")
    contents = {"@STYLE@": read_text(folder / "style.css"), "@THREE@": read_text(three),
                "@CONTROLS@": read_text(controls), "@MODULES@": join_modules(folder)}
    for mark in [*contents, "@DATA@"]:
        if page.count(mark) != 1:
            raise InputError(f"{folder / 'index.html'}: has {mark} {page.count(mark)} times, expected once")
    for mark, text in contents.items():
        if re.search("</(script|style)", text, re.IGNORECASE) or "@DATA@" in text:
            raise InputError(f"the text for {mark} contains the end of its element or @DATA@")
        page = page.replace(mark, text.strip())
    return page


def as_cpp(page):
    """A C++ file that defines the page as a string."""
    mark = "hullslam_page"
    chunks = [page[at:at + CHUNK] for at in range(0, len(page), CHUNK)]
    strings = "\n".join(f'R"{mark}({chunk}){mark}"' for chunk in chunks)
    return ("// Made by scripts/assemble_page.py.\n#include \"view/report_page.h\"\n\n"
            f"namespace hullslam {{\n\nstd::string_view PageTemplate() {{\n  return {strings};\n}}\n\n"
            "}  // namespace hullslam\n")


def run(arguments):
    page = assemble(arguments.web, arguments.three, arguments.controls)
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    arguments.output.write_text(as_cpp(page) if arguments.cpp else page, encoding="utf-8")


if __name__ == "__main__":
    parser = parser_of(__doc__)
    parser.add_argument("web", type=pathlib.Path, help="folder with index.html and the modules")
    parser.add_argument("--three", type=pathlib.Path, required=True, help="three.min.js")
    parser.add_argument("--controls", type=pathlib.Path, required=True, help="OrbitControls.js")
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--cpp", action="store_true", help="write a C++ file instead of HTML")
    sys.exit(exit_code(run, parser.parse_args(), failure=2))
