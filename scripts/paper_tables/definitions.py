# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the definitions of experiments: tables.yaml (variants, what each table shows, what gets worse)
and accuracy.yaml (the cases of the gate)."""

import dataclasses
import pathlib

import jsonschema
import yaml

from paper_tables.figures import FIGURES
from support import InputError, one_line, read_text

MODES = ("rgbd", "mono")  # of tables
ALL_MODES = (*MODES, "stereo")  # of cases of the gate
SCHEMA = pathlib.Path(__file__).with_name("definitions_schema.yaml")
NAMED = ("variants", "degradations", "paper_sequences", "renderings")  # keys whose names others use
TYPES = {"object": "a map of keys and values", "array": "a list", "boolean": "true or false"}
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


# ---- the file


def names_keyword(known):
    """The keyword `one_of` of the schema: the name of a list of names, of which a value must be one."""
    def check(_, key, value, __):
        if not isinstance(value, str) or value not in known[key]:
            yield jsonschema.ValidationError(f"one of: {', '.join(known[key])}")
    return check


def describe(error):
    """What is wrong, as our messages tell it."""
    value, rule = error.instance, error.validator
    if "propertyNames" in error.absolute_schema_path:
        return f"the key '{one_line(value, 40)}' is no " + (
            "name, expected letters, digits and . _ + -" if isinstance(value, str) else
            "text (YAML reads yes, no, on and off as truth values); put it into quotes")
    if rule == "additionalProperties":
        known = error.schema["properties"]
        strange = next(key for key in value if key not in known)
        return f"unknown key '{one_line(strange, 40)}', expected some of: {', '.join(known)}"
    if rule == "required":
        return f"has no key {next(key for key in error.validator_value if key not in value)}"
    expected = error.message if rule == "one_of" else "each entry once" if rule == "uniqueItems" else \
        TYPES.get(error.validator_value if rule == "type" else None) or error.schema["expected"]
    return f"is '{one_line(value, 60)}', expected {expected}"


def fail(path, keys, told):
    """Raises the error of the value at a path of keys."""
    where = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys).lstrip(".")
    raise InputError(f"{path}: {where or 'top level'}: {told}")


def read_checked(path, kind):
    """The content of a file that has the form of the schema."""
    try:
        content = yaml.safe_load(read_text(path))
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise InputError(f"{path}: not valid YAML: {one_line(error)}") from error
    named = {key: content.get(key) for key in NAMED} if isinstance(content, dict) else {}
    known = {key: list(map(str, value)) if isinstance(value, dict) else [] for key, value in named.items()}
    known |= {"figures": list(FIGURES), "modes": MODES if kind == "tables" else ALL_MODES}
    schema = yaml.safe_load(read_text(SCHEMA)) | {"$ref": f"#/$defs/{kind}_file"}
    checks = jsonschema.validators.extend(jsonschema.Draft202012Validator, {"one_of": names_keyword(known)})
    errors = list(checks(schema).iter_errors(content))
    if errors:
        # Faults of names come first, because others follow from them.
        first = min(errors, key=lambda error: ("propertyNames" not in error.absolute_schema_path,
                                               list(map(str, error.absolute_path))))
        fail(path, first.absolute_path, describe(first))
    return content


def made(kind, name, values):
    """A definition from the values of the file."""
    return kind(name=name, **{
        key: tuple(map(str, value)) if key in ("arguments", "options", "levels") else
        tuple(value) if isinstance(value, list) else value for key, value in values.items()})


def make_table(path, name, entry, variants, degradations):
    rows = [{"variant": row} if isinstance(row, str) else row for row in entry["rows"]]
    rows = tuple(Row(**{"label": variants[row["variant"]].label, **row}) for row in rows)
    names = [row.variant for row in rows]
    if not names or len(set(names)) != len(names):
        fail(path, ("tables", name, "rows"), "expected one row or more, each with another variant")
    table = made(Table, name, {"baseline": names[0], **entry, "rows": rows})
    if table.baseline not in names:
        fail(path, ("tables", name, "baseline"),
             f"is '{table.baseline}', expected one of: {', '.join(names)}")
    if len(table.degradations) > 1 and any(degradations[key].unchanged for key in table.degradations):
        fail(path, ("tables", name, "degradations"), "expected one degradation, if it has the key unchanged")
    return table


def make_case(name, entry, variants):
    source = next(key for key in SOURCES if key in entry)
    others = {key: value for key, value in entry.items() if key != source}
    seeds = {"seeds": (None,)} if source == "recorded" else {}
    return made(Case, name, {"source": source, "sequence": entry[source], "variants": tuple(variants),
                             **seeds, **others})


def read_definitions(path, kind="tables"):
    """The Definitions in a file like tables.yaml or, with the kind "cases", accuracy.yaml."""
    content = read_checked(path, kind)
    found = {key: content.get(key) or {} for key in (*NAMED, "tables", "cases")}
    variants = {name: made(Variant, name, {"label": name, "objects": entry.get("masks", True), **entry})
                for name, entry in found["variants"].items()}
    degradations = {name: made(Degradation, name, entry | (
        {"unchanged": str(entry["unchanged"])} if "unchanged" in entry else {}))
        for name, entry in found["degradations"].items()}
    return Definitions(
        variants, degradations, found["paper_sequences"],
        {name: make_table(path, name, entry, variants, degradations)
         for name, entry in found["tables"].items()},
        tuple(Claim(**{**claim, "than": tuple(claim["than"])}) for claim in content.get("claims") or ()),
        {name: tuple(map(str, options)) for name, options in found["renderings"].items()},
        {name: make_case(name, entry, variants) for name, entry in found["cases"].items()})
