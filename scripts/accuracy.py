#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The accuracy gate: runs SLAM on a varied set of sequences and says what got worse since the last
accepted commit.

    scripts/accuracy.py
    scripts/accuracy.py --programs ../other/build/release/bin --out other

The cases are in paper_tables/accuracy.yaml: recorded sequences below --data, whole and disturbed, and
scenes of make_synthetic, which are rendered once into --renderings; RGB-D and monocular, with and
without objects. Recordings that are absent are skipped with a message. The figures are compared with
docs/results/accuracy.json, run by run. docs/benchmarks.md says when a difference counts.

OUT gets accuracy.json (the figures of all runs), accuracy.md (all cases beside the accepted ones) and
runs/ with each run. If it is interrupted in any way, start it again: finished runs are kept, unless
the program or the input has changed. --accept makes the figures those with which later ones are
compared.

Exit codes: 0 nothing got worse, 1 something got worse or the runs were stopped, 2 bad usage or input.
"""

import json
import pathlib
import shutil
import sys

from support import (call, exit_code, InputError, parser_of, programs_folder, require, SCRIPTS, try_read_json,
                     write)

require("jsonschema", "numpy", "yaml")
from paper_tables.definitions import read_definitions  # noqa: E402
from paper_tables.engine import at_work, make_all, read_results, result_file, stop_by_signals  # noqa: E402
from paper_tables.files import markdown_lines  # noqa: E402
from paper_tables.gate import (Comparison, case_grid, disaster_lines, family_lines,  # noqa: E402
                               frame_line, new_lines, run_report)
from paper_tables.plan import Planner, Request, Tools, add_case, add_work_options, chosen  # noqa: E402
from paper_tables.sequences import Renderings, find_sequence, probe_hash  # noqa: E402
from paper_tables.tables import REPORT_VERSION, read_report  # noqa: E402

TOP = SCRIPTS.parent
ACCEPTED = TOP / "docs" / "results" / "accuracy.json"


def make_plan(definitions, cases, arguments, tools, renderings):
    """(plan, names of the recordings that are absent). --quick takes one run of each case, mode and
    variant."""
    planner = Planner(Request(definitions, [], timeout=arguments.timeout), tools)
    absent, most = {}, 1 if arguments.quick else None
    for case in cases:
        for seed in case.seeds[:most]:
            sequence = find_sequence(case, seed, arguments.data, renderings, tools.config)
            if sequence is None:
                absent.setdefault(case.sequence, []).append(case.name)
            else:
                add_case(planner, case, sequence, case.first[:most])
    for sequence, names in absent.items():
        print(f"note: {arguments.data / sequence} does not exist, so these cases are skipped: "
              f"{', '.join(names)}; --data says where recordings are", file=sys.stderr)
    if not planner.runs:
        raise InputError("there is nothing to run: no sequence of these cases is there")
    return planner.plan(), absent


def list_runs(plan, out):
    for name, run in plan["runs"].items():
        is_done = (out / result_file(name, run)).is_file()
        print(f"{'done ' if is_done else 'to do'}  {run['case']}: {name}")
    print(f"{len(plan['runs'])} runs")


def make_report(plan, out, renderings):
    """The figures of the runs that are done, in the form of a tables.json. "rendering" is the hash of
    a short rendering, with which a test compares the renderer of later commits."""
    results = {name: result for name, result in read_results(plan, out).items() if result}
    runs = {}
    for name, result in results.items():
        summary = try_read_json(out / "runs" / name / "out" / "summary.json") or {}
        runs[name] = run_report(name, plan["runs"][name], result, out, summary)
    builds = sorted({result["git"] for result in results.values() if result.get("git")})
    return {"version": REPORT_VERSION, "git": builds, "rendering": probe_hash(renderings.program),
            "runs": runs}


def json_text(report):
    """One line per run, so that a change of the accepted figures can be read as a difference."""
    runs = ",\n".join(f"  {json.dumps(name)}: {json.dumps(rounded(run))}"
                      for name, run in report["runs"].items())
    head = {key: value for key, value in report.items() if key != "runs"}
    return f"{json.dumps(head)[:-1]}, \"runs\": {{\n{runs}\n}}}}\n"


def rounded(value):
    """Numbers with six digits, which is far more than they mean."""
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    return float(f"{value:.6g}") if isinstance(value, float) else value


def build_name(report):
    return ", ".join(report.get("git") or ["unknown"])


def compare(old, new, out, is_accepted):
    """Prints and writes the comparison. Returns whether something got worse. Figures that are accepted
    may all be new."""
    comparison = Comparison({name: run for name, run in old["runs"].items() if "case" in run}, new["runs"])
    if not comparison.common and not is_accepted:
        raise InputError("no run is in both reports with the same input, so there is nothing to compare")
    lines = [frame_line(build_name(report), [report["runs"][name] for name in comparison.common])
             for report in (old, new)]
    lines += new_lines(comparison)
    lines += [*disaster_lines(comparison), *family_lines(comparison)]
    head = [f"# Accuracy: {build_name(old)} -> {build_name(new)}", "",
            *(f"* {line}" for line in lines), ""]
    write(out / "accuracy.md", "\n".join([*head, *markdown_lines(case_grid(comparison), 2)]))
    changed = case_grid(comparison, only_changed=True)
    if changed.rows:
        changed.title = "What changed by more than its spread"
        lines += ["", *markdown_lines(changed, 2)]
    print("\n".join(lines))
    print("something got worse" if comparison.is_worse() else "nothing got worse")
    return comparison.is_worse()


def commit_to_accept(renderings):
    """The commit of this checkout. Accepted figures must be those of a commit and of its renderer, so
    that they can be made again."""
    if not renderings.program.resolve().is_relative_to(TOP):
        raise InputError(f"--accept: {renderings.program} is not a program of {TOP}")
    result = call("git", "-C", TOP, "describe", "--always", "--dirty")
    if result.returncode != 0:
        raise InputError(f"--accept: {TOP} is no checkout of git")
    if result.stdout.strip().endswith("-dirty"):
        raise InputError(f"--accept: {TOP} has changes that are not committed (git status)")
    return result.stdout.strip()


def accept(report, absent, out, is_part, commit):
    """With --only, the other cases keep their figures."""
    if others := [build for build in report["git"] or ["unknown"] if build != commit]:
        raise InputError(f"--accept: the runs are of {', '.join(others)}, and {TOP} is at {commit}; "
                         "configure and build it, and run again")
    if absent:
        raise InputError(f"--accept: {', '.join(absent)} is absent, and the accepted figures must have "
                         "all cases")
    ACCEPTED.parent.mkdir(parents=True, exist_ok=True)
    if is_part and ACCEPTED.is_file():
        known, cases = read_report(ACCEPTED), {run["case"] for run in report["runs"].values()}
        kept = {name: run for name, run in known["runs"].items() if run.get("case") not in cases}
        write(ACCEPTED, json_text({**known, "git": sorted({*known["git"], *report["git"]}),
                                   "rendering": report["rendering"],
                                   "runs": kept | report["runs"]}))
    else:
        shutil.copyfile(out / "accuracy.json", ACCEPTED)
    print(f"{ACCEPTED}: {len(report['runs'])} runs of {build_name(report)} are accepted")


def gate(arguments):
    """Makes all runs and compares them. Returns 1 if something got worse."""
    out = arguments.out
    tools = Tools(arguments.programs.resolve(), others=arguments.tools.resolve())
    definitions = read_definitions(arguments.definitions, "cases")
    cases = [definitions.cases[name] for name in chosen(arguments.only, definitions.cases, "--only")]
    old = read_report(arguments.compare or ACCEPTED) if arguments.compare or ACCEPTED.is_file() else None
    renderings = Renderings(arguments.renderings, tools.path("make_synthetic"), definitions)
    commit = commit_to_accept(renderings) if arguments.accept else None
    renderings.make(cases)
    plan, absent = make_plan(definitions, cases, arguments, tools, renderings)
    if arguments.list:
        list_runs(plan, out)
        return 0
    with at_work(plan, out):
        if not arguments.so_far:
            make_all(plan, out, arguments.jobs, is_quiet=arguments.quiet)
        report = make_report(plan, out, renderings)
        write(out / "accuracy.json", json_text(report))
        is_worse = old is not None and compare(old, json.loads(json_text(report)), out, arguments.accept)
    if old is None:
        print(f"note: {ACCEPTED} does not exist, so nothing is compared", file=sys.stderr)
    if arguments.accept:
        accept(report, absent, out, arguments.only is not None, commit)
    return int(is_worse and not arguments.accept)


def parse_arguments(words):
    parser = parser_of(__doc__)
    parser.add_argument("--out", type=pathlib.Path, default=TOP / "build" / "accuracy",
                        metavar="FOLDER", help="folder for runs and figures (default: build/accuracy)")
    parser.add_argument("--tools", type=pathlib.Path, default=programs_folder(), metavar="FOLDER",
                        help="hullslam and make_synthetic, which should be the same for all builds "
                             "(default: those of this installation or of build/release/bin)")
    parser.add_argument("--compare", type=pathlib.Path, metavar="FILE",
                        help="compare with this accuracy.json (default: docs/results/accuracy.json)")
    parser.add_argument("--accept", action="store_true",
                        help="the figures become docs/results/accuracy.json, with --only those of "
                             "these cases; exit code 0")
    parser.add_argument("--only", metavar="CASE,...", help="only some of the cases")
    parser.add_argument("--quick", action="store_true", help="one run of each case instead of several")
    parser.add_argument("--data", type=pathlib.Path, default=TOP.parent / "shared" / "data",
                        metavar="FOLDER", help="recorded sequences (default: ../shared/data beside "
                                               "this checkout)")
    parser.add_argument("--renderings", type=pathlib.Path, default=TOP / "build" / "renderings",
                        metavar="FOLDER", help="rendered sequences, which are kept (default: "
                                               "build/renderings)")
    parser.add_argument("--definitions", type=pathlib.Path, metavar="FILE",
                        default=SCRIPTS / "paper_tables" / "accuracy.yaml",
                        help="the cases (default: paper_tables/accuracy.yaml beside this script)")
    add_work_options(parser, timeout=600.0)
    arguments = parser.parse_args(words)
    if arguments.accept and (arguments.quick or arguments.list or arguments.so_far):
        parser.error("--accept needs all runs of its cases, so it excludes --quick, --so-far and --list")
    return arguments


def main(words=None):
    arguments = parse_arguments(words)
    stop_by_signals()
    return exit_code(gate, arguments)


if __name__ == "__main__":
    sys.exit(main())
