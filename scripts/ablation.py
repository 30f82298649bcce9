#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
r"""Compares variants of the settings: runs SLAM several times with each variant and writes a table
of the results, with trajectory error, fit of the objects and time of every variant, to
OUT/ablation.md and OUT/ablation.json.

    scripts/ablation.py --sequence SEQUENCE --out OUT --seeds 5 --common "--masks MASKS" \
        --variant off:objects.enabled=false --variant default: \
        --variant plane:objects.residual=algebraic_plane,objects.detection.primitive=hull

A variant is NAME:KEY=VALUE,KEY=VALUE,... Each pair becomes an argument --set KEY=VALUE. An item
that begins with a dash is passed on unchanged (NAME:--threaded). Write "\," for a comma in a value.
--variants FILE has one variant per line; lines that begin with # are comments.

--sequence PROGRAM=SEQUENCE runs another program of the same folder on this sequence, for example
--sequence mono_tum=data/fr1_xyz beside --sequence data/fr1_xyz.

In every argument of a run, {seed} is replaced by the run's seed and {sequence} by the folder of its
sequence. Sequential runs with the same input are equal, so repetitions need another input: several
renderings (--sequence "desk-{seed}" --common "--masks {sequence}/masks"), or another first frame
(--common "--first {seed}").

Each run is stored in OUT/SEQUENCE/NAME/seed-N. A run is skipped if it is complete there and was
made by the same command and the same program. A run that fails is reported and counted, and is
repeated when the script is started again. docs/ablation.md explains the table.
"""

import hashlib
import json
import pathlib
import re
import shlex
import statistics
import sys

from paper_tables.engine import LOG, PROGRAMS, last_message, stop_by_signals, work_off
from paper_tables.figures import lost_percent
from run_statistics import compare
from support import (InputError, exit_code, parser_of, programs_folder, read_text, try_read_json, value_at,
                     write)

RECORD = "ablation_run.json"  # beside the outputs of a run: the command that made them
COLUMNS = [  # heading, keys in summary.json, format
    ("ATE m", ("trajectory", "ate_rmse_m"), ".5f"),
    ("tracked", ("trajectory", "tracked"), ".0f"),
    ("lost %", None, ".1f"),
    ("objects", ("objects", "count"), ".1f"),
    ("SIoU", ("objects", "siou_mean"), ".3f"),
    ("SIoU mask", ("objects", "siou_mask_mean"), ".3f"),
    ("MTD m2", ("objects", "mtd_mean_m2"), ".2e"),
    ("tangent px", ("objects", "tangent_mean_px"), ".2f"),
    ("median ms", ("timing", "track_ms", "median"), ".1f"),
]
ALL = "mean"  # in place of a sequence: all of them together


def parse_variant(text):
    """The name and the arguments of the program for a variant NAME:KEY=VALUE,..."""
    name, colon, settings = text.partition(":")
    if not colon or not re.fullmatch(r"[\w+-][\w.+-]*", name):
        raise InputError(f"--variant is '{text}', expected NAME:KEY=VALUE,... with a name of "
                         "letters, digits and . _ + - that does not begin with a dot")
    arguments = []
    for item in filter(None, re.split(r"(?<!\\),", settings)):
        item = item.replace("\\,", ",")
        if item.startswith("-"):
            arguments.append(item)
        elif "=" in item.strip("="):
            arguments += ["--set", item]
        else:
            raise InputError(f"--variant {name}: '{item}', expected KEY=VALUE")
    return name, arguments


def read_variants(arguments):
    """{name: arguments of the program} of the variants of the file and of the command line."""
    lines = read_text(arguments.variants).splitlines() if arguments.variants else []
    texts = [line.strip() for line in lines if line.strip() and not line.strip().startswith("#")]
    variants = [parse_variant(text) for text in texts + arguments.variant]
    if not variants:
        raise InputError(f"{arguments.variants}: has no variant")
    if len(dict(variants)) != len(variants):
        raise InputError("two variants have the same name: "
                         f"{', '.join(name for name, _ in variants)}")
    return dict(variants)


class Sequence:
    """A sequence, the program that runs on it, and the name of the two in the tables and of the folder
    of its runs."""

    def __init__(self, text, default_program):
        match = re.fullmatch(r"([a-z][a-z_]*)=(.*)", text, re.DOTALL)
        self.path = pathlib.Path(match[2] if match else text)
        self.program = default_program.with_name(match[1]) if match else default_program
        name = self.path.resolve().name.replace("-{seed}", "").replace("{seed}", "") or "sequence"
        self.name = f"{name}-{match[1]}" if match else name
        if not self.program.is_file():
            raise InputError(f"{self.program}: no such program; build it or give another one by "
                             "--program")


def parse_common(text):
    """The list of arguments in the text of --common."""
    try:
        return shlex.split(text)
    except ValueError as error:
        raise InputError(f"--common is '{text}': {error}") from error


def read_sequences(arguments):
    """The sequences. Each needs a name of its own: its runs are stored under it."""
    known = {}
    for sequence in [Sequence(text, arguments.program) for text in arguments.sequence]:
        other = known.setdefault(sequence.name, sequence)
        if other is not sequence:
            raise InputError(f"{other.path} and {sequence.path} have the same name "
                             f"'{sequence.name}'; use another --out for one of them")
    return list(known.values())


def run_once(command, folder, seconds):
    """Returns (summary, error) of the run in `folder`. Makes the run unless it is already there.

    The error is empty if the run succeeded.
    """
    program = pathlib.Path(command[0]).read_bytes()
    mark = hashlib.sha256(program + json.dumps(command).encode()).hexdigest()
    record, summary = (try_read_json(folder / name) for name in (RECORD, "summary.json"))
    if record and record.get("fingerprint") == mark and summary is not None:
        return summary, ""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / RECORD).unlink(missing_ok=True)
    code = PROGRAMS.run(command, seconds, folder / LOG)
    if code is None:
        return None, f"not finished after {seconds:.0f} s"
    if code == 2:  # bad usage or input: all other runs would fail too
        raise InputError(f"{shlex.join(command)}: {last_message(folder / LOG)}")
    summary = try_read_json(folder / "summary.json")
    if code != 0 or summary is None:
        return None, f"exit code {code}" if code else "no summary.json"
    write(folder / RECORD, json.dumps({"fingerprint": mark, "command": command}) + "\n")
    return summary, ""


def figure(values):
    """Mean, sample standard deviation (0 for a single run) and the known ones of some values."""
    values = [value for value in values if value is not None]
    return {"mean": statistics.fmean(values) if values else None,
            "sd": statistics.stdev(values) if len(values) > 1 else 0.0, "values": values}


def collect(summaries):
    """The figures of every column."""
    return {heading: figure([value_at(summary, *keys) if keys else lost_percent(summary)
                             for summary in summaries]) for heading, keys, _ in COLUMNS}


def mean_of(results):
    """The figures of a variant on all sequences: the means of the means, each sequence counted
    once. A figure that a sequence does not have has no mean."""
    means = {heading: [result["figures"][heading]["mean"] for result in results]
             for heading, _, _ in COLUMNS}
    return {heading: {**figure([] if None in found else found), "sd": 0.0, "values": []}
            for heading, found in means.items()}


def cell(entry, form, with_deviation):
    if entry["mean"] is None:
        return "-"
    has_deviation = with_deviation and len(entry["values"]) > 1
    return format(entry["mean"], form) + (f" ± {format(entry['sd'], form)}" if has_deviation else "")


def with_means(results):
    """The results, followed by one per variant for all sequences if there are several and the
    variant has run on all of them."""
    means, count = [], len({result["sequence"] for result in results})
    for variant in dict.fromkeys(result["variant"] for result in results):
        found = [result for result in results if result["variant"] == variant]
        if len(found) == count > 1:
            means.append({"sequence": ALL, "variant": variant, "figures": mean_of(found),
                          **{key: sum(result[key] for result in found) for key in ("runs", "failed")},
                          "ates": {key: ate for result in found for key, ate in result["ates"].items()}})
    return results + means


def table(results):
    """A Markdown table with one row per sequence and variant, and one per variant for the mean over
    the sequences.

    The ATE has its standard deviation and its change against the first variant of the sequence.
    """
    lines = ["| sequence | variant | runs | " + " | ".join(c[0] for c in COLUMNS)
             + " | ATE change | p | pairs |",
             "|---|---|---|" + "---|" * (len(COLUMNS) + 3)]
    first = {}
    for result in with_means(results):
        row, base = result["figures"], first.setdefault(result["sequence"], result)
        change, p, pairs = (None, None, 0) if result is base else compare(base["ates"],
                                                                          result["ates"])
        runs = str(result["runs"]) + (f" ({result['failed']} failed)" if result["failed"] else "")
        cells = [cell(row[heading], form, heading == "ATE m") for heading, _, form in COLUMNS]
        cells += ["-" if change is None else f"{100 * change:+.1f} %",
                  "-" if p is None else f"{p:.2g}", str(pairs or "-")]
        lines.append(f"| {result['sequence']} | {result['variant']} | {runs} | "
                     + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def run_seed(arguments, sequence, name, settings, seed):
    """Makes one run. Returns (summary, error) as run_once() does."""
    folder = arguments.out / sequence.name / name / f"seed-{seed}"
    path = str(sequence.path).replace("{seed}", str(seed))
    given = [item.replace("{seed}", str(seed)).replace("{sequence}", path)
             for item in [*arguments.common, *settings]]
    command = [str(sequence.program), path, *given, "--seed", str(seed), "--quiet",
               "--output", str(folder)]
    summary, failure = run_once(command, folder, arguments.timeout)
    if failure:
        print(f"{sequence.name} {name} seed {seed}: {failure}; see {folder / 'log.txt'}",
              file=sys.stderr)
    else:
        ate = value_at(summary, "trajectory", "ate_rmse_m")
        print(f"{sequence.name} {name} seed {seed}: ATE "
              f"{'unknown' if ate is None else f'{ate:.4f} m'}", flush=True)
    return summary, failure


def result_of(sequence, name, settings, runs):
    """The result of a variant on a sequence. `runs` is {seed: (summary, error)}."""
    good = {seed: summary for seed, (summary, failure) in runs.items() if not failure}
    failures = [f"seed {seed}: {failure}" for seed, (_, failure) in runs.items() if failure]
    ates = {seed: value_at(summary, "trajectory", "ate_rmse_m") for seed, summary in good.items()}
    return {"sequence": sequence.name, "variant": name, "arguments": settings,
            "runs": len(good), "failed": len(failures), "failures": failures,
            "ates": {f"{sequence.name} {seed}": ate for seed, ate in ates.items()
                     if ate is not None},
            "figures": collect(good.values())}


def ablate(arguments):
    """Makes all runs, `arguments.jobs` at once. The tables are written after each variant, so that they
    can be read while others run. Returns 1 if a run has failed."""
    arguments.common = parse_common(arguments.common)
    sequences, variants = read_sequences(arguments), read_variants(arguments)
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    cells = [(sequence, *variant) for sequence in sequences for variant in variants.items()]
    runs, results = {}, []

    def make(index, seed):
        runs[index, seed] = run_seed(arguments, *cells[index], seed)

    def update():
        known = len(results)
        for index in range(known, len(cells)):
            if not all((index, seed) in runs for seed in seeds):
                break
            results.append(result_of(*cells[index], {seed: runs[index, seed] for seed in seeds}))
        if len(results) > known:
            write(arguments.out / "ablation.md", table(results))
            write(arguments.out / "ablation.json", json.dumps(results, indent=1) + "\n")

    work_off({(index, seed): (lambda index=index, seed=seed: make(index, seed), ())
              for index in range(len(cells)) for seed in seeds}, arguments.jobs, update)
    print(table(results), end="")
    return int(any(result["failed"] for result in results))


def parse_arguments():
    parser = parser_of(__doc__)
    parser.add_argument("--sequence", action="append", required=True, metavar="[PROGRAM=]SEQUENCE",
                        help="folder of a sequence, may contain {seed}, and the program for it if "
                             "it is not that of --program; can be repeated")
    parser.add_argument("--variant", action="append", default=[],
                        help="NAME:KEY=VALUE,...; can be repeated, the others are compared "
                             "with the first")
    parser.add_argument("--variants", type=pathlib.Path, metavar="FILE",
                        help="file with one variant per line, which come before those of --variant")
    parser.add_argument("--jobs", type=int, default=1, metavar="N",
                        help="number of runs at once (default 1)")
    parser.add_argument("--out", type=pathlib.Path, required=True,
                        help="folder for runs and tables")
    parser.add_argument("--seeds", type=int, default=5,
                        help="number of runs per variant and sequence (default 5)")
    parser.add_argument("--first-seed", type=int, default=0,
                        help="seed of the first run; the next have the next numbers (default 0)")
    parser.add_argument("--common", default="", help="arguments of every run, as one string")
    parser.add_argument("--program", type=pathlib.Path, default=programs_folder() / "rgbd_tum",
                        help="program to run (default: rgbd_tum of this installation or of "
                             "build/release/bin)")
    parser.add_argument("--timeout", type=float, default=3600.0,
                        help="longest time of a run, s (default 3600)")
    arguments = parser.parse_args()
    if arguments.seeds < 1 or arguments.first_seed < 0:
        parser.error("--seeds must be 1 or more, --first-seed 0 or more")
    if arguments.jobs < 1:
        parser.error("--jobs must be 1 or more")
    if not arguments.variant and not arguments.variants:
        parser.error("--variant or --variants is needed")
    if not 0.0 < arguments.timeout < 1e9:
        parser.error("--timeout must be a number of seconds")
    return arguments


def main():
    arguments = parse_arguments()
    stop_by_signals()
    return exit_code(ablate, arguments, failure=2)


if __name__ == "__main__":
    sys.exit(main())
