#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
r"""Makes the tables of the paper from many runs: I pose error, II mapping quality, III constraints,
IV simplification, V integration, VI robustness and VII weight of the constraint, tables of our own.

    scripts/reproduce_tables.py --suite synthetic --out tables
    scripts/reproduce_tables.py --data data --out tables --tables I,III --seeds 5

The first renders its sequences and needs nothing else. The second takes all sequences of TUM RGB-D
and ICL-NUIM in the folder data. Of each sequence every row of a table is run with several seeds,
monocular and with depth: recorded sequences begin at another frame for each seed, synthetic ones
are rendered anew. docs/benchmarks.md explains the tables, the masks and how to use a cluster.

OUT/tables has the tables as tables.md, tables.tex, tables.csv and tables.json, and
OUT/runs has each run. If it is interrupted in any way, start it again: finished runs are kept, and
the tables will be the same. A run is repeated if a program, its settings, preset, sequence or masks
have changed. Only names and sizes of images are compared.

Exit codes: 0 done (failed runs are a part of the tables), 1 stopped before its end, 2 bad usage or
input.
"""

import dataclasses
import json
import pathlib
import shutil
import sys

from support import exit_code, InputError, number, parser_of, read_json, require, SCRIPTS, write

require("jsonschema", "numpy", "yaml")
from paper_tables.definitions import MODES, read_definitions  # noqa: E402
from paper_tables.engine import (DIGITS, at_work, describe_dry_run, make_all, read_results,  # noqa: E402
                                 result_file, stop_by_signals)
from paper_tables.files import latex, markdown, markdown_lines  # noqa: E402
from paper_tables.plan import Request, Tools, add_work_options, chosen, make_plan  # noqa: E402
from paper_tables.sequences import (find_sequences, in_order, read_list, read_sequence,  # noqa: E402
                                    read_suite, suite_file)
from paper_tables.tables import Report, compare_reports, read_report  # noqa: E402
from paper_tables.text import comparison_grid  # noqa: E402

OWN = SCRIPTS / "paper_tables"
QUICK_SEQUENCES, QUICK_FRAMES = 2, 40


def recorded_sequences(arguments, definitions, config):
    texts = list(arguments.sequence)
    for path in arguments.sequences:
        texts += read_list(path)
    for data in arguments.data:
        found, others = find_sequences(data)
        texts += map(str, found)
        for path in others:
            print(f"note: {path} is no sequence and is left out", file=sys.stderr)
    return [read_sequence(text, arguments.masks, definitions.paper_sequences, config)
            for text in dict.fromkeys(texts)]


def select(sequences, only):
    """The sequences that --only names, by their own name or that of the paper."""
    known = [name for sequence in sequences for name in (sequence.name, sequence.paper) if name]
    names = set(chosen(only, dict.fromkeys(known), "--only")) if only is not None else set(known)
    return [sequence for sequence in sequences if {sequence.name, sequence.paper} & names]


def quick_choice(sequences):
    """Two sequences, of both data sets if there are both. The second one only with depth: the
    published systems need more images of the sequences of ICL-NUIM to begin a monocular map."""
    first = sequences[:1]
    others = sorted(sequences[1:], key=lambda sequence: sequence.dataset == first[0].dataset)
    return first + [dataclasses.replace(sequence, modes=tuple(
        mode for mode in sequence.modes if mode == "rgbd") or sequence.modes)
        for sequence in others[:QUICK_SEQUENCES - 1]]


def quick_table(table, known):
    """Of a table the baseline and one other row, and of what gets worse one kind that changes
    arguments and one that changes images, at its mildest level, at which a few images are enough."""
    other = next((row for row in table.rows if row.variant != table.baseline), None)
    rows = tuple(row for row in table.rows if row.variant == table.baseline or row is other)
    by_kind = {bool(known[name].options): name for name in reversed(table.degradations)}
    degradations = tuple(name for name in table.degradations if name in by_kind.values())
    return table.with_changes(rows=rows, degradations=degradations)


def suite_cache(arguments, tools):
    """Where the list of the sequences of the suite is kept."""
    program = tools.path("make_synthetic")
    return arguments.out / f"suite-{tools.hash(program)[:DIGITS]}.json"


def make_request(arguments, tools, suite):
    definitions = read_definitions(arguments.definitions)
    if arguments.quick:
        definitions = definitions.with_changes(tables={
            name: quick_table(table, definitions.degradations)
            for name, table in definitions.tables.items()})
    frames = arguments.frames or (QUICK_FRAMES if arguments.quick else None)
    sequences = recorded_sequences(arguments, definitions, tools.config)
    if suite:
        sequences += read_suite(suite, definitions.paper_sequences, frames)
    sequences = select(in_order(sequences, definitions.paper_sequences), arguments.only)
    if arguments.quick:
        sequences = quick_choice(sequences)
    seeds = arguments.seeds or (1 if arguments.quick else 3)
    return Request(definitions, sequences, chosen(arguments.tables, definitions.tables, "--tables"),
                   chosen(arguments.modes, MODES, "--modes"),
                   range(arguments.first_seed, arguments.first_seed + seeds), frames,
                   arguments.quick, arguments.timeout)


# ---- what is done


def print_plan(request, plan, cells, out):
    """What would be run."""
    for sequence in request.sequences:
        part = f", plays {sequence.paper}" if sequence.paper and sequence.rendered else ""
        print(f"sequence {sequence.name}: {sequence.dataset}, {sequence.frames} images{part}, "
              f"masks {sequence.masks or 'none'}")
    used = {}
    for (table, mode, _), found in cells.items():
        used.setdefault((table, mode), set()).update(name for cell in found for name in cell["runs"].values())
    for (table, mode), names in used.items():
        print(f"table {table}, {mode}: {len(names)} runs")
    done = {name for name, run in plan["runs"].items() if (out / result_file(name, run)).is_file()}
    frames = sum(run["frames"] for name, run in plan["runs"].items() if name not in done)
    print(f"{len(plan['runs'])} different runs, {len(done)} of them done; {frames} images to process")
    for name in plan["runs"]:
        print(f"  {'done' if name in done else 'to do'}  {name}")


def forget_failures(plan, out):
    """Removes the results of failed runs, so that they are run again."""
    for name, run in plan["runs"].items():
        path = out / result_file(name, run)
        if path.is_file() and read_json(path).get("failure"):
            path.unlink()


def write_tables(report, out, old):
    """Writes all files of the tables, and replaces the former ones together."""
    new, target, former = out / ".tables.new", out / "tables", out / ".tables.old"
    for path in (new, former):
        shutil.rmtree(path, ignore_errors=True)
    new.mkdir()
    if old is not None:
        found = compare_reports(old, json.loads(report.json_text()))
        grid = comparison_grid(found, {name: variant.label for name, variant in
                                       report.definitions.variants.items()})
        write(new / "compare.json", json.dumps(found, indent=1) + "\n")
        write(new / "compare.md", "\n".join(markdown_lines(grid, 1)).rstrip() + "\n")
    for name, text in (("tables.md", markdown(report)), ("tables.tex", latex(report)),
                       ("tables.csv", report.csv_text()), ("tables.json", report.json_text())):
        write(new / name, text)
    if target.exists():
        target.rename(former)
    new.rename(target)
    shutil.rmtree(former, ignore_errors=True)


def reproduce(arguments):
    out, tools = arguments.out, Tools(arguments.programs.resolve())
    old = read_report(arguments.compare) if arguments.compare else None
    paper = read_json(OWN / "paper_tables.json")
    if arguments.suite and not arguments.quiet and not suite_cache(arguments, tools).is_file():
        print("asking make_synthetic for its sequences", file=sys.stderr, flush=True)
    suite = arguments.suite and suite_file(tools.path("make_synthetic"), suite_cache(arguments, tools))
    request = make_request(arguments, tools, suite)
    plan, cells = make_plan(request, tools)
    if not plan["runs"]:
        raise InputError("there is nothing to run: no sequence fits to these tables and modes")
    if arguments.list:
        print_plan(request, plan, cells, out)
        return
    with at_work(plan, out):
        if suite:
            write(suite_cache(arguments, tools), json.dumps(suite, indent=1) + "\n")
        if arguments.retry_failed:
            forget_failures(plan, out)
        if arguments.dry_run:
            print(describe_dry_run(out, arguments.jobs, arguments.profile))
            return
        if not arguments.so_far:
            make_all(plan, out, arguments.jobs, arguments.profile, arguments.quiet)
        results = read_results(plan, out)
        report = Report(request, plan, cells, results, paper)
        write_tables(report, out, old)
    failed = sum(1 for result in results.values() if result and result["failure"])
    if not arguments.quiet:
        print(f"{out / 'tables' / 'tables.md'}: {len(results)} runs, {failed} failed")


# ---- arguments


def parse_arguments(words):
    parser = parser_of(__doc__)
    data = parser.add_argument_group("sequences")
    data.add_argument("--suite", choices=("synthetic",), help="the sequences of make_synthetic")
    data.add_argument("--data", type=pathlib.Path, action="append", default=[], metavar="FOLDER",
                      help="all sequences in the folders of FOLDER")
    data.add_argument("--sequence", action="append", default=[], metavar="[tum=|icl=]FOLDER",
                      help="a sequence of TUM RGB-D or ICL-NUIM; can be repeated")
    data.add_argument("--sequences", type=pathlib.Path, action="append", default=[], metavar="FILE",
                      help="text file with one sequence per line")
    data.add_argument("--only", metavar="NAME,...", help="of all these sequences only some")
    data.add_argument("--masks", metavar="PATH",
                      help="masks of recorded sequences: a name within the folder of the sequence, or "
                           "a path in which {name} is the name of the sequence (default: masks)")
    runs = parser.add_argument_group("runs")
    runs.add_argument("--out", type=pathlib.Path, required=True, help="folder for runs and tables")
    runs.add_argument("--tables", metavar="I,II,...", help="only some of the tables")
    runs.add_argument("--modes", metavar="rgbd,mono", help="only one of the modes")
    runs.add_argument("--seeds", type=number(1, kind=int), metavar="N", help="runs per cell (default 3)")
    runs.add_argument("--first-seed", type=number(0, kind=int), default=0, metavar="N", help="(default 0)")
    runs.add_argument("--frames", type=number(2, kind=int), metavar="N", help="only the first N images")
    runs.add_argument("--quick", action="store_true",
                      help=f"see whether everything works: {QUICK_SEQUENCES} sequences, one seed, "
                           f"{QUICK_FRAMES} images, two rows of each table and two degradations")
    runs.add_argument("--definitions", type=pathlib.Path, default=OWN / "tables.yaml",
                      metavar="FILE", help="what is run and what the tables show (default: "
                      "paper_tables/tables.yaml beside this script)")
    work = parser.add_argument_group("work")
    add_work_options(work, timeout=3600.0)
    work.add_argument("--profile", metavar="NAME", help="profile of Snakemake for a cluster: slurm, "
                      "or a folder with config.yaml")
    work.add_argument("--dry-run", action="store_true", help="print Snakemake's jobs, and end")
    work.add_argument("--retry-failed", action="store_true", help="repeat runs that have failed")
    work.add_argument("--compare", type=pathlib.Path, metavar="OLD.json",
                      help="compare with an older tables.json")
    arguments = parser.parse_args(words)
    if not (arguments.suite or arguments.data or arguments.sequence or arguments.sequences):
        parser.error("no sequences; give --suite synthetic, --data, --sequence or --sequences")
    return arguments


def main(words=None):
    arguments = parse_arguments(words)
    stop_by_signals()
    return exit_code(reproduce, arguments)


if __name__ == "__main__":
    sys.exit(main())
