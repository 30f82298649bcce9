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

In every argument of a run, {seed} is replaced by the run's seed and {sequence} by the folder of its
sequence. Nothing in a sequential run is random, so repetitions differ only if their input does. For
a synthetic sequence render it with several seeds (--sequence "desk-{seed}" --common "--masks
{sequence}/masks"). For a real sequence start each run at another frame (--common "--first {seed}").

Each run is stored in OUT/SEQUENCE/NAME/seed-N. A run is skipped if it is complete there and was
made by the same command and the same program. A run that fails is reported and counted, and is
repeated when the script is started again.
"""

import argparse
import hashlib
import json
import pathlib
import re
import shlex
import statistics
import subprocess
import sys

RECORD = "ablation_run.json"  # beside the outputs of a run: the command that made them
COLUMNS = [  # heading, keys in summary.json, format
    ("ATE m", ("trajectory", "ate_rmse_m"), ".5f"),
    ("tracked", ("trajectory", "tracked"), ".0f"),
    ("objects", ("objects", "count"), ".1f"),
    ("SIoU", ("objects", "siou_mean"), ".3f"),
    ("SIoU mask", ("objects", "siou_mask_mean"), ".3f"),
    ("MTD m2", ("objects", "mtd_mean_m2"), ".2e"),
    ("tangent px", ("objects", "tangent_mean_px"), ".2f"),
    ("median ms", ("timing", "track_ms", "median"), ".1f"),
]


class InputError(Exception):
    """An error that the user can correct."""


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
        other = known.setdefault(name_of(sequence), sequence)
        if other is not sequence:
            raise InputError(f"{other} and {sequence} have the same name '{name_of(sequence)}'; use "
                             "another --out for one of them")


def fingerprint(command):
    """A hash of the command and the program's bytes. If it changes, a finished run is repeated."""
    program = pathlib.Path(command[0])
    content = program.read_bytes() if program.is_file() else b""
    return hashlib.sha256(content + json.dumps(command).encode()).hexdigest()


def read_json(path):
    """The JSON object in a file; None if the file cannot be read or contains something else."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return content if isinstance(content, dict) else None


def run_once(command, folder, seconds):
    """Returns (summary, error) of the run in `folder`. Makes the run unless it is already there.

    The error is empty if the run succeeded.
    """
    mark = fingerprint(command)
    record, summary = read_json(folder / RECORD), read_json(folder / "summary.json")
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
    summary = read_json(folder / "summary.json")
    if code == 2:  # bad usage or input: all other runs would fail too
        last = (folder / "log.txt").read_text(encoding="utf-8", errors="replace").splitlines()[-1]
        raise InputError(f"{shlex.join(command)}: {last}")
    if code != 0 or summary is None:
        return None, f"exit code {code}" if code else "no summary.json"
    (folder / RECORD).write_text(json.dumps({"fingerprint": mark, "command": command}) + "\n",
                                 encoding="utf-8")
    return summary, ""


def value_at(summary, keys):
    """The number under these keys of the summary; None if there is no number."""
    for key in keys:
        summary = summary.get(key) if isinstance(summary, dict) else None
    is_number = isinstance(summary, (int, float)) and not isinstance(summary, bool)
    return float(summary) if is_number else None


def collect(summaries):
    """Mean, sample standard deviation (0 for a single run) and values of every column."""
    row = {}
    for heading, keys, _ in COLUMNS:
        values = [value for value in (value_at(summary, keys) for summary in summaries)
                  if value is not None]
        row[heading] = {"mean": statistics.fmean(values) if values else None,
                        "sd": statistics.stdev(values) if len(values) > 1 else 0.0,
                        "values": values}
    return row


def cell(entry, form, with_deviation):
    if entry["mean"] is None:
        return "-"
    text = format(entry["mean"], form)
    if with_deviation and len(entry["values"]) > 1:
        text += f" ± {format(entry['sd'], form)}"
    return text


def table(results):
    """A Markdown table with one row per sequence and variant.

    The ATE has its standard deviation and its change against the first variant of the sequence.
    """
    lines = ["| sequence | variant | runs | " + " | ".join(c[0] for c in COLUMNS) + " | ATE change |",
             "|---|---|---|" + "---|" * (len(COLUMNS) + 1)]
    first = {}
    for result in results:
        row, ate = result["figures"], result["figures"]["ATE m"]["mean"]
        base = first.setdefault(result["sequence"], ate)
        change = f"{100 * (ate / base - 1):+.1f} %" if ate is not None and base else "-"
        runs = str(result["runs"]) + (f" ({result['failed']} failed)" if result["failed"] else "")
        cells = [cell(row[heading], form, heading == "ATE m") for heading, _, form in COLUMNS]
        lines.append(f"| {result['sequence']} | {result['variant']} | {runs} | "
                     + " | ".join(cells) + f" | {change} |")
    return "\n".join(lines) + "\n"


def write(path, text):
    """Writes a file by renaming a temporary one, so that it is never incomplete."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(path)


def run_variant(arguments, sequence, name, settings):
    """Makes all runs of a variant on a sequence and returns their result."""
    summaries, failures = [], []
    title = name_of(sequence)
    for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds):
        folder = arguments.out / title / name / f"seed-{seed}"
        path = str(sequence).replace("{seed}", str(seed))
        given = [item.replace("{seed}", str(seed)).replace("{sequence}", path)
                 for item in [*arguments.common, *settings]]
        command = [str(arguments.program), path, *given, "--seed", str(seed), "--quiet",
                   "--output", str(folder)]
        summary, failure = run_once(command, folder, arguments.timeout)
        if failure:
            failures.append(f"seed {seed}: {failure}")
            print(f"{title} {name} seed {seed}: {failure}; see {folder / 'log.txt'}",
                  file=sys.stderr)
        else:
            summaries.append(summary)
            ate = value_at(summary, ("trajectory", "ate_rmse_m"))
            print(f"{title} {name} seed {seed}: ATE "
                  f"{'unknown' if ate is None else f'{ate:.4f} m'}", flush=True)
    return {"sequence": title, "variant": name, "arguments": settings,
            "runs": len(summaries), "failed": len(failures), "failures": failures,
            "figures": collect(summaries)}


def find_program(given):
    top = pathlib.Path(__file__).resolve().parent.parent
    program = given or top / "build" / "release" / "bin" / "rgbd_tum"
    if not program.is_file():
        raise InputError(f"{program}: no such program; build it or give another one by --program")
    return program


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sequence", type=pathlib.Path, action="append", required=True,
                        help="folder of a sequence, may contain {seed}; can be repeated")
    parser.add_argument("--variant", action="append", required=True,
                        help="NAME:KEY=VALUE,...; can be repeated, the others are compared "
                             "with the first")
    parser.add_argument("--out", type=pathlib.Path, required=True,
                        help="folder for runs and tables")
    parser.add_argument("--seeds", type=int, default=5,
                        help="number of runs per variant and sequence (default 5)")
    parser.add_argument("--first-seed", type=int, default=0,
                        help="seed of the first run; the next have the next numbers (default 0)")
    parser.add_argument("--common", default="", help="arguments of every run, as one string")
    parser.add_argument("--program", type=pathlib.Path,
                        help="program to run (default: build/release/bin/rgbd_tum)")
    parser.add_argument("--timeout", type=float, default=3600.0,
                        help="longest time of a run, s (default 3600)")
    arguments = parser.parse_args()
    if arguments.seeds < 1 or arguments.first_seed < 0:
        parser.error("--seeds must be 1 or more, --first-seed 0 or more")
    if not 0.0 < arguments.timeout < 1e9:
        parser.error("--timeout must be a number of seconds")
    return arguments


def main():
    arguments = parse_arguments()
    try:
        arguments.program = find_program(arguments.program)
        variants = [parse_variant(text) for text in arguments.variant]
        names = [name for name, _ in variants]
        if len(set(names)) != len(names):
            raise InputError(f"two variants have the same name: {', '.join(names)}")
        check_names(arguments.sequence)
        arguments.common = parse_common(arguments.common)
        results = []
        for sequence in arguments.sequence:
            for name, settings in variants:
                results.append(run_variant(arguments, sequence, name, settings))
                # Written after each variant, so that the table can be read while others run.
                write(arguments.out / "ablation.md", table(results))
                write(arguments.out / "ablation.json", json.dumps(results, indent=1) + "\n")
    except (InputError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(table(results), end="")
    return 1 if any(result["failed"] for result in results) else 0


if __name__ == "__main__":
    sys.exit(main())
