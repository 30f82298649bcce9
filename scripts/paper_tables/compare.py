# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the runs of two reports: --compare OLD.json of scripts/reproduce_tables.py."""

import json

from paper_tables.cells import difference, verdict
from paper_tables.figures import FIGURES
from paper_tables.text import DASH, Grid, Text, difference_text

COMPARED = ("ate", "lost", "siou", "mtd")


def group(runs):
    """{(mode, variant with degradation): {(sequence, seed): run}}"""
    found = {}
    for run in runs.values():
        level = f"+{run['degradation']}-{run['level']}" if run.get("degradation") else ""
        key = (run["mode"], run["variant"] + level)
        found.setdefault(key, {})[run["sequence"], run["seed"]] = run
    return found


def values(runs, column):
    """The figures of the runs that have not failed."""
    found = {key: run["figures"].get(column) for key, run in runs.items() if not run["failure"]}
    return {key: value for key, value in found.items()
            if isinstance(value, (int, float)) and not isinstance(value, bool)}


def compare_group(mode, before, after):
    """The differences of all figures between two groups of runs, and their failures."""
    found = {"figures": {}}
    common = before.keys() & after.keys()
    for key in COMPARED:
        column = FIGURES[key].columns[mode][0].key
        change = difference(key, values(before, column), values(after, column))
        if change is not None:
            found["figures"][key] = {**change, "verdict": verdict(key, change)}
    for name, runs in (("failed_before", before), ("failed_after", after)):
        found[name] = sum(1 for key in common if runs[key]["failure"])
    found["common"] = len(common)
    return found


def compare_reports(old, new):
    """A list of {mode, variant, common, failed_before, failed_after, figures}, and how many runs
    only one of the reports has."""
    before, after = group(old["runs"]), group(new["runs"])
    rows = []
    for key in sorted(before.keys() & after.keys()):
        found = compare_group(key[0], before[key], after[key])
        if found["common"]:
            rows.append({"mode": key[0], "variant": key[1], **found})
    counts = [sum(len(runs.keys() - other.get(key, {}).keys()) for key, runs in one.items())
              for one, other in ((before, after), (after, before))]
    return {"old_git": old.get("git"), "new_git": new.get("git"), "rows": rows,
            "only_before": counts[0], "only_after": counts[1]}


def comparison_grid(found, labels):
    rows = []
    for row in found["rows"]:
        texts = []
        for key in COMPARED:
            change = row["figures"].get(key)
            told = DASH if change is None else f"{difference_text(change, key)}, {change['verdict']}"
            texts.append(Text(told))
        name, _, level = row["variant"].partition("+")
        rows.append([Text(labels.get(name, name) + (f" + {level}" if level else "")),
                     Text(row["mode"]), *texts,
                     Text(f"{row['failed_before']} -> {row['failed_after']} of {row['common']}")])
    told = [", ".join(map(str, commits or ["unknown"])) for commits in
            (found["old_git"], found["new_git"])]
    return Grid(f"Differences since {told[0]} (now {told[1]})",
                ["", "mode", *(FIGURES[key].title for key in COMPARED), "failed runs"], rows,
                ["Changes are those of pairs of runs with the same sequence, mode and seed; that of "
                 "ATE and MTD is relative. unclear: p is above 0.05.",
                 f"{found['only_before']} runs are only in the old report, {found['only_after']} "
                 "only in the new one."])


def comparison_json(found):
    return json.dumps(found, indent=1) + "\n"
