# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes tables of results: median and spread of each figure, failed runs, comparisons, claims and ranks,
gathered in one report, of which all files are written."""

import csv
import dataclasses
import io
import json
import statistics

from paper_tables.definitions import MODES
from paper_tables.figures import FIGURES
from run_statistics import compare, flip_probability
from support import InputError, read_json, value_at

REPORT_VERSION = 1  # of tables.json
MODE_TITLES = {"rgbd": "RGB-D", "mono": "monocular"}
SIGNIFICANT = 0.05  # the largest p of a difference that is called significant
COMPARED = ("ate", "lost", "siou", "mtd")  # with another report
CSV_HEAD = ("table", "mode", "sequence", "paper_sequence", "row", "degradation", "level", "figure",
            "median", "min", "max", "runs", "failed", "not_run", "paper")


def spread(values):
    """{median, min, max, values} of the values by seed; None without a value."""
    known = {seed: value for seed, value in values.items() if value is not None}
    if not known:
        return None
    return {"median": statistics.median(known.values()), "min": min(known.values()),
            "max": max(known.values()), "values": known}


def paper_value(paper, section, mode, row, sequence, figure):
    """The figure of the paper in the unit of a run (metres, 0 to 1); None if it has none.

    Table I has a part for each mode. Those of the other tables agree with its monocular part, and
    the systems of Table II are those of this part.
    """
    if None in (row, sequence, section):
        return None
    if section == "ate":
        return value_at(paper, section, mode, row, sequence) if figure == "ate" else None
    if mode != "mono":
        return None
    if section == "integration":
        return value_at(paper, section, "rows", row, sequence) if figure == "ate" else None
    value = value_at(paper, section, "rows", sequence, row, figure)
    factor = {"ate": 1e-2, "mtd": 1e-3}.get(figure, 1.0)  # these tables have cm and 1e-3 m2
    return None if value is None else value * factor


# ---- comparisons of two sets of runs


def difference(figure, base, other):
    """{change, p, pairs} of the figures `other` against `base`.

    The change is relative for the figures of which less is better (geometric mean over the pairs),
    else absolute (mean). None without a pair.
    """
    if FIGURES[figure].lower_is_better and figure != "lost":
        change, p, pairs = compare(base, other)
        return None if change is None else {"change": change, "p": p, "pairs": pairs, "is_relative": True}
    pairs = [other[key] - base[key] for key in sorted(base.keys() & other.keys())]
    return {"change": statistics.fmean(pairs), "p": flip_probability(pairs), "pairs": len(pairs),
            "is_relative": False} if pairs else None


def verdict(figure, change):
    """better, worse, or unclear if the difference may be chance."""
    if change is None:
        return "unknown"
    if change["p"] > SIGNIFICANT or change["change"] == 0.0:
        return "unclear"
    return "better" if (change["change"] < 0.0) == bool(FIGURES[figure].lower_is_better) else "worse"


def answer(figure, changes):
    """yes, no or unclear: of several comparisons, the least favourable one decides."""
    verdicts = [verdict(figure, change) for change in changes.values()]
    if "worse" in verdicts:
        return "no"
    return "yes" if all(found == "better" for found in verdicts) else "unclear"


def values_of(runs, column):
    """{key: figure} of the runs {key: run} that have not failed."""
    found = {key: value_at(run["figures"], column) for key, run in runs.items() if run and not run["failure"]}
    return {key: value for key, value in found.items() if value is not None}


def grouped(runs):
    """{(mode, variant with degradation): {(sequence, seed): run}}"""
    found = {}
    for run in runs.values():
        level = f"+{run['degradation']}-{run['level']}" if run.get("degradation") else ""
        found.setdefault((run["mode"], run["variant"] + level), {})[run["sequence"], run["seed"]] = run
    return found


def compare_reports(old, new):
    """A list of {mode, variant, common, failed_before, failed_after, figures}, and how many runs
    only one of the reports has."""
    before, after = grouped(old["runs"]), grouped(new["runs"])
    rows = []
    for mode, variant in sorted(before.keys() & after.keys()):
        runs = before[mode, variant], after[mode, variant]
        common = runs[0].keys() & runs[1].keys()
        changes = {key: difference(key, *(values_of(of, FIGURES[key].columns[mode][0].key) for of in runs))
                   for key in COMPARED}
        if common:
            rows.append({
                "mode": mode, "variant": variant,
                "figures": {key: {**change, "verdict": verdict(key, change)}
                            for key, change in changes.items() if change is not None},
                **{name: sum(1 for key in common if of[key]["failure"])
                   for name, of in zip(("failed_before", "failed_after"), runs)}, "common": len(common)})
    only = [sum(len(runs.keys() - other.get(key, {}).keys()) for key, runs in one.items())
            for one, other in ((before, after), (after, before))]
    return {"old_git": old.get("git"), "new_git": new.get("git"), "rows": rows,
            "only_before": only[0], "only_after": only[1]}


# ---- the report


@dataclasses.dataclass
class Block:
    """A table in one mode: its cells by sequence, and how its rows compare over all sequences."""
    table: object
    mode: str
    sequences: dict  # name -> cells
    overall: dict = dataclasses.field(default_factory=dict)  # row -> comparison with the baseline

    def __post_init__(self):
        # (key, figure, column) of each column
        self.columns = [(key, FIGURES[key], column) for key in self.table.figures
                        for column in FIGURES[key].columns[self.mode]]
        self.cells = [(name, cell) for name, cells in self.sequences.items() for cell in cells]
        self.title = f"Table {self.table.name}: {self.table.title}, {MODE_TITLES[self.mode]}"

    def as_json(self):
        return {"table": self.table.name, "mode": self.mode, "sequences": self.sequences,
                "overall": self.overall}


class Report:
    """Everything that tables, pages and comparisons show."""

    def __init__(self, request, plan, cells, results, paper):
        self.definitions, self.plan, self.results, self.paper = (request.definitions, plan, results, paper)
        self.seeds, self.frames, self.is_quick = request.seeds, request.frames, request.is_quick
        self.sequences = {sequence.name: sequence for sequence in request.sequences}
        self.plays = {name: sequence.paper for name, sequence in self.sequences.items()}
        self.blocks = [self.make_block(self.definitions.tables[name], mode, {
            sequence: of_sequence for (of_table, of_mode, sequence), of_sequence in cells.items()
            if (of_table, of_mode) == (name, mode)}) for name in request.tables
            for mode in self.definitions.tables[name].modes if mode in request.modes]
        self.claims = self.answer_claims()

    def make_block(self, table, mode, cells):
        block = Block(table, mode, {name: [self.make_cell(cell, table, mode, name) for cell in of_sequence]
                                    for name, of_sequence in cells.items()})
        figure = table.figures[0]
        column = FIGURES[figure].columns[mode][0].key
        base = values_of(self.runs_of(block, table.baseline), column)
        for row in table.rows:
            runs = self.runs_of(block, row.variant)
            change = None if row.variant == table.baseline else \
                difference(figure, base, values_of(runs, column))
            block.overall[row.variant] = {
                "difference": change, "verdict": verdict(figure, change), "runs": len(runs),
                "failed": sum(1 for run in runs.values() if run and run["failure"])}
        return block

    def make_cell(self, cell, table, mode, sequence):
        """A row of a table for one sequence, with the figures of the paper in the unit of a run.

        Failed runs are counted, with their reasons, and left out of all figures but the share of frames
        without a pose.
        """
        done = {seed: self.results[name] for seed, name in cell["runs"].items() if self.results.get(name)}
        failures = {seed: result["failure"] for seed, result in done.items() if result["failure"]}
        figures = {column.key: spread({
            seed: result["figures"].get(column.key) for seed, result in done.items()
            if key == "lost" or seed not in failures})
                   for key in table.figures for column in FIGURES[key].columns[mode]}
        row = next(row for row in table.rows if row.variant == cell["row"])
        papers = {key: None if cell["degradation"] else paper_value(
            self.paper, table.paper, mode, row.paper, self.plays.get(sequence), key) for key in table.figures}
        return {**cell, "label": row.label, "figures": figures, "papers": papers, "done": len(done),
                "missing": sorted(cell["runs"].keys() - done.keys()), "failures": failures}

    def runs_of(self, block, row):
        """{(sequence, degradation, level, seed): result} of the runs of a row."""
        return {(sequence, cell["degradation"] or "", cell["level"] or "", seed): self.results.get(name)
                for sequence, cell in block.cells if cell["row"] == row
                for seed, name in cell["runs"].items()}

    def answer_claims(self):
        """For each claim and mode: the difference of `better` against each of the others."""
        runs = {}  # (mode, variant) -> {key: result}, without degraded runs
        for block in self.blocks:
            for row in block.table.rows:
                runs.setdefault((block.mode, row.variant), {}).update(
                    {key: run for key, run in self.runs_of(block, row.variant).items() if not key[1]})
        answers = []
        for claim in self.definitions.claims:
            for mode in MODES:
                column = FIGURES[claim.figure].columns[mode][0].key
                values = {name: values_of(runs.get((mode, name), {}), column)
                          for name in (claim.better, *claim.than)}
                changes = {name: difference(claim.figure, values[name], values[claim.better])
                           for name in claim.than}
                if any(changes.values()):
                    answers.append({"text": claim.text, "figure": claim.figure, "mode": mode,
                                    "better": claim.better, "answer": answer(claim.figure, changes),
                                    "than": changes})
        return answers

    def columns(self, block):
        """The sequences of a table in the order of the paper, then the others. Those of the paper
        that the user does not have are None: [(name, name in the paper)]."""
        order = list(self.definitions.paper_sequences)
        found = [(name, self.plays[name]) for name in block.sequences]
        if not block.table.degradations:
            had = {paper for _, paper in found}
            found += [(None, paper) for paper in block.table.only or order if paper not in had]
        return sorted(found, key=lambda pair: order.index(pair[1]) if pair[1] else len(order))

    def builds(self):
        """The commits of the programs that made the runs."""
        return sorted({result["git"] for result in self.results.values() if result and result.get("git")})

    def as_json(self):
        runs = {name: {**{key: run[key] for key in ("sequence", "mode", "variant", "seed", "degradation",
                                                    "level")},
                       **({key: self.results[name][key] for key in
                           ("failure", "preset", "settings_hash", "figures")}
                          if self.results.get(name) else {"failure": "not run", "figures": {}})}
                for name, run in sorted(self.plan["runs"].items())}
        return {"version": REPORT_VERSION, "git": self.builds(), "seeds": list(self.seeds),
                "frames": self.frames, "spread": "min to max", "units": "metres, square metres, "
                "shares of 1; lost in percent", "paper": self.paper["source"],
                "sequences": {name: {"dataset": sequence.dataset, "paper": sequence.paper,
                                     "is_rendered": sequence.rendered is not None,
                                     "note": sequence.note}
                              for name, sequence in self.sequences.items()},
                "variants": {name: {"label": variant.label, "arguments": variant.arguments,
                                    "masks": variant.masks}
                             for name, variant in self.definitions.variants.items()},
                "tables": [block.as_json() for block in self.blocks], "claims": self.claims, "runs": runs}

    def json_text(self):
        return json.dumps(self.as_json(), indent=1) + "\n"

    def csv_text(self):
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(CSV_HEAD)
        for block in self.blocks:
            for sequence, cell in block.cells:
                for key, figure, column in block.columns:
                    entry = cell["figures"].get(column.key) or {}
                    paper = cell["papers"][key] if column is figure.columns[block.mode][-1] else None
                    values = [*(entry.get(name) for name in ("median", "min", "max")), paper]
                    *spread_of, paper = (
                        "" if value is None else f"{value * figure.factor:.{figure.digits + 1}f}"
                        for value in values)
                    writer.writerow([
                        block.table.name, block.mode, sequence, self.plays[sequence] or "", cell["label"],
                        cell["degradation"] or "", cell["level"] or "", column.heading, *spread_of,
                        cell["done"], len(cell["failures"]), len(cell["missing"]), paper])
        return file.getvalue()


def read_report(path):
    """The content of an older tables.json. Its `runs` have sequence, mode, variant, seed, failure and
    figures."""
    try:
        content = read_json(path)
    except InputError as error:
        raise InputError(f"--compare: {error}") from error
    if content.get("version") != REPORT_VERSION:
        raise InputError(f"--compare: {path}: expected a tables.json of this script, version "
                         f"{REPORT_VERSION}")
    runs, keys = content.get("runs"), {"sequence", "mode", "variant", "seed", "failure", "figures"}
    if not isinstance(runs, dict) or not all(
            isinstance(run, dict) and keys <= run.keys() and isinstance(run["figures"], dict)
            for run in runs.values()):
        raise InputError(f"--compare: {path}: expected under 'runs' for each run the keys "
                         f"{', '.join(sorted(keys))}")
    return content
