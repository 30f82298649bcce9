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
import contextlib
import json
import os
import pathlib
import random
import shlex
import shutil
import subprocess
import sys
import tempfile

from support import call, exit_code, InputError, number, parser_of, read_text

TOP = pathlib.Path(__file__).resolve().parent.parent
MARK = "copy_of_plant_defects"  # a file in the copy
NEEDED = {"name", "file", "find", "replace"}


def read_defects(path, names):
    """The entries of the list; only those with the given names, if there are any."""
    try:
        entries = json.loads(read_text(path))
        for entry in entries:
            has_keys = NEEDED <= entry.keys() <= NEEDED | {"test"}
            if not has_keys or not all(isinstance(value, str) for value in entry.values()):
                raise InputError(f"{path}: {entry.get('name', entry)}: expected texts name, file, "
                                 "find, replace, and perhaps test")
            if entry["find"] == entry["replace"] or not entry["find"]:
                raise InputError(f"{path}: {entry['name']}: replaces nothing")
    except (ValueError, TypeError, AttributeError) as error:
        raise InputError(f"{path}: not a list of defects: {error}") from error
    known = {entry["name"] for entry in entries}
    if len(known) != len(entries):
        raise InputError(f"{path}: two defects have the same name")
    if unknown := sorted(set(names) - known):
        raise InputError(f"{path}: no defect {', '.join(unknown)}")
    return [entry for entry in entries if not names or entry["name"] in names]


def git(top, *words):
    """What git prints about the tree."""
    result = call("git", *words, cwd=top)
    if result.returncode != 0:
        raise InputError(f"git {' '.join(words)} in {top}: {result.stderr.strip()}")
    return result.stdout


def seed_of_commit(top):
    """A number that follows from the commit of the tree."""
    return int(git(top, "rev-parse", "HEAD")[:8], 16)


def draw(entries, arguments):
    """Some of the entries, in the order of the list."""
    seed = seed_of_commit(arguments.tree) if arguments.seed is None else arguments.seed
    chosen = random.Random(seed).sample(range(len(entries)), min(arguments.sample, len(entries)))
    print(f"{len(chosen)} of {len(entries)} defects, --seed {seed}", flush=True)
    return [entries[i] for i in sorted(chosen)]


def command_of(entry):
    """The test program and its arguments."""
    parts = pathlib.PurePath(entry["file"]).parts
    module = parts[2] if parts[0] == "include" else parts[1]
    return shlex.split(entry.get("test", f"{module}_tests"))


def sync(top, copy):
    """Makes the copy equal to the tree. Equal files are not touched, so that they stay built."""
    if not (copy / MARK).exists() and copy.exists() and any(copy.iterdir()):
        raise InputError(f"{copy}: is not empty and no copy of this script")
    copy.mkdir(parents=True, exist_ok=True)
    (copy / MARK).touch()
    listed = git(top, "ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")
    wanted = {name for name in listed if name and (top / name).is_file()}
    for source, target in ((top / name, copy / name) for name in sorted(wanted)):
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
        ccache = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        result = self._run(["cmake", "--preset", "release", "-DCMAKE_UNITY_BUILD=OFF", *ccache])
        if result.returncode != 0:
            raise InputError(f"cmake failed in {self.copy}:\n{result.stdout[-2000:]}")

    def compile(self, target):
        """The messages of a compilation that has failed; None if it has not."""
        result = self._run(["cmake", "--build", str(self.build), "-j", str(self.jobs), "--target", target])
        return None if result.returncode == 0 else result.stdout

    def passes(self, command):
        try:
            result = self._run([str(self.build / "bin" / command[0]), *command[1:]], self.seconds)
            return result.returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def _run(self, command, seconds=None):
        return subprocess.run(command, cwd=self.copy, stdout=subprocess.PIPE, timeout=seconds,
                              stderr=subprocess.STDOUT, text=True, errors="replace", check=False)


def matches_of(entry, top):
    """The content of the file of a defect, and how often it has the text that is replaced."""
    path = top / entry["file"]
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    return text, text.count(entry["find"])


def try_defect(entry, builder):
    """Returns the result for a defect: "caught", "SURVIVED", or why it could not be tried."""
    path, (original, matches) = builder.copy / entry["file"], matches_of(entry, builder.copy)
    if matches != 1:
        return f"does not apply ({matches} matches)"
    command = command_of(entry)
    try:
        path.write_text(original.replace(entry["find"], entry["replace"]), encoding="utf-8")
        if (messages := builder.compile(command[0])) is not None:
            faults = [line for line in messages.splitlines() if "error:" in line]
            return f"does not compile: {faults[0] if faults else messages[-300:]}"
        return "SURVIVED" if builder.passes(command) else "caught"
    finally:
        path.write_text(original, encoding="utf-8")


def check(entries, top):
    """Prints the defects that do not apply to the tree. Returns 1 if there are any."""
    faults = [f"{entry['name']}: does not apply ({matches} matches in {entry['file']})"
              for entry in entries if (matches := matches_of(entry, top)[1]) != 1]
    print("\n".join([*faults, f"{len(entries)} defects, {len(faults)} do not apply"]))
    return 1 if faults else 0


def try_all(entries, builder):
    """Tries all defects and prints the results. Returns 1 if one was not caught."""
    builder.configure()
    for command in sorted({tuple(command_of(entry)) for entry in entries}):
        if (messages := builder.compile(command[0])) is not None:
            raise InputError(f"{command[0]} does not compile:\n{messages[-2000:]}")
        if not builder.passes(command):
            raise InputError(f"`{shlex.join(command)}` fails without a defect")
        print(f"{shlex.join(command)}: passes without a defect", flush=True)
    missed = []
    for entry in entries:
        outcome = try_defect(entry, builder)
        print(f"{entry['name']:<40} {outcome}", flush=True)
        if outcome != "caught":
            missed.append(f"  {entry['file']}: {entry['name']}: {outcome}")
    print("\n".join([f"{len(entries)} defects, {len(entries) - len(missed)} caught", *missed]))
    return 1 if missed else 0


def plant(arguments):
    entries = read_defects(arguments.list, arguments.names)
    if arguments.check:
        return check(entries, arguments.tree)
    if arguments.sample is not None:
        entries = draw(entries, arguments)
    with contextlib.ExitStack() as stack:
        copy = arguments.work or pathlib.Path(stack.enter_context(
            tempfile.TemporaryDirectory(prefix="plant_defects_"))) / "copy"
        sync(arguments.tree, copy.resolve())
        return try_all(entries, Builder(copy.resolve(), arguments.jobs, arguments.timeout))


def main():
    parser = parser_of(__doc__)
    parser.add_argument("names", metavar="NAME", nargs="*", help="defects to plant (default: all)")
    parser.add_argument("--list", type=pathlib.Path, metavar="FILE",
                        default=TOP / "scripts" / "defects.json",
                        help="list of defects (default: scripts/defects.json)")
    parser.add_argument("--check", action="store_true",
                        help="build nothing, only check that all defects apply to the tree")
    parser.add_argument("--work", type=pathlib.Path, metavar="DIR", help="folder for the copy, which is kept")
    parser.add_argument("--sample", type=number(1, kind=int), metavar="N",
                        help="plant only N defects, drawn at random (default: all)")
    parser.add_argument("--seed", type=int, metavar="SEED",
                        help="of --sample (default: a number that follows from the commit)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N",
                        help="parallel compilations (default: one per processor)")
    parser.add_argument("--timeout", type=float, default=600.0, metavar="S",
                        help="longest time of a test program (default 600)")
    parser.add_argument("--tree", type=pathlib.Path, default=TOP, help=argparse.SUPPRESS)
    return exit_code(plant, parser.parse_args(), failure=2)


if __name__ == "__main__":
    sys.exit(main())
