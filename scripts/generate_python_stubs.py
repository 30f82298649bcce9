#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the type stubs of the Python module with their docstrings, which editors show.

python/hullslam/_settings.pyi has the types and meanings of all settings, from the registry of the
library. python/hullslam/_core.pyi is written by hand; only its docstrings are those of the module.

    PYTHONPATH=build/release/python scripts/generate_python_stubs.py [--check]

--check: writes nothing; fails if a file is not the one that would be written.
"""

import ast
import inspect
import sys
import textwrap

import hullslam
from hullslam import _core

from support import parser_of, SCRIPTS

PACKAGE = SCRIPTS.parent / "python" / "hullslam"
HEAD = '''# SPDX-License-Identifier: GPL-3.0-or-later
# Written by scripts/generate_python_stubs.py.
import os
from typing import Any, Literal

from . import _core

_Path = str | os.PathLike[str]
_Values = dict[str, Any]

'''
SETTINGS = '''
class Settings(_core.SettingsTable):
    def __init__(self, file: _Path | None = None, *, preset: _Path | None = None,
                 **values: Any) -> None: ...
    def __getitem__(self, key: str) -> Any: ...
    def __setitem__(self, key: str, value: Any) -> None: ...
    def describe(self, key: str) -> str: ...
    def summary(self, *, changed_only: bool = False) -> str: ...
    def write(self, path: _Path) -> None: ...
'''


def type_of(expected):
    """The type of a setting, from the registry's description of its values."""
    kinds = {"an integer": "int", "a number": "float", "true or false": "bool", "text": "str",
             "name:number": "dict[str, float]"}
    for begin, kind in kinds.items():
        if expected.startswith(begin):
            return kind
    begin, _, choices = expected.partition(": ")
    if begin != "one of":
        raise ValueError(f"a setting with values of an unknown kind: {expected}")
    return "Literal[" + ", ".join(f'"{choice}"' for choice in choices.split(", ")) + "]"


def tree_of(entries):
    """The settings as dicts in dicts, whose leaves are types and docstrings."""
    tree = {}
    for key, _, default, expected, meaning, _ in entries:
        *groups, name = key.split(".")
        level = tree
        for group in groups:
            level = level.setdefault(group, {})
        level[name] = (type_of(expected), f"{meaning} ({expected}; default {default})")
    return tree


def attributes(tree, path):
    for name, value in tree.items():
        if isinstance(value, dict):
            inner = "_" + "_".join([*path, name])
            yield f"@property\ndef {name}(self) -> {inner}: ..."
            yield f"@{name}.setter\ndef {name}(self, values: _Values) -> None: ..."
        else:
            kind, meaning = value
            yield f"{name}: {kind}\n{docstring(meaning, '')}"


def classes(tree, path=()):
    """The classes of the groups, inner ones first."""
    for name, value in tree.items():
        if isinstance(value, dict):
            inner = [*path, name]
            yield from classes(value, inner)
            body = "\n".join(attributes(value, inner))
            yield f"class _{'_'.join(inner)}:\n" + textwrap.indent(body, "    ")


# ---- docstrings


def docstring(text, indent):
    """The text as a docstring, whose first line is not indented."""
    text = inspect.cleandoc(text)
    if "\\" in text or '"""' in text:
        raise ValueError(f"no text for a docstring: {text}")
    lines = text.splitlines()
    end = '"""' if len(lines) == 1 else f'\n{indent}"""'
    rest = "".join(f"\n{indent}{line}" if line else "\n" for line in lines[1:])
    return f'"""{lines[0]}{rest}{end}'


def text_of(owner, name):
    """The docstring of a member without the signature, with which pybind11 begins functions."""
    thing = inspect.getattr_static(owner, name, None)
    if thing is None or isinstance(thing, property):
        return (thing and thing.__doc__ or "").strip()
    text = getattr(owner, name).__doc__ or ""
    head, _, rest = text.partition("\n")
    return (rest if head.startswith(f"{name}(") else text).strip()


def write_docstrings(owner, nodes, lines):
    """Puts the docstrings of the members of `owner` into the lines of their definitions. Begins at
    the end, so that the numbers of the lines before stay right."""
    for node in reversed(nodes):
        if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or not hasattr(owner, node.name):
            continue
        if isinstance(node, ast.ClassDef):
            write_docstrings(getattr(owner, node.name), node.body, lines)
        is_setter = any(isinstance(item, ast.Attribute) for item in node.decorator_list)
        is_special = node.name.startswith("__") and node.name != "__init__"
        text = text_of(owner, node.name)
        if text and not is_setter and not is_special:
            write_docstring(node, text, lines)


def write_docstring(node, text, lines):
    """Replaces the docstring of a definition or a body of three dots, else comes before the body."""
    indent = " " * (node.col_offset + 4)
    new = (indent + docstring(text, indent)).splitlines()
    first = node.body[0]
    begin, end = first.lineno - 1, first.end_lineno
    constant = first.value.value if isinstance(first, ast.Expr) else None
    if constant is ...:
        new.insert(0, lines[begin][:first.col_offset].rstrip())
    elif not isinstance(constant, str):
        decorators = getattr(first, "decorator_list", [])
        begin = end = min(item.lineno for item in (first, *decorators)) - 1
    lines[begin:end] = new


def core_stub():
    lines = (PACKAGE / "_core.pyi").read_text(encoding="utf-8").splitlines()
    write_docstrings(_core, ast.parse("\n".join(lines)).body, lines)
    return "\n".join(lines) + "\n"


def settings_stub():
    tree = tree_of(_core.SettingsTable.defaults())
    own = textwrap.indent("\n".join(attributes(tree, [])), "    ")
    lines = (HEAD + "\n\n".join(classes(tree)) + "\n\n" + SETTINGS + own).splitlines()
    write_docstrings(hullslam, ast.parse("\n".join(lines)).body, lines)
    return "\n".join(lines) + "\n"


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--check", action="store_true")
    is_check = parser.parse_args().check
    for name, text in (("_core.pyi", core_stub()), ("_settings.pyi", settings_stub())):
        path = PACKAGE / name
        if not is_check:
            path.write_text(text, encoding="utf-8")
        elif path.read_text(encoding="utf-8") != text:
            sys.exit(f"{path} is not up to date; run scripts/generate_python_stubs.py")


if __name__ == "__main__":
    main()
