#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plants defects one by one into a copy of the sources and runs the tests of the module. A defect
that the tests do not notice survives: a test is missing.

The list is a JSON file of entries {"name", "file", "find", "replace", "test"}. The text `find` must
occur exactly once in `file`. `test` is the test program with its arguments; if it is absent, it is
that of the module: objects_tests for src/objects/fusion.cc. It must pass without a defect. A defect
counts as caught if the tests fail, crash or run too long.

With --sample N, N of the defects are drawn at random. The seed is printed; without --seed it follows
from the commit, so that other commits try other defects and a run can be repeated. All of them take
hours: one compilation, one link and one run of the module's tests each.

The user's tree is never changed. The copy is in a temporary folder, which is removed at the end, or
in --work DIR, which is kept: its build makes the next run faster. Only files that git knows are
copied, with their uncommitted changes.

Exit codes: 0 all defects are caught, 1 one survives, does not apply or does not compile, 2 bad
usage or input, or the tests fail without a defect.
"""

import argparse
import json
import os
import pathlib
import random
import shlex
import shutil
import subprocess
import sys
import tempfile

from support import InputError, parser_of

TOP = pathlib.Path(__file__).resolve().parent.parent
MARK = "copy_of_plant_defects"  # a file in the copy
KEYS = {"name", "file", "find", "replace", "test"}


def read_defects(path, names):
    """The entries of the list; only those with the given names, if there are any."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
        for entry in entries:
            strange = [key for key in entry if key not in KEYS or not isinstance(entry[key], str)]
            if strange or not {"name", "file", "find", "replace"} <= set(entry):
                raise InputError(f"{path}: {entry.get('name', entry)}: expected texts name, file, "
                                 "find, replace, and perhaps test")
            if entry["find"] == entry["replace"] or not entry["find"]:
                raise InputError(f"{path}: {entry['name']}: replaces nothing")
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise InputError(f"{path}: not a list of defects: {error}") from error
    known = [entry["name"] for entry in entries]
    if len(set(known)) != len(known):
        raise InputError(f"{path}: two defects have the same name")
    unknown = sorted(set(names) - set(known))
    if unknown:
        raise InputError(f"{path}: no defect {', '.join(unknown)}")
    return [entry for entry in entries if not names or entry["name"] in names]


def seed_of_commit(top):
    """A number that follows from the commit of the tree."""
    head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=top, check=True, capture_output=True,
                          text=True).stdout
    return int(head[:8], 16)


def draw(entries, count, seed):
    """`count` of the entries, in the order of the list."""
    chosen = random.Random(seed).sample(range(len(entries)), min(count, len(entries)))
    return [entries[i] for i in sorted(chosen)]


def command_of(entry):
    """The test program and its arguments."""
    parts = pathlib.PurePath(entry["file"]).parts
    module = parts[2] if parts[0] == "include" else parts[1]
    return shlex.split(entry.get("test", f"{module}_tests"))


def sync(top, copy):
    """Makes the copy equal to the tree. Equal files are not touched, so that they stay built."""
    if not (copy / MARK).exists():
        if copy.exists() and any(copy.iterdir()):
            raise InputError(f"{copy}: is not empty and no copy of this script")
        copy.mkdir(parents=True, exist_ok=True)
        (copy / MARK).touch()
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=top, check=True, capture_output=True).stdout.decode().split("\0")
    wanted = {name for name in listed if name and (top / name).is_file()}
    for name in sorted(wanted):
        source, target = top / name, copy / name
        if not target.exists() or source.read_bytes() != target.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
    for path in [path for path in copy.rglob("*") if path.is_file()]:
        name = path.relative_to(copy).as_posix()
        if name not in wanted and name != MARK and not name.startswith("build/"):
            path.unlink()


class Builder:
    """Builds and runs tests in the copy."""

    def __init__(self, copy, jobs, seconds):
        self.copy, self.build, self.jobs, self.seconds = copy, copy / "build/release", jobs, seconds

    def configure(self):
        # Without the unity build, only one file is compiled for each planted defect.
        command = ["cmake", "--preset", "release", "-DCMAKE_UNITY_BUILD=OFF"]
        if shutil.which("ccache"):
            command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        result = self._run(command, None)
        if result.returncode != 0:
            raise InputError(f"cmake failed in {self.copy}:\n{result.stdout[-2000:]}")

    def compile(self, target):
        """Returns (success, messages)."""
        result = self._run(["cmake", "--build", str(self.build), "-j", str(self.jobs), "--target",
                            target], None)
        return result.returncode == 0, result.stdout

    def passes(self, command):
        program = self.build / "bin" / command[0]
        try:
            return self._run([str(program), *command[1:]], self.seconds).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def _run(self, command, seconds):
        return subprocess.run(command, cwd=self.copy, stdout=subprocess.PIPE, timeout=seconds,
                              stderr=subprocess.STDOUT, text=True, errors="replace", check=False)


def apply_defect(text, entry):
    """The text with the defect; None if it does not apply."""
    if text.count(entry["find"]) != 1:
        return None
    return text.replace(entry["find"], entry["replace"])


def try_defect(entry, builder):
    """Returns the result for a defect: "caught", "SURVIVED", or why it could not be tried."""
    path = builder.copy / entry["file"]
    original = path.read_text(encoding="utf-8") if path.is_file() else ""
    changed = apply_defect(original, entry)
    if changed is None:
        return f"does not apply ({original.count(entry['find'])} matches)"
    command = command_of(entry)
    try:
        path.write_text(changed, encoding="utf-8")
        built, messages = builder.compile(command[0])
        if not built:
            faults = [line for line in messages.splitlines() if "error:" in line]
            return f"does not compile: {faults[0] if faults else messages[-300:]}"
        return "SURVIVED" if builder.passes(command) else "caught"
    finally:
        path.write_text(original, encoding="utf-8")


def check_applies(entries, top):
    """The defects that do not apply to the tree, one line per defect."""
    for entry in entries:
        path = top / entry["file"]
        matches = path.read_text(encoding="utf-8").count(entry["find"]) if path.is_file() else 0
        if matches != 1:
            yield f"{entry['name']}: does not apply ({matches} matches in {entry['file']})"


def run(entries, builder):
    """Tries all defects and prints the results. Returns the number that were not caught."""
    for command in sorted({tuple(command_of(entry)) for entry in entries}):
        built, messages = builder.compile(command[0])
        if not built:
            raise InputError(f"{command[0]} does not compile:\n{messages[-2000:]}")
        if not builder.passes(list(command)):
            raise InputError(f"`{shlex.join(command)}` fails without a defect")
        print(f"{shlex.join(command)}: passes without a defect", flush=True)
    outcomes = []
    for entry in entries:
        outcome = try_defect(entry, builder)
        outcomes.append((entry, outcome))
        print(f"{entry['name']:<40} {outcome}", flush=True)
    missed = [(entry, outcome) for entry, outcome in outcomes if outcome != "caught"]
    print(f"{len(outcomes)} defects, {len(outcomes) - len(missed)} caught")
    for entry, outcome in missed:
        print(f"  {entry['file']}: {entry['name']}: {outcome}")
    return len(missed)


def main(words=None):
    parser = parser_of(__doc__)
    parser.add_argument("names", metavar="NAME", nargs="*", help="defects to plant (default: all)")
    parser.add_argument("--list", type=pathlib.Path, metavar="FILE",
                        default=TOP / "scripts" / "defects.json",
                        help="list of defects (default: scripts/defects.json)")
    parser.add_argument("--check", action="store_true",
                        help="build nothing, only check that all defects apply to the tree")
    parser.add_argument("--work", type=pathlib.Path, metavar="DIR",
                        help="folder for the copy, which is kept")
    parser.add_argument("--sample", type=int, metavar="N",
                        help="plant only N defects, drawn at random (default: all)")
    parser.add_argument("--seed", type=int, metavar="SEED",
                        help="of --sample (default: a number that follows from the commit)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N",
                        help="parallel compilations (default: one per processor)")
    parser.add_argument("--timeout", type=float, default=600.0, metavar="S",
                        help="longest time of a test program (default 600)")
    parser.add_argument("--tree", type=pathlib.Path, default=TOP, help=argparse.SUPPRESS)
    arguments = parser.parse_args(words)
    temporary = None
    try:
        entries = read_defects(arguments.list, arguments.names)
        if arguments.check:
            faults = list(check_applies(entries, arguments.tree))
            print("\n".join([*faults, f"{len(entries)} defects, {len(faults)} do not apply"]))
            return 1 if faults else 0
        if arguments.sample is not None:
            if arguments.sample < 1:
                raise InputError(f"--sample: {arguments.sample}: expected at least 1")
            seed = seed_of_commit(arguments.tree) if arguments.seed is None else arguments.seed
            listed = len(entries)
            entries = draw(entries, arguments.sample, seed)
            print(f"{len(entries)} of {listed} defects, --seed {seed}", flush=True)
        if arguments.work is None:
            temporary = tempfile.TemporaryDirectory(prefix="plant_defects_")
        copy = arguments.work.resolve() if arguments.work else pathlib.Path(temporary.name) / "copy"
        sync(arguments.tree, copy)
        builder = Builder(copy, arguments.jobs, arguments.timeout)
        builder.configure()
        return 1 if run(entries, builder) else 0
    except (InputError, OSError, subprocess.CalledProcessError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    finally:
        if temporary is not None:
            temporary.cleanup()


if __name__ == "__main__":
    sys.exit(main())
