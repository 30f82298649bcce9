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
sequence. Nothing in a sequential run is random, so repetitions differ only if their input does. For
a synthetic sequence render it with several seeds (--sequence "desk-{seed}" --common "--masks
{sequence}/masks"). For a real sequence start each run at another frame (--common "--first {seed}").

Each run is stored in OUT/SEQUENCE/NAME/seed-N. A run is skipped if it is complete there and was
made by the same command and the same program. A run that fails is reported and counted, and is
repeated when the script is started again. --jobs N makes N runs at once; times of runs are only
comparable with --jobs 1.

The change of the ATE is that of the geometric mean over pairs of runs with the same sequence and
seed. p is the probability of a change as large as this or larger if the variants did not differ
(two-sided sign-flip test of the logarithms). With n pairs it is at least 2 / 2^n, so a few runs
cannot show a difference.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shlex
import statistics
import subprocess
import sys
import threading

from run_errors import InputError
from run_programs import programs_folder
from run_statistics import compare, lost_percent, try_read_json, value_at, write

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


def read_variants(path):
    """The texts of the variants in a file."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error
    return [line.strip() for line in lines if line.strip() and not line.strip().startswith("#")]


class Sequence:
    """A sequence, the program that runs on it, and the name of the two in the tables."""

    def __init__(self, text, default_program):
        program, equals, path = text.partition("=")
        is_named = bool(equals) and re.fullmatch(r"[a-z][a-z_]*", program) is not None
        self.path = pathlib.Path(path if is_named else text)
        self.program = default_program.with_name(program) if is_named else default_program
        self.name = name_of(self.path) + (f"-{program}" if is_named else "")
        if not self.program.is_file():
            raise InputError(f"{self.program}: no such program; build it or give another one by "
                             "--program")


def parse_common(text):
    """The list of arguments in the text of --common."""
    try:
        return shlex.split(text)
    except ValueError as error:
        raise InputError(f"--common is '{text}': {error}") from error


def name_of(sequence):
    """The name of a sequence in the tables, and of the folder of its runs."""
    return sequence.resolve().name.replace("-{seed}", "").replace("{seed}", "") or "sequence"


def check_names(sequences):
    """Each sequence needs a name of its own: its runs are stored under it."""
    known = {}
    for sequence in sequences:
        other = known.setdefault(sequence.name, sequence)
        if other is not sequence:
            raise InputError(f"{other.path} and {sequence.path} have the same name "
                             f"'{sequence.name}'; use another --out for one of them")


def fingerprint(command):
    """A hash of the command and the program's bytes. If it changes, a finished run is repeated."""
    program = pathlib.Path(command[0])
    content = program.read_bytes() if program.is_file() else b""
    return hashlib.sha256(content + json.dumps(command).encode()).hexdigest()


def run_once(command, folder, seconds):
    """Returns (summary, error) of the run in `folder`. Makes the run unless it is already there.

    The error is empty if the run succeeded.
    """
    mark = fingerprint(command)
    record, summary = try_read_json(folder / RECORD), try_read_json(folder / "summary.json")
    if record and record.get("fingerprint") == mark and summary is not None:
        return summary, ""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / RECORD).unlink(missing_ok=True)
    with (folder / "log.txt").open("w", encoding="utf-8") as log:
        log.write(shlex.join(command) + "\n")
        log.flush()
        try:
            code = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False,
                                  timeout=seconds).returncode
        except subprocess.TimeoutExpired:
            return None, f"not finished after {seconds:.0f} s"
        except OSError as error:
            raise InputError(f"{command[0]}: {error.strerror}") from error
    summary = try_read_json(folder / "summary.json")
    if code == 2:  # bad usage or input: all other runs would fail too
        last = (folder / "log.txt").read_text(encoding="utf-8", errors="replace").splitlines()[-1]
        raise InputError(f"{shlex.join(command)}: {last}")
    if code != 0 or summary is None:
        return None, f"exit code {code}" if code else "no summary.json"
    (folder / RECORD).write_text(json.dumps({"fingerprint": mark, "command": command}) + "\n",
                                 encoding="utf-8")
    return summary, ""


def collect(summaries):
    """Mean, sample standard deviation (0 for a single run) and values of every column."""
    row = {}
    for heading, keys, _ in COLUMNS:
        found = [value_at(summary, keys) if keys else lost_percent(summary)
                 for summary in summaries]
        values = [value for value in found if value is not None]
        row[heading] = {"mean": statistics.fmean(values) if values else None,
                        "sd": statistics.stdev(values) if len(values) > 1 else 0.0,
                        "values": values}
    return row


def mean_of(results):
    """The figures of a variant on all sequences: the means of the means, each sequence counted
    once. A figure that a sequence does not have has no mean."""
    row = {}
    for heading, _, _ in COLUMNS:
        means = [result["figures"][heading]["mean"] for result in results]
        is_known = bool(means) and None not in means
        row[heading] = {"mean": statistics.fmean(means) if is_known else None, "sd": 0.0,
                        "values": []}
    return row


def cell(entry, form, with_deviation):
    if entry["mean"] is None:
        return "-"
    text = format(entry["mean"], form)
    if with_deviation and len(entry["values"]) > 1:
        text += f" ± {format(entry['sd'], form)}"
    return text


def with_means(results):
    """The results, followed by one per variant for all sequences if there are several and the
    variant has run on all of them."""
    sequences = list(dict.fromkeys(result["sequence"] for result in results))
    means = []
    for variant in dict.fromkeys(result["variant"] for result in results):
        of_variant = [result for result in results if result["variant"] == variant]
        if len(sequences) > 1 and len(of_variant) == len(sequences):
            means.append({"sequence": ALL, "variant": variant,
                          "runs": sum(result["runs"] for result in of_variant),
                          "failed": sum(result["failed"] for result in of_variant),
                          "ates": {key: ate for result in of_variant
                                   for key, ate in result["ates"].items()},
                          "figures": mean_of(of_variant)})
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
        ate = value_at(summary, ("trajectory", "ate_rmse_m"))
        print(f"{sequence.name} {name} seed {seed}: ATE "
              f"{'unknown' if ate is None else f'{ate:.4f} m'}", flush=True)
    return summary, failure


def result_of(sequence, name, settings, runs):
    """The result of a variant on a sequence. `runs` is {seed: (summary, error)}."""
    good = {seed: summary for seed, (summary, failure) in runs.items() if not failure}
    failures = [f"seed {seed}: {failure}" for seed, (_, failure) in runs.items() if failure]
    ates = {seed: value_at(summary, ("trajectory", "ate_rmse_m")) for seed, summary in good.items()}
    return {"sequence": sequence.name, "variant": name, "arguments": settings,
            "runs": len(good), "failed": len(failures), "failures": failures,
            "ates": {f"{sequence.name} {seed}": ate for seed, ate in ates.items()
                     if ate is not None},
            "figures": collect(good.values())}


def run_all(arguments, sequences, variants):
    """Makes all runs, `arguments.jobs` at once, and returns the results in order. The tables are
    written after each variant, so that they can be read while others run."""
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    results, failed = [], threading.Event()

    def run(*job):
        if failed.is_set():  # bad input has ended the script
            return None, "not begun"
        try:
            return run_seed(arguments, *job)
        except BaseException:
            failed.set()
            raise

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        jobs = {(sequence.name, name, seed): pool.submit(run, sequence, name, settings, seed)
                for sequence in sequences for name, settings in variants for seed in seeds}
        try:
            for sequence in sequences:
                for name, settings in variants:
                    runs = {seed: jobs[sequence.name, name, seed].result() for seed in seeds}
                    results.append(result_of(sequence, name, settings, runs))
                    write(arguments.out / "ablation.md", table(results))
                    write(arguments.out / "ablation.json", json.dumps(results, indent=1) + "\n")
        except BaseException:  # also Ctrl-C
            failed.set()
            raise
    return results


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
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
    try:
        sequences = [Sequence(text, arguments.program) for text in arguments.sequence]
        texts = read_variants(arguments.variants) if arguments.variants else []
        variants = [parse_variant(text) for text in texts + arguments.variant]
        names = [name for name, _ in variants]
        if not variants:
            raise InputError(f"{arguments.variants}: has no variant")
        if len(set(names)) != len(names):
            raise InputError(f"two variants have the same name: {', '.join(names)}")
        check_names(sequences)
        arguments.common = parse_common(arguments.common)
        results = run_all(arguments, sequences, variants)
    except (InputError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(table(results), end="")
    return 1 if any(result["failed"] for result in results) else 0


if __name__ == "__main__":
    sys.exit(main())
