# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the definitions of experiments: tables.yaml (variants, what each table shows, what gets worse)
and accuracy.yaml (the cases of the gate)."""

import functools
import pathlib
import types

import jsonschema
import yaml

from paper_tables.figures import FIGURES
from support import InputError, one_line, read_text

MODES = ("rgbd", "mono")  # of tables
ALL_MODES = (*MODES, "stereo")  # of cases of the gate
NAMED = ("variants", "degradations", "paper_sequences", "renderings")  # keys whose names others use
TYPES = {"object": "a map of keys and values", "array": "a list", "boolean": "true or false"}


class Definition(types.SimpleNamespace):
    """A variant, a table and so on: a name and the keys of the file. definitions_schema.yaml has the
    meanings of the keys and their defaults."""

    def with_changes(self, **values):
        return Definition(**{**vars(self), **values})


@functools.cache
def read_schema():
    return yaml.safe_load(read_text(pathlib.Path(__file__).with_name("definitions_schema.yaml")))


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
    schema = read_schema() | {"$ref": f"#/$defs/{kind}_file"}
    checks = jsonschema.validators.extend(jsonschema.Draft202012Validator, {"one_of": names_keyword(known)})
    errors = list(checks(schema).iter_errors(content))
    if errors:
        # Faults of names come first, because others follow from them.
        first = min(errors, key=lambda error: ("propertyNames" not in error.absolute_schema_path,
                                               list(map(str, error.absolute_path))))
        fail(path, first.absolute_path, describe(first))
    return content


def made(kind, name, values):
    """A definition from the values of the file; lists become tuples."""
    properties = read_schema()["$defs"][kind]["properties"]
    defaults = {key: of_key.get("default") for key, of_key in properties.items()}
    return Definition(name=name, **{
        key: tuple(map(str, value)) if key in ("arguments", "options", "levels") else
        tuple(value) if isinstance(value, list) else value for key, value in (defaults | values).items()})


def make_table(path, name, entry, variants, degradations):
    rows = [{"variant": row} if isinstance(row, str) else row for row in entry["rows"]]
    rows = [made("row", row["variant"], {"label": variants[row["variant"]].label, **row}) for row in rows]
    names = [row.variant for row in rows]
    if not names or len(set(names)) != len(names):
        fail(path, ("tables", name, "rows"), "expected one row or more, each with another variant")
    table = made("table", name, {"baseline": names[0], **entry, "rows": rows})
    if table.baseline not in names:
        fail(path, ("tables", name, "baseline"),
             f"is '{table.baseline}', expected one of: {', '.join(names)}")
    if len(table.degradations) > 1 and any(degradations[key].unchanged for key in table.degradations):
        fail(path, ("tables", name, "degradations"), "expected one degradation, if it has the key unchanged")
    return table


def make_case(name, entry, variants):
    """A case, with the key of its sequence as `source` and its value as `sequence`."""
    source = next(key for key in ("recorded", "suite", "rendering") if key in entry)
    seeds = {"seeds": [None]} if source == "recorded" else {}
    return made("case", name, {"variants": list(variants), **seeds, **entry, "source": source,
                               "sequence": entry[source]})


def read_definitions(path, kind="tables"):
    """The definitions in a file like tables.yaml or, with the kind "cases", accuracy.yaml."""
    content = read_checked(path, kind)
    found = {key: content.get(key) or {} for key in (*NAMED, "tables", "cases")}
    variants = {name: made("variant", name, {"label": name, "objects": entry.get("masks", True), **entry})
                for name, entry in found["variants"].items()}
    degradations = {name: made("degradation", name, entry | (
        {"unchanged": str(entry["unchanged"])} if "unchanged" in entry else {}))
        for name, entry in found["degradations"].items()}
    return Definition(
        variants=variants, degradations=degradations, paper_sequences=found["paper_sequences"],
        tables={name: make_table(path, name, entry, variants, degradations)
                for name, entry in found["tables"].items()},
        claims=[made("claim", None, claim) for claim in content.get("claims") or ()],
        renderings={name: tuple(map(str, options)) for name, options in found["renderings"].items()},
        cases={name: make_case(name, entry, variants) for name, entry in found["cases"].items()})
