#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes python/hullslam/_settings.pyi: the types of all settings, from the registry of the library.

    PYTHONPATH=build/release/python scripts/generate_python_stubs.py [--check]

--check: writes nothing; fails if the file is not the one that would be written.
"""

import argparse
import pathlib
import sys
import textwrap

from hullslam import _core

STUB = pathlib.Path(__file__).resolve().parents[1] / "python" / "hullslam" / "_settings.pyi"
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
    """The settings as dicts in dicts, whose leaves are types."""
    tree = {}
    for key, _, _, expected, _, _ in entries:
        *groups, name = key.split(".")
        level = tree
        for group in groups:
            level = level.setdefault(group, {})
        level[name] = type_of(expected)
    return tree


def attributes(tree, path):
    for name, value in tree.items():
        if isinstance(value, dict):
            inner = "_" + "_".join([*path, name])
            yield f"@property\ndef {name}(self) -> {inner}: ..."
            yield f"@{name}.setter\ndef {name}(self, values: _Values) -> None: ..."
        else:
            yield f"{name}: {value}"


def classes(tree, path=()):
    """The classes of the groups, inner ones first."""
    for name, value in tree.items():
        if isinstance(value, dict):
            inner = [*path, name]
            yield from classes(value, inner)
            body = "\n".join(attributes(value, inner))
            yield f"class _{'_'.join(inner)}:\n" + textwrap.indent(body, "    ")


def stub():
    tree = tree_of(_core.SettingsTable.defaults())
    own = textwrap.indent("\n".join(attributes(tree, [])), "    ")
    return HEAD + "\n\n".join(classes(tree)) + "\n\n" + SETTINGS + own + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    if parser.parse_args().check:
        if STUB.read_text(encoding="utf-8") != stub():
            sys.exit(f"{STUB} is not up to date; run scripts/generate_python_stubs.py")
    else:
        STUB.write_text(stub(), encoding="utf-8")


if __name__ == "__main__":
    main()
