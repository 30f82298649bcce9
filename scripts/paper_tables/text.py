# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Markdown and LaTeX files have in common: grids of short texts."""

import dataclasses
import statistics

from paper_tables.figures import FIGURES
from paper_tables.tables import COMPARED, MODE_TITLES

DASH = "–"


class Best(str):
    """A text of a grid that is shown in bold."""


@dataclasses.dataclass
class Grid:
    """A table of texts. A row that has only one text is a heading within the table."""
    title: str
    head: list
    rows: list
    notes: list = dataclasses.field(default_factory=list)


def number(value, figure):
    return DASH if value is None else f"{value * figure.factor:.{figure.digits}f}"


def difference_text(change, figure):
    """A difference with its p and the number of pairs."""
    if change is None:
        return DASH
    text = f"{100 * change['change']:+.1f} %" if change["is_relative"] else \
        f"{change['change'] * FIGURES[figure].factor:+.{FIGURES[figure].digits}f}"
    return f"{text} (p {change['p']:.2g}, {change['pairs']} pairs)"


def entry_text(cell, column, figure):
    """The median, the smallest and the largest value of the runs of a cell."""
    entry = cell["figures"].get(column.key)
    if entry is None:
        return DASH
    text = number(entry["median"], figure)
    if len(entry["values"]) > 1:
        text += f" ({number(entry['min'], figure)}..{number(entry['max'], figure)})"
    return text


# ---- overviews: a row for each system, a column for each sequence


def best_rows(block, sequence, column, figure):
    """The rows with the best median of a sequence, to the digits that are shown."""
    medians = {cell["row"]: number(cell["figures"][column.key]["median"], figure)
               for cell in block.sequences[sequence] if cell["figures"].get(column.key)}
    if len(set(medians.values())) < 2 or figure.lower_is_better is None:
        return set()
    best = (min if figure.lower_is_better else max)(medians.values(), key=float)
    return {row for row, text in medians.items() if text == best}


def overview_cell(block, cell, best):
    """The medians of the first figure, and the paper's figure in brackets."""
    key = block.table.figures[0]
    entries = [cell["figures"].get(column.key) for column in FIGURES[key].columns[block.mode]]
    text = " / ".join(number(entry["median"] if entry else None, FIGURES[key]) for entry in entries)
    if not any(entries):
        text = "failed" if cell["failures"] else DASH
    else:
        text += f" !{len(cell['failures'])}" if cell["failures"] else ""
        lost = cell["figures"].get("lost")
        text += f", {lost['median']:.1f} %" if lost and lost["median"] >= 0.05 else ""
    if cell["papers"][key] is not None:
        text += f" [{number(cell['papers'][key], FIGURES[key])}]"
    return Best(text) if cell["row"] in best else text


def sequence_heading(report, name):
    paper = report.plays.get(name)
    return name if paper in (None, name) else f"{name} ({paper})"


def overview(report, block):
    """The grid with one row per system and one column per sequence."""
    key, names = block.table.figures[0], report.columns(block)
    columns = FIGURES[key].columns[block.mode]
    labels = {row.variant: row.label for row in block.table.rows}
    head = ["", *(sequence_heading(report, name) if name else paper for name, paper in names),
            f"against {labels[block.table.baseline]}"]
    best = {name: best_rows(block, name, columns[0], FIGURES[key]) for name in block.sequences}
    rows = []
    for index, (variant, label) in enumerate(labels.items()):
        texts = [overview_cell(block, block.sequences[name][index], best[name]) if name else DASH
                 for name, _ in names]
        rows.append([label, *texts, difference_text(block.overall[variant]["difference"], key)])
    notes = [f"{' / '.join(column.heading for column in columns)}: medians of the runs that did not fail."]
    if any(cell["papers"][key] is not None for _, cell in block.cells):
        notes.append("In square brackets: the paper's figure, on the sequence of the paper.")
    if any(cell["failures"] for _, cell in block.cells):
        notes.append("!n: n runs failed.")
    notes.append("n %: so many frames have no pose (median of all runs), if any.")
    return Grid(block.title, head, rows, notes)


# ---- details: all figures of all sequences


def detail(report, block):
    """The grid with all figures, sequence by sequence."""
    of_paper = [key for key in block.table.figures
                if any(cell["papers"][key] is not None for _, cell in block.cells)]
    head = ["", *(column.heading for _, _, column in block.columns),
            *(f"paper: {FIGURES[key].title}" for key in of_paper), "runs"]
    rows = []
    for name, paper in report.columns(block):
        if name is None:
            rows.append([paper, *[DASH] * (len(head) - 1)])
            continue
        rows.append([sequence_heading(report, name)])
        best = {column.key: best_rows(block, name, column, figure) for _, figure, column in block.columns}
        for cell in block.sequences[name]:
            texts = [entry_text(cell, column, figure) for _, figure, column in block.columns]
            texts = [Best(text) if cell["row"] in best[column.key] else text
                     for text, (_, _, column) in zip(texts, block.columns)]
            runs = f"{cell['done']}"
            for key, told in ("failures", "failed"), ("missing", "not run"):
                runs += f", {len(cell[key])} {told}" if cell[key] else ""
            rows.append([cell["label"], *texts,
                         *(number(cell["papers"][key], FIGURES[key]) for key in of_paper), runs])
    return Grid(f"{block.title}, all figures", head, rows,
                [*shared_runs(report, block), *reasons(block), *failures(block)])


def reasons(block):
    """Why cells are empty."""
    found = {}
    for name, cell in block.cells:
        if not cell["runs"]:
            found.setdefault(cell["reason"], {})[f"{name}, {cell['label']}"] = True
    return [f"{DASH} {reason}: {'; '.join(names)}." for reason, names in found.items()]


def shared_runs(report, block):
    """The rows that show the runs of another variant, as the cameras have no rolling shutter."""
    variants = report.definitions.variants
    for row in block.table.rows:
        other = variants[row.variant].same_as
        names = [name for name in block.sequences if other and not report.sequences[name].has_rolling_shutter]
        if names:
            yield (f"{row.label}: the runs of {variants[other].label}, as there is no rolling "
                   f"shutter, on {', '.join(names)}.")


def failures(block):
    """Each failed run with its reason."""
    return [f"failed: {cell['runs'][seed]}: {reason}"
            for _, cell in block.cells for seed, reason in sorted(cell["failures"].items())]


def degradation_grid(report, block):
    """The grid of a table of degradations: a row for each level, columns for each system."""
    table, known = block.table, report.definitions.degradations
    head = ["", "level", *(f"{row.label}: {column.heading}" for row in table.rows
                           for _, _, column in block.columns)]
    rows = []
    for name, cells in block.sequences.items():
        rows.append([sequence_heading(report, name)])
        for start in range(0, len(cells), len(table.rows)):
            group = cells[start:start + len(table.rows)]
            of_row = known[group[0]["degradation"] or table.degradations[0]]
            level = group[0]["level"] or of_row.unchanged  # None: of runs without a degradation
            row = [of_row.label if level else "none", level or ""]
            for cell in group:
                texts = [entry_text(cell, column, figure) for _, figure, column in block.columns]
                texts[0] += f" !{len(cell['failures'])}" if cell["failures"] else ""
                row += texts
            rows.append(row)
    return Grid(block.title, head, rows, ["!n: n runs failed.", *reasons(block), *failures(block)])


def grids(report, block):
    """All grids of a block of the report but that of the ranks."""
    if block.table.degradations:
        return [degradation_grid(report, block)]
    return [overview(report, block), detail(report, block)]


# ---- claims and ranks


def claims_grid(report):
    def label(name):
        return report.definitions.variants[name].label
    rows = []
    for claim in report.claims:
        told = "; ".join(f"against {label(name)} {difference_text(change, claim['figure'])}"
                         for name, change in claim["than"].items())
        rows.append([claim["text"], MODE_TITLES[claim["mode"]],
                     claim["answer"], f"{label(claim['better'])}: {told}"])
    return Grid("Claims of the paper", ["claim", "mode", "answer", "from the pairs of runs"], rows,
                ["yes: better than each of the others, each with p of at most 0.05; no: worse than "
                 "one of them with such a p; unclear: neither."])


def ranking_grid(block):
    """The order of the systems beside that of the paper, over the sequences for which both have all
    figures; None for fewer than two systems.

    The order is that of the means of the ranks within each sequence, so that the sequences count alike.
    """
    key, ranks = block.table.figures[0], {}
    column, sign = FIGURES[key].columns[block.mode][-1].key, 1.0 if FIGURES[key].lower_is_better else -1.0
    for cells in block.sequences.values():
        pairs = {cell["label"]: (cell["figures"][column]["median"], cell["papers"][key]) for cell in cells
                 if cell["papers"][key] is not None and cell["figures"].get(column)}
        for index in (0, 1) if len(pairs) > 1 else ():
            order = sorted(pairs, key=lambda label, i=index: sign * pairs[label][i])
            for rank, label in enumerate(order, 1):
                ranks.setdefault(label, ([], []))[index].append(rank)
    means = [(row.label, *map(statistics.fmean, ranks[row.label])) for row in block.table.rows
             if row.label in ranks]
    rows = [[label, f"{ours:.1f}", f"{theirs:.1f}"]
            for label, ours, theirs in sorted(means, key=lambda row: row[1])]
    return Grid(f"{block.title}: order", ["", "mean rank", "mean rank in the paper"], rows,
                ["Ranks within each sequence, by the medians; over the sequences for which both "
                 "have figures."]) if len(rows) > 1 else None


def comparison_grid(found, labels):
    """The grid of the differences from an older report (compare_reports())."""
    rows = []
    for row in found["rows"]:
        changes = [row["figures"].get(key) for key in COMPARED]
        name, _, level = row["variant"].partition("+")
        rows.append([labels.get(name, name) + (f" + {level}" if level else ""), row["mode"],
                     *(f"{difference_text(change, key)}, {change['verdict']}" if change else DASH
                       for key, change in zip(COMPARED, changes)),
                     f"{row['failed_before']} -> {row['failed_after']} of {row['common']}"])
    old, new = (", ".join(map(str, found[key] or ["unknown"])) for key in ("old_git", "new_git"))
    return Grid(f"Differences since {old} (now {new})",
                ["", "mode", *(FIGURES[key].title for key in COMPARED), "failed runs"], rows,
                ["Changes are those of pairs of runs with the same sequence, mode and seed; that of "
                 "ATE and MTD is relative. unclear: p is above 0.05.",
                 f"{found['only_before']} runs are only in the old report, {found['only_after']} "
                 "only in the new one."])


def preface(report):
    """How to read the tables, one sentence each."""
    seeds = list(report.seeds)
    count = f"{len(seeds)} run" + ("s" if len(seeds) > 1 else "")
    found = [
        f"Each cell is the median of {count} (seeds {seeds[0]} to {seeds[-1]}), with the smallest "
        "and the largest value in brackets.",
        "Recorded sequences begin at another frame for each seed; synthetic ones are rendered anew.",
        "Failed runs are counted and listed with their reasons; their other figures are not used, "
        "but the share of frames without a pose counts all runs.",
        "A row that loses more frames has the error of an easier part of the sequence.",
        "ATE is the RMSE after alignment with SE3 (rigid) or Sim3 (with scale); the paper aligns "
        "with scale also in RGB-D.",
        "p is that of the sign-flip test over pairs of runs with the same sequence and seed; with n "
        "pairs it is at least 2 / 2^n.",
        f"The paper is {report.paper['source']}."]
    if report.frames:
        found.append(f"Only {report.frames} images of each sequence were used.")
    if report.is_quick:
        found.append("This was a quick run, to see whether everything works: its figures mean little.")
    if report.builds():
        found.append(f"Commit of the programs: {', '.join(report.builds())}.")
    return found
