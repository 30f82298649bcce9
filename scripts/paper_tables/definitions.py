# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the definitions of experiments: tables.yaml (variants, what each table shows, what gets worse)
and accuracy.yaml (the cases of the gate)."""

import dataclasses
import re

import yaml

from paper_tables.figures import FIGURES
from support import InputError, one_line, read_text

MODES = ("rgbd", "mono")  # of tables
ALL_MODES = (*MODES, "stereo")  # of cases of the gate
NAME = r"[A-Za-z0-9][\w.+-]*"  # also the name of a folder
SOURCES = ("recorded", "suite", "rendering")


@dataclasses.dataclass(frozen=True)
class Variant:
    name: str
    label: str
    arguments: tuple = ()
    masks: bool = True
    objects: bool = True  # whether it maps objects
    modes: tuple = ALL_MODES
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
    modes: tuple = ALL_MODES
    unchanged: str = None  # the level of runs without it, if it is one of a scale


@dataclasses.dataclass(frozen=True)
class Table:
    name: str
    title: str
    rows: tuple
    figures: tuple
    baseline: str
    modes: tuple = MODES
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
class Case:
    name: str
    source: str  # one of SOURCES
    sequence: str
    variants: tuple
    seeds: tuple = (0,)  # of renderings; (None,) for a recorded sequence
    first: tuple = (0,)
    last: int = None
    degradation: str = None
    modes: tuple = MODES


@dataclasses.dataclass(frozen=True)
class Definitions:
    variants: dict
    degradations: dict
    paper_sequences: dict = dataclasses.field(default_factory=dict)  # name -> end of the folder's name
    tables: dict = dataclasses.field(default_factory=dict)
    claims: tuple = ()
    renderings: dict = dataclasses.field(default_factory=dict)  # name -> options of make_synthetic
    cases: dict = dataclasses.field(default_factory=dict)


class Node:
    """A value of the file, with the path of keys that leads to it, for messages."""

    def __init__(self, value, path, where=""):
        self.value, self.path, self.where = value, path, where

    def fail(self, expected):
        raise InputError(f"{self.path}: {self.where or 'top level'}: is "
                         f"'{one_line(self.value, 60)}', expected {expected}")

    def mapping(self, known=None, needed=()):
        if not isinstance(self.value, dict):
            self.fail("a map of keys and values")
        for key in self.value:
            told = f"{self.path}: {self.where or 'top level'}: "
            if not isinstance(key, str):
                raise InputError(f"{told}the key '{one_line(key, 40)}' is no text (YAML reads yes, no, on "
                                 "and off as truth values); put it into quotes")
            if known is not None and key not in known:
                raise InputError(f"{told}unknown key '{one_line(key, 40)}', expected some of: "
                                 f"{', '.join(known)}")
        for key in needed:
            if self.value.get(key) is None:
                self.fail(f"the key {key}")
        return {key: self.at(key) for key in self.value}

    def named(self):
        """A map whose keys are names of folders."""
        found = self.mapping()
        for key in found:
            if not re.fullmatch(NAME, key):
                raise InputError(f"{self.path}: {self.where}: '{one_line(key, 40)}' is no name, expected "
                                 "letters, digits and . _ + -")
        return found

    def read(self, readers, needed=()):
        """The values of a map, each by the reader of its key."""
        return {key: readers[key](node) for key, node in self.mapping(tuple(readers), needed).items()}

    def at(self, key):
        return Node(self.value.get(key), self.path, f"{self.where}.{key}" if self.where else str(key))

    def text(self):
        if not isinstance(self.value, str) or not self.value.strip():
            self.fail("a text")
        return self.value

    def flag(self):
        if not isinstance(self.value, bool):
            self.fail("true or false")
        return self.value

    def number(self, expected="a number", kinds=(int, float), least=-float("inf")):
        if not isinstance(self.value, kinds) or isinstance(self.value, bool) or self.value < least:
            self.fail(expected)
        return self.value

    def count(self):
        return self.number("a whole number from 1 on", int, 1)

    def items(self):
        if not isinstance(self.value, list):
            self.fail("a list")
        return [Node(value, self.path, f"{self.where}[{i}]") for i, value in enumerate(self.value)]

    def arguments(self):
        """Arguments of a program; numbers become texts."""
        return tuple(str(item.value) if isinstance(item.value, (int, float)) else item.text()
                     for item in self.items())

    def one_of(self, allowed):
        if self.value not in list(allowed):
            self.fail(f"one of: {', '.join(allowed)}")
        return self.value

    def some_of(self, allowed):
        found = tuple(item.one_of(allowed) for item in self.items())
        if len(set(found)) != len(found):
            self.fail("each entry once")
        return found

    def whole_numbers(self):
        found = tuple(item.value for item in self.items())
        is_good = found and all(type(value) is int and value >= 0 for value in found)
        if not is_good or len(set(found)) != len(found):
            self.fail("a list of different whole numbers from 0 on")
        return found


def one_of(allowed):
    return lambda node: node.one_of(allowed)


def some_of(allowed):
    return lambda node: node.some_of(tuple(allowed))


def read_variant(name, node):
    found = node.read({"label": Node.text, "arguments": Node.arguments, "masks": Node.flag,
                       "objects": Node.flag, "modes": some_of(MODES), "same_as": Node.text})
    return Variant(**{"name": name, "label": name, "objects": found.get("masks", True), **found})


def read_degradation(name, node):
    found = node.read({"label": Node.text, "levels": Node.arguments, "arguments": Node.arguments,
                       "options": Node.arguments, "only_with_objects": Node.flag,
                       "modes": some_of(MODES), "unchanged": lambda node: str(node.value)},
                      ("label", "levels"))
    if "arguments" not in found and "options" not in found:
        node.fail("arguments or options")
    for item in [node.at("unchanged"), *node.at("levels").items()] if "unchanged" in found else ():
        item.number("a number, because the key unchanged says that the levels are a scale")
    return Degradation(name=name, **found)


def read_row(node, variants):
    if isinstance(node.value, str):
        return Row(node.one_of(variants), variants[node.value].label)
    found = node.read({"variant": one_of(variants), "label": Node.text, "paper": Node.text}, ("variant",))
    return Row(**{"label": variants[found["variant"]].label, **found})


def read_table(name, node, variants, degradations, paper_sequences):
    found = node.read({
        "title": Node.text, "rows": lambda node: tuple(read_row(item, variants) for item in node.items()),
        "modes": some_of(MODES), "figures": some_of(FIGURES), "baseline": Node.text, "paper": Node.text,
        "only": some_of(paper_sequences), "sequences": Node.count,
        "degradations": some_of(degradations)}, ("title", "rows", "figures"))
    names = [row.variant for row in found["rows"]]
    if not names or len(set(names)) != len(names):
        node.at("rows").fail("one row or more, each with another variant")
    if "baseline" in found:
        node.at("baseline").one_of(names)
    shown = found.get("degradations", ())
    if len(shown) > 1 and any(degradations[key].unchanged for key in shown):
        node.at("degradations").fail("one degradation, if it has the key unchanged")
    return Table(**{"name": name, "baseline": names[0], **found})


def read_case(name, node, variants, degradations, renderings):
    found = node.read({"recorded": Node.text, "suite": Node.text, "rendering": one_of(renderings),
                       "seeds": Node.whole_numbers, "first": Node.whole_numbers, "last": Node.count,
                       "degradation": one_of(degradations), "modes": some_of(ALL_MODES),
                       "variants": some_of(variants)})
    sources = [source for source in SOURCES if source in found]
    if len(sources) != 1:
        node.fail(f"one of the keys {', '.join(SOURCES)}")
    source, = sources
    if source == "recorded" and found.setdefault("seeds", (None,)) != (None,):
        node.at("seeds").fail("nothing, because a recorded sequence has no seed")
    return Case(**{"name": name, "source": source, "sequence": found.pop(source),
                   "variants": tuple(variants), **found})


def read_definitions(path, kind="tables"):
    """The Definitions in a file like tables.yaml or, with the kind "cases", accuracy.yaml."""
    others = {"tables": ("paper_sequences", "claims"), "cases": ("renderings",)}[kind]
    try:
        top = Node(yaml.safe_load(read_text(path)), path)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise InputError(f"{path}: not valid YAML: {one_line(error)}") from error
    keys = top.mapping(("variants", "degradations", kind, *others))
    for needed in ("variants", kind):
        if needed not in keys:
            raise InputError(f"{path}: has no key {needed}")

    def each(key, read, *known):
        return {name: read(name, node, *known) for name, node in keys[key].named().items()} \
            if key in keys else {}
    variants, degradations = each("variants", read_variant), each("degradations", read_degradation)
    for name, variant in variants.items():
        if variant.same_as is not None:
            keys["variants"].at(name).at("same_as").one_of(variants)
    if kind == "cases":
        renderings = each("renderings", lambda _, node: node.arguments())
        return Definitions(variants, degradations, renderings=renderings,
                           cases=each("cases", read_case, variants, degradations, renderings))
    paper_sequences = each("paper_sequences", lambda _, node: node.text())
    claim = {"text": Node.text, "figure": one_of(FIGURES), "better": one_of(variants),
             "than": some_of(variants)}
    claims = keys["claims"].items() if "claims" in keys else ()
    return Definitions(variants, degradations, paper_sequences,
                       each("tables", read_table, variants, degradations, paper_sequences),
                       tuple(Claim(**node.read(claim, tuple(claim))) for node in claims))
