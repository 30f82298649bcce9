# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads tables.yaml: the variants, what each table shows, and what gets worse in the last one."""

import dataclasses
import re

import yaml

from paper_tables.figures import FIGURES
from run_errors import InputError, one_line

MODES = ("rgbd", "mono")
NAME = r"[A-Za-z0-9][\w.+-]*"  # also the name of a folder


@dataclasses.dataclass(frozen=True)
class Variant:
    name: str
    label: str
    arguments: tuple = ()
    masks: bool = True
    objects: bool = True  # whether it maps objects
    modes: tuple = MODES
    same_as: str = None  # the variant whose runs it shares without a rolling shutter


@dataclasses.dataclass(frozen=True)
class Row:
    variant: str
    label: str
    paper: str = None  # the name of the row in paper_tables.json


@dataclasses.dataclass(frozen=True)
class Degradation:
    name: str
    label: str
    levels: tuple
    arguments: tuple = ()  # of the program
    options: tuple = ()  # of degrade_sequence.py
    only_with_objects: bool = False
    modes: tuple = MODES
    unchanged: str = None  # the level of runs without it, if it is one of a scale


@dataclasses.dataclass(frozen=True)
class Table:
    name: str
    title: str
    rows: tuple
    modes: tuple
    figures: tuple
    baseline: str
    paper: str = None
    only: tuple = None  # the sequences of the paper that it has; None: all sequences
    sequences: int = None  # the largest number of sequences; None: no limit
    degradations: tuple = ()


@dataclasses.dataclass(frozen=True)
class Claim:
    text: str
    figure: str
    better: str
    than: tuple


@dataclasses.dataclass(frozen=True)
class Definitions:
    variants: dict
    paper_sequences: dict  # name in the paper -> end of the name of the folder
    tables: dict
    degradations: dict
    claims: tuple


class Node:
    """A value of the file, with the path of keys that leads to it, for messages."""

    def __init__(self, value, path, where):
        self.value, self.path, self.where = value, path, where

    def fail(self, expected):
        raise InputError(f"{self.path}: {self.where or 'top level'}: is "
                         f"'{one_line(self.value, 60)}', expected {expected}")

    def mapping(self, known=None):
        if not isinstance(self.value, dict):
            self.fail("a map of keys and values")
        for key in self.value:
            if not isinstance(key, str):
                raise InputError(f"{self.path}: {self.where or 'top level'}: the key "
                                 f"'{one_line(key, 40)}' is no text (YAML reads yes, no, on and off "
                                 "as truth values); put it into quotes")
            if known is not None and key not in known:
                raise InputError(f"{self.path}: {self.where or 'top level'}: unknown key "
                                 f"'{one_line(key, 40)}', expected some of: {', '.join(known)}")
        return {key: self.at(key) for key in self.value}

    def at(self, key):
        where = f"{self.where}.{key}" if self.where else str(key)
        return Node(self.value.get(key), self.path, where)

    def text(self):
        if not isinstance(self.value, str) or not self.value.strip():
            self.fail("a text")
        return self.value

    def flag(self):
        if not isinstance(self.value, bool):
            self.fail("true or false")
        return self.value

    def count(self):
        if not isinstance(self.value, int) or isinstance(self.value, bool) or self.value < 1:
            self.fail("a whole number from 1 on")
        return self.value

    def items(self):
        if not isinstance(self.value, list):
            self.fail("a list")
        return [Node(value, self.path, f"{self.where}[{i}]") for i, value in enumerate(self.value)]

    def texts(self, allowed=None):
        found = tuple(item.one_of(allowed) if allowed else item.text() for item in self.items())
        if len(set(found)) != len(found) and allowed:
            self.fail("each entry once")
        return found

    def one_of(self, allowed):
        if self.value not in list(allowed):
            self.fail(f"one of: {', '.join(allowed)}")
        return self.value

    def arguments(self):
        """Arguments of a program; numbers become texts."""
        return tuple(str(item.value) if isinstance(item.value, (int, float)) else item.text()
                     for item in self.items())


def read_variant(name, node):
    if not re.fullmatch(NAME, name):
        raise InputError(f"{node.path}: variants: '{one_line(name, 40)}' is no name, expected "
                         "letters, digits and . _ + -")
    keys = node.mapping(("label", "arguments", "masks", "objects", "modes", "same_as"))
    masks = keys["masks"].flag() if "masks" in keys else True
    return Variant(name, keys["label"].text() if "label" in keys else name,
                   keys["arguments"].arguments() if "arguments" in keys else (), masks,
                   keys["objects"].flag() if "objects" in keys else masks,
                   keys["modes"].texts(MODES) if "modes" in keys else MODES,
                   keys["same_as"].text() if "same_as" in keys else None)


def read_degradation(name, node):
    keys = node.mapping(("label", "levels", "arguments", "options", "only_with_objects", "modes",
                         "unchanged"))
    for needed in ("label", "levels"):
        keys.get(needed) or node.fail(f"the key {needed}")
    if "arguments" not in keys and "options" not in keys:
        node.fail("arguments or options")
    return Degradation(name, keys["label"].text(), keys["levels"].arguments(),
                       keys["arguments"].arguments() if "arguments" in keys else (),
                       keys["options"].arguments() if "options" in keys else (),
                       keys["only_with_objects"].flag() if "only_with_objects" in keys else False,
                       keys["modes"].texts(MODES) if "modes" in keys else MODES,
                       read_unchanged(keys) if "unchanged" in keys else None)


def read_unchanged(keys):
    for node in (keys["unchanged"], *keys["levels"].items()):
        if not isinstance(node.value, (int, float)) or isinstance(node.value, bool):
            node.fail("a number, because the key unchanged says that the levels are a scale")
    return str(keys["unchanged"].value)


def read_row(node, variants):
    if isinstance(node.value, str):
        name = node.one_of(variants)
        return Row(name, variants[name].label)
    keys = node.mapping(("variant", "label", "paper"))
    "variant" in keys or node.fail("the key variant")
    name = keys["variant"].one_of(variants)
    return Row(name, keys["label"].text() if "label" in keys else variants[name].label,
               keys["paper"].text() if "paper" in keys else None)


def read_table(name, node, variants, degradations, paper_sequences):
    keys = node.mapping(("title", "rows", "modes", "figures", "baseline", "paper", "only",
                         "sequences", "degradations"))
    for needed in ("title", "rows", "figures"):
        keys.get(needed) or node.fail(f"the key {needed}")
    rows = tuple(read_row(item, variants) for item in keys["rows"].items())
    names = [row.variant for row in rows]
    if not rows or len(set(names)) != len(names):
        keys["rows"].fail("one row or more, each with another variant")
    shown = keys["degradations"].texts(tuple(degradations)) if "degradations" in keys else ()
    if len(shown) > 1 and any(degradations[key].unchanged for key in shown):
        keys["degradations"].fail("one degradation, if it has the key unchanged")
    return Table(name, keys["title"].text(), rows,
                 keys["modes"].texts(MODES) if "modes" in keys else MODES,
                 keys["figures"].texts(tuple(FIGURES)),
                 keys["baseline"].one_of(names) if "baseline" in keys else names[0],
                 keys["paper"].text() if "paper" in keys else None,
                 keys["only"].texts(tuple(paper_sequences)) if "only" in keys else None,
                 keys["sequences"].count() if "sequences" in keys else None,
                 shown)


def read_claim(node, variants):
    keys = node.mapping(("text", "figure", "better", "than"))
    for needed in ("text", "figure", "better", "than"):
        keys.get(needed) or node.fail(f"the key {needed}")
    return Claim(keys["text"].text(), keys["figure"].one_of(tuple(FIGURES)),
                 keys["better"].one_of(variants), keys["than"].texts(tuple(variants)))


def load(path):
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file: {error}") from error
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise InputError(f"{path}: not valid YAML: {one_line(error)}") from error


def read_definitions(path):
    """The Definitions in a file like tables.yaml."""
    keys = Node(load(path), path, "").mapping(
        ("variants", "paper_sequences", "tables", "degradations", "claims"))
    for needed in ("variants", "tables"):
        if needed not in keys:
            raise InputError(f"{path}: has no key {needed}")
    optional = {key: keys[key].mapping() if key in keys else {}
                for key in ("paper_sequences", "degradations")}
    variants = {name: read_variant(name, node) for name, node in keys["variants"].mapping().items()}
    for name, variant in variants.items():
        if variant.same_as is not None:
            keys["variants"].at(name).at("same_as").one_of(variants)
    paper_sequences = {name: node.text() for name, node in optional["paper_sequences"].items()}
    degradations = {name: read_degradation(name, node)
                    for name, node in optional["degradations"].items()}
    tables = {name: read_table(name, node, variants, degradations, paper_sequences)
              for name, node in keys["tables"].mapping().items()}
    claims = tuple(read_claim(item, variants) for item in keys["claims"].items()) \
        if "claims" in keys else ()
    return Definitions(variants, paper_sequences, tables, degradations, claims)
