# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the tables of results: median and spread of each figure, failed runs, and comparisons."""

import statistics

from paper_tables.figures import FIGURES
from run_statistics import compare, flip_probability

SIGNIFICANT = 0.05  # the largest p of a difference that is called significant


def spread(values):
    """{median, min, max, values} of the values by seed; None without a value."""
    known = {seed: value for seed, value in values.items() if value is not None}
    if not known:
        return None
    return {"median": statistics.median(known.values()), "min": min(known.values()),
            "max": max(known.values()), "values": known}


def median_run(entry):
    """The seed whose value is nearest to the median; of equal ones the first."""
    return min(sorted(entry["values"]),
               key=lambda seed: abs(entry["values"][seed] - entry["median"]))


def level_text(table, definitions, cell):
    """The level of a cell of a table of degradations; none without a degradation."""
    return cell["level"] or definitions.degradations[table.degradations[0]].unchanged or "none"


def columns_of(table, mode):
    """(key, figure, column) of each column of a table."""
    return [(key, FIGURES[key], column) for key in table.figures
            for column in FIGURES[key].columns[mode]]


def make_cell(cell, results, table, mode):
    """A row of a table for one sequence.

    Failed runs are counted, with their reasons, and left out of all figures but the share of frames
    without a pose.
    """
    found = {seed: results.get(name) for seed, name in cell["runs"].items()}
    missing = sorted(seed for seed, result in found.items() if result is None)
    done = {seed: result for seed, result in found.items() if result is not None}
    good = {seed: result for seed, result in done.items() if not result["failure"]}
    figures = {}
    for key, _, column in columns_of(table, mode):
        counted = done if key == "lost" else good
        figures[column.key] = spread({seed: result["figures"].get(column.key)
                                      for seed, result in counted.items()})
    return {**cell, "figures": figures, "done": len(done), "missing": missing,
            "failures": {seed: result["failure"] for seed, result in done.items()
                         if result["failure"]}}


# ---- the figures of the paper


def paper_value(paper, section, mode, row, sequence, figure):
    """The figure of the paper in the unit of a run (metres, 0 to 1); None if it has none.

    Table I has a part for each mode. Those of the other tables agree with its monocular part, and
    the systems of Table II are those of this part.
    """
    def at(*keys):
        found = paper.get(section) or {}
        for key in keys:
            found = found.get(key) if isinstance(found, dict) else None
        return found
    if row is None or sequence is None or section is None:
        return None
    if section == "ate":
        return at(mode, row, sequence) if figure == "ate" else None
    if mode != "mono":
        return None
    if section == "integration":
        return at("rows", row, sequence) if figure == "ate" else None
    value = at("rows", sequence, row, figure)
    factor = {"ate": 1e-2, "mtd": 1e-3}.get(figure, 1.0)  # these tables have cm and 1e-3 m2
    return None if value is None else value * factor


# ---- comparisons of two sets of runs


def values_by_run(runs, results, column):
    """{(sequence, seed): figure} of the runs [(sequence, seed, name)] that have not failed."""
    found = {}
    for sequence, seed, name in runs:
        result = results.get(name)
        if result is not None and not result["failure"]:
            value = result["figures"].get(column)
            if value is not None:
                found[sequence, seed] = value
    return found


def difference(figure, base, other):
    """{change, p, pairs} of the figures `other` against `base`.

    The change is relative for the figures of which less is better (geometric mean over the pairs),
    else absolute (mean). None without a pair.
    """
    if FIGURES[figure].lower_is_better and figure != "lost":
        change, p, pairs = compare(base, other)
        return None if change is None else {"change": change, "p": p, "pairs": pairs,
                                            "is_relative": True}
    pairs = [other[key] - base[key] for key in sorted(base.keys() & other.keys())]
    if not pairs:
        return None
    return {"change": statistics.fmean(pairs), "p": flip_probability(pairs), "pairs": len(pairs),
            "is_relative": False}


def verdict(figure, change):
    """better, worse, or unclear if the difference may be chance."""
    if change is None:
        return "unknown"
    if change["p"] > SIGNIFICANT or change["change"] == 0.0:
        return "unclear"
    is_lower = change["change"] < 0.0
    return "better" if is_lower == bool(FIGURES[figure].lower_is_better) else "worse"


# ---- tables


def make_block(table, mode, cells, results):
    """A table in one mode: its cells by sequence, and how its rows compare over all sequences."""
    by_sequence = {sequence: [make_cell(cell, results, table, mode) for cell in of_sequence]
                   for sequence, of_sequence in cells.items()}
    return {"table": table.name, "mode": mode, "sequences": by_sequence,
            "overall": compare_rows(table, mode, by_sequence, results)}


def runs_of(by_sequence, row, keep=lambda cell: True):
    """(sequence and level, seed, name) of the runs of a row."""
    return [((sequence, cell["degradation"] or "", cell["level"] or ""), seed, name)
            for sequence, cells in by_sequence.items() for cell in cells
            if cell["row"] == row and keep(cell) for seed, name in cell["runs"].items()]


def compare_rows(table, mode, by_sequence, results):
    """For each row its difference from the baseline, in the first figure, over all sequences."""
    figure = table.figures[0]
    column = FIGURES[figure].columns[mode][0].key
    base = values_by_run(runs_of(by_sequence, table.baseline), results, column)
    found = {}
    for row in table.rows:
        runs = runs_of(by_sequence, row.variant)
        other = values_by_run(runs, results, column)
        is_base = row.variant == table.baseline
        change = None if is_base else difference(figure, base, other)
        found[row.variant] = {"difference": change, "verdict": verdict(figure, change),
                              "runs": len(runs), "failed": failed(runs, results)}
    return found


def failed(runs, results):
    return sum(1 for _, _, name in runs if results.get(name) and results[name]["failure"])


def answer_claims(definitions, blocks, results):
    """For each claim and mode: the difference of `better` against each of the others."""
    runs = {}  # (mode, variant) -> {(sequence, seed): name}, without degraded runs
    for block in blocks:
        for row in {cell["row"] for cells in block["sequences"].values() for cell in cells}:
            found = runs_of(block["sequences"], row, lambda cell: cell["degradation"] is None)
            known = runs.setdefault((block["mode"], row), {})
            known |= {(sequence[0], seed): name for sequence, seed, name in found}
    answers = []
    for claim in definitions.claims:
        for mode in ("rgbd", "mono"):
            column = FIGURES[claim.figure].columns[mode][0].key
            values = {name: values_by_run([(*key, run) for key, run in
                                           runs.get((mode, name), {}).items()], results, column)
                      for name in (claim.better, *claim.than)}
            changes = {name: difference(claim.figure, values[name], values[claim.better])
                       for name in claim.than}
            if any(changes.values()):
                answers.append({"text": claim.text, "figure": claim.figure, "mode": mode,
                                "better": claim.better, "answer": answer(claim.figure, changes),
                                "than": changes})
    return answers


def answer(figure, changes):
    """yes, no or unclear: of several comparisons, the least favourable one decides."""
    verdicts = [verdict(figure, change) for change in changes.values()]
    if "worse" in verdicts:
        return "no"
    return "yes" if all(found == "better" for found in verdicts) else "unclear"


# ---- order of the rows, beside that of the paper


def ranking(table, mode, block, paper, plays):
    """(row, our rank, the paper's rank) over the sequences for which both have all figures.

    The order is that of the means of the ranks within each sequence, so that the sequences count
    alike. Empty if fewer than two rows have figures.
    """
    figure = table.figures[0]
    column = FIGURES[figure].paper_column(mode).key
    rows = [row for row in table.rows if row.paper]
    ours, theirs = {row.variant: [] for row in rows}, {row.variant: [] for row in rows}
    for sequence, cells in block["sequences"].items():
        pairs = {}
        for row in rows:
            value = paper_value(paper, table.paper, mode, row.paper, plays.get(sequence), figure)
            entry = next((cell["figures"].get(column) for cell in cells
                          if cell["row"] == row.variant and cell["degradation"] is None), None)
            if value is not None and entry:
                pairs[row.variant] = (entry["median"], value)
        if len(pairs) > 1:
            sign = 1.0 if FIGURES[figure].lower_is_better else -1.0
            for index, ranks in ((0, ours), (1, theirs)):
                order = sorted(pairs, key=lambda name, i=index: sign * pairs[name][i])
                for rank, name in enumerate(order, 1):
                    ranks[name].append(rank)
    found = [(name, statistics.fmean(ours[name]), statistics.fmean(theirs[name]))
             for name in ours if ours[name]]
    return sorted(found, key=lambda item: item[1])
