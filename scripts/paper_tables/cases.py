# SPDX-License-Identifier: GPL-3.0-or-later
"""The cases of scripts/accuracy.py: reads accuracy.yaml, finds or renders their sequences, and plans
their runs with the planner of the tables."""

import dataclasses
import pathlib
import re
import subprocess

from paper_tables.definitions import (MODES, NAME, Definitions, Node, load, read_degradation,
                                      read_variant)
from paper_tables.plan import DIGITS, RESULT_VERSION, Planner, Request
from paper_tables.sequences import read_sequence
from run_errors import InputError, one_line
from run_files import read_json

SOURCES = ("recorded", "suite", "rendering")


@dataclasses.dataclass(frozen=True)
class Case:
    name: str
    source: str  # one of SOURCES
    sequence: str
    seeds: tuple = (None,)  # of renderings; None for a recorded sequence
    first: tuple = (0,)
    last: int = None
    degradation: str = None
    modes: tuple = MODES
    variants: tuple = ()


@dataclasses.dataclass(frozen=True)
class Cases:
    definitions: Definitions
    renderings: dict  # name -> options of make_synthetic
    cases: dict


# ---- the file


def whole_numbers(node):
    found = tuple(item.value for item in node.items())
    is_good = found and all(type(value) is int and value >= 0 for value in found)
    if not is_good or len(set(found)) != len(found):
        node.fail("a list of different whole numbers from 0 on")
    return found


def read_case(name, node, cases):
    keys = node.mapping((*SOURCES, "seeds", "first", "last", "degradation", "modes", "variants"))
    if not re.fullmatch(NAME, name):
        raise InputError(f"{node.path}: cases: '{one_line(name, 40)}' is no name")
    sources = [source for source in SOURCES if source in keys]
    if len(sources) != 1:
        node.fail(f"one of the keys {', '.join(SOURCES)}")
    source, = sources
    is_recorded, known = source == "recorded", cases.definitions
    if is_recorded and "seeds" in keys:
        keys["seeds"].fail("nothing, because a recorded sequence has no seed")
    sequence = keys[source].one_of(cases.renderings) if source == "rendering" else \
        keys[source].text()
    return Case(name, source, sequence,
                (None,) if is_recorded else
                whole_numbers(keys["seeds"]) if "seeds" in keys else (0,),
                whole_numbers(keys["first"]) if "first" in keys else (0,),
                keys["last"].count() if "last" in keys else None,
                keys["degradation"].one_of(known.degradations) if "degradation" in keys else None,
                keys["modes"].texts(MODES) if "modes" in keys else MODES,
                keys["variants"].texts(tuple(known.variants)) if "variants" in keys
                else tuple(known.variants))


def read_cases(path):
    """The content of a file like accuracy.yaml."""
    keys = Node(load(path), path, "").mapping(("variants", "degradations", "renderings", "cases"))
    for needed in ("variants", "cases"):
        if needed not in keys:
            raise InputError(f"{path}: has no key {needed}")
    maps = {key: node.mapping() for key, node in keys.items()}
    definitions = Definitions(
        {name: read_variant(name, node) for name, node in maps["variants"].items()}, {}, {},
        {name: read_degradation(name, node)
         for name, node in maps.get("degradations", {}).items()}, ())
    found = Cases(definitions, {name: node.arguments()
                                for name, node in maps.get("renderings", {}).items()}, {})
    for name, node in maps["cases"].items():
        found.cases[name] = read_case(name, node, found)
    return found


# ---- sequences


def rendering_folder(case, seed, renderings):
    """Where what a case needs is rendered: alone, unless the whole suite is there."""
    whole = renderings / f"suite-{seed}"
    is_whole = case.source == "suite" and whole.is_dir()
    return whole if is_whole else renderings / f"{case.sequence}-{seed}"


def needed_renderings(cases, chosen, renderings):
    """{folder: options} of the renderings of the chosen cases that are not there."""
    found = {}
    for case in chosen:
        for seed in case.seeds if case.source != "recorded" else ():
            folder = rendering_folder(case, seed, renderings)
            options = ["--suite", str(folder), "--only", case.sequence] \
                if case.source == "suite" else [str(folder), *cases.renderings[case.sequence]]
            if not folder.exists():
                found[folder] = [*options, "--seed", str(seed), "--quiet"]
    return found


def render(folder, options, program):
    """Renders a sequence or a suite. make_synthetic leaves the folder only when it is complete."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    result = subprocess.run([str(program), *options], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise InputError(f"{program} {' '.join(options)}: "
                         f"{one_line(result.stderr.strip() or 'has failed', 300)}")


def find_sequence(case, seed, data, renderings, config):
    """The sequence of a case; None if a recorded one is absent."""
    if case.source == "recorded":
        folder = data / case.sequence
        return read_sequence(str(folder), None, {}, config) if folder.is_dir() else None
    top = rendering_folder(case, seed, renderings)
    if case.source == "rendering":
        sequence = read_sequence(str(top), None, {}, config)
        return dataclasses.replace(sequence, name=f"{case.sequence}-{seed}")
    entry = next((entry for entry in read_json(top / "suite.json").get("sequences", [])
                  if entry["name"] == case.sequence), None)
    if entry is None:
        raise InputError(f"{top}: has no sequence {case.sequence}")
    sequence = read_sequence(f"{entry['dataset']}={top / entry['folder']}",
                             str((top / entry["masks"]).resolve()), {}, config)
    return dataclasses.replace(sequence, name=f"{case.sequence}-{seed}",
                               objects=str((top / entry["objects"]).resolve()))


# ---- runs


class CasePlanner:
    """Collects the runs of cases in a plan of paper_tables/plan.py. Each run also tells its case."""

    def __init__(self, cases, tools, timeout):
        self.cases, self.tools, self.timeout = cases, tools, timeout
        self.runs, self.folders = {}, {}

    def add(self, case, sequence, firsts):
        degradation = case.degradation and self.cases.definitions.degradations[case.degradation]
        level = degradation.levels[0] if degradation else None
        for first in firsts:
            frames = None if case.last is None else case.last - first + 1
            planner = Planner(Request(self.cases.definitions, [sequence], (), MODES, range(1), frames,
                                      timeout=self.timeout), self.tools)
            for mode in case.modes:
                for variant in case.variants:
                    planner.add(sequence, mode, self.cases.definitions.variants[variant], first,
                                degradation, level)
            for name, run in planner.runs.items():
                if name in self.runs:
                    raise InputError(f"the cases {self.runs[name]['case']} and {case.name} have the "
                                     f"same run {name}")
                self.runs[name] = {**run, "case": case.name,
                                   "input": sequence.fingerprint[:DIGITS]}
            self.folders |= planner.folders

    def plan(self):
        return {"version": RESULT_VERSION, "config": str(self.tools.config),
                "evaluate": str(self.tools.path("evaluate")), "timeout": self.timeout,
                "runs": self.runs, "folders": self.folders}
