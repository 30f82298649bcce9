# SPDX-License-Identifier: GPL-3.0-or-later
"""Gathers the results of a table run into one report, of which all files are written."""

import csv
import io
import json

from paper_tables.cells import answer_claims, columns_of, make_block, paper_value, ranking
from run_errors import InputError

REPORT_VERSION = 1  # of tables.json
MODE_TITLES = {"rgbd": "RGB-D", "mono": "monocular"}


class Report:
    """Everything that tables, pages and comparisons show."""

    def __init__(self, request, plan, cells, results, paper):
        self.definitions, self.plan, self.results, self.paper = (request.definitions, plan, results,
                                                                 paper)
        self.seeds, self.frames, self.is_quick = request.seeds, request.frames, request.is_quick
        self.sequences = {sequence.name: sequence for sequence in request.sequences}
        self.plays = {name: sequence.paper for name, sequence in self.sequences.items()}
        self.blocks = []
        for name in request.tables:
            table = self.definitions.tables[name]
            for mode in table.modes:
                found = {sequence: of_sequence for (of_table, of_mode, sequence), of_sequence
                         in cells.items() if (of_table, of_mode) == (name, mode)}
                if mode in request.modes:
                    self.blocks.append(make_block(table, mode, found, results))
        self.claims = answer_claims(self.definitions, self.blocks, results)

    def table(self, block):
        return self.definitions.tables[block["table"]]

    def label(self, block, cell):
        """The name of a row of a table."""
        return next(row.label for row in self.table(block).rows if row.variant == cell["row"])

    def paper_figure(self, block, cell, sequence, figure):
        """The paper's figure in the unit of a run; None if it has none."""
        table = self.table(block)
        row = next(row for row in table.rows if row.variant == cell["row"])
        if cell["degradation"]:
            return None
        return paper_value(self.paper, table.paper, block["mode"], row.paper,
                           self.plays.get(sequence), figure)

    def columns(self, block):
        """The sequences of a table in the order of the paper, then the others. Those of the paper
        that the user does not have are None: [(name, name in the paper)]."""
        table = self.table(block)
        wanted = table.only or tuple(self.definitions.paper_sequences)
        found = [(name, self.plays[name]) for name in block["sequences"]]
        if not table.degradations:
            had = {paper for _, paper in found}
            found += [(None, paper) for paper in wanted if paper not in had]
        order = list(self.definitions.paper_sequences)
        return sorted(found, key=lambda pair: order.index(pair[1]) if pair[1] else len(order))

    def ranking(self, block):
        return ranking(self.table(block), block["mode"], block, self.paper, self.plays)

    def builds(self):
        """The commits of the programs that made the runs."""
        return sorted({result["git"] for result in self.results.values()
                       if result and result.get("git")})

    def title(self, block):
        return (f"Table {block['table']}: {self.table(block).title}, "
                f"{MODE_TITLES[block['mode']]}")

    def as_json(self):
        runs = {name: {"sequence": run["sequence"], "mode": run["mode"], "variant": run["variant"],
                       "seed": run["seed"], "degradation": run["degradation"],
                       "level": run["level"],
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
                "tables": self.blocks, "claims": self.claims, "runs": runs}

    def json_text(self):
        return json.dumps(self.as_json(), indent=1) + "\n"

    def csv_text(self):
        """A line for each figure of each cell, in the units of the tables."""
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["table", "mode", "sequence", "paper_sequence", "row", "degradation",
                         "level", "figure", "median", "min", "max", "runs", "failed", "not_run",
                         "paper"])
        for block in self.blocks:
            for sequence, cells in block["sequences"].items():
                for cell in cells:
                    self.write_cell(writer, block, sequence, cell)
        return file.getvalue()

    def write_cell(self, writer, block, sequence, cell):
        for key, figure, column in columns_of(self.table(block), block["mode"]):
            entry = cell["figures"].get(column.key)
            is_of_paper = column is figure.paper_column(block["mode"])
            paper = self.paper_figure(block, cell, sequence, key) if is_of_paper else None
            numbers = [entry[name] if entry else None for name in ("median", "min", "max")]
            writer.writerow(
                [block["table"], block["mode"], sequence, self.plays[sequence] or "",
                 self.label(block, cell), cell["degradation"] or "", cell["level"] or "",
                 column.heading,
                 *("" if value is None else f"{value * figure.factor:.{figure.digits + 1}f}"
                   for value in numbers),
                 cell["done"], len(cell["failures"]), len(cell["missing"]),
                 "" if paper is None else f"{paper * figure.factor:.{figure.digits + 1}f}"])


def read_report(path):
    """The content of an older tables.json. Its `runs` have sequence, mode, variant, seed, failure and
    figures."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"--compare: cannot read {path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"--compare: {path}: not valid JSON: {error}") from error
    if not isinstance(content, dict) or content.get("version") != REPORT_VERSION:
        raise InputError(f"--compare: {path}: expected a tables.json of this script, version "
                         f"{REPORT_VERSION}")
    runs = content.get("runs")
    keys = ("sequence", "mode", "variant", "seed", "failure", "figures")
    if not isinstance(runs, dict) or not all(
            isinstance(run, dict) and all(key in run for key in keys)
            and isinstance(run["figures"], dict) for run in runs.values()):
        raise InputError(f"--compare: {path}: expected under 'runs' for each run the keys "
                         f"{', '.join(keys)}")
    return content
