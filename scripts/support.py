# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts share: errors and how they are shown, files, figures of a run, and where the
programs are."""

import argparse
import functools
import hashlib
import importlib.util
import json
import math
import pathlib
import subprocess
import sys

SCRIPTS = pathlib.Path(__file__).resolve().parent
LARGEST = 1e6  # m, the largest coordinate that a trajectory may contain


class InputError(Exception):
    """An error that the user can correct. The message names the file."""


class Stopped(Exception):
    """Work could not be finished for a reason that the next start may not have, such as a full disk."""


def one_line(text, length=200):
    """The text on one line of printable characters, cut to the given length."""
    line = "".join(c if c.isprintable() else " " for c in str(text))
    return line if len(line) <= length else line[:length - 3] + "..."


def exit_code(work, arguments, failure=1):
    """Does work(arguments) and prints its error. Returns the exit code: that of the work or 0, 2 for an
    error that the user can correct, 1 for an interruption, and `failure` for an error of the system."""
    try:
        return work(arguments) or 0
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("error: interrupted; start again to go on", file=sys.stderr)
        return 1
    except (Stopped, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return failure


def parser_of(doc):
    """A parser of arguments whose help begins with the text, as it is."""
    return argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)


def number(low, high=math.inf, kind=float):
    """The type of an argument that is a number of a range."""
    def number_of(text):
        value = kind(text)
        if not low <= value <= high:
            limits = f"from {low:g} to {high:g}" if high < math.inf else f"of {low:g} or more"
            raise argparse.ArgumentTypeError(f"is '{text}', expected a number {limits}")
        return value
    return number_of


def check_program(doc, check_tree):
    """The program of a script that checks the repository: prints the faults that check_tree(root) finds,
    one line each. Returns 1 if there are any."""
    parser = parser_of(doc)
    parser.add_argument("root", nargs="?", default=SCRIPTS.parent,
                        help="top folder of the repository (default: the one of this script)")
    faults = check_tree(parser.parse_args().root)
    for line in faults:
        print(line, file=sys.stderr)
    return 1 if faults else 0


def require(*packages):
    """Ends the program with a message and exit code 2 if this Python lacks a package."""
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if missing:
        script = sys.argv[0]
        print(f"error: {sys.executable} has no {' and no '.join(missing)}. Scripts use Debian's "
              f"packages: start {script} itself or /usr/bin/python3 {script}, not another python3; "
              "scripts/setup.sh installs "
              f"{' '.join(f'python3-{package.lower()}' for package in missing)}", file=sys.stderr)
        sys.exit(2)


def programs_folder():
    """The folder of the programs of the installation, in which the scripts are in
    share/hullslam/scripts, or of the build."""
    top = SCRIPTS.parent
    installed = top.parent.parent / "libexec" / "hullslam"
    return installed if (installed / "rgbd_tum").is_file() else top / "build" / "release" / "bin"


def call(*command, **options):
    """The result of a program, with all that it prints."""
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, **options)


def run_program(command, log, **options):
    """The exit code of a program, whose messages go to the file `log`."""
    with log.open("w", encoding="utf-8") as messages:
        try:
            return subprocess.run([str(word) for word in command], stdout=messages, stderr=messages,
                                  check=False, **options).returncode
        except OSError as error:
            raise InputError(f"cannot run {command[0]}: {error.strerror}") from error


@functools.cache
def hullslam_module():
    """HullSLAM's Python module: one that this Python has, else that of the build or installation."""
    built = programs_folder().parent
    sys.path += [str(built / "python"), str(built.parent / "lib" / "python3" / "dist-packages")]
    try:
        import hullslam
    except ImportError as error:
        raise InputError(f"{sys.executable} has no package hullslam ({one_line(error)}); build it (cmake "
                         "--build --preset release --target hullslam_python) or install it (pip install "
                         "./python)") from error
    return hullslam


def reachable(first, following):
    """The first things, those that following(thing) gives for them, and so on: each once."""
    found = dict.fromkeys(first)
    order = list(found)
    for thing in order:  # grows while it is read
        new = [other for other in dict.fromkeys(following(thing)) if other not in found]
        found.update(dict.fromkeys(new))
        order += new
    return order


# ---- files


def hash_file(path):
    """The SHA-256 of the bytes of a file."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def write(path, content):
    """Writes a text or bytes by renaming a temporary file, so that a file is never incomplete."""
    temporary = path.with_name(f".{path.name}.tmp")
    try:
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def read_text(path):
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file: {error}") from error


def read_json(path):
    """The JSON object in a file."""
    try:
        content = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON: {one_line(error)}") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected a JSON object")
    return content


def try_read_json(path):
    """The JSON object in a file; None if the file cannot be read or contains something else."""
    try:
        return read_json(path)
    except InputError:
        return None


def value_at(content, *keys):
    """The number under these keys of a JSON object; None if there is no number."""
    for key in keys:
        content = content.get(key) if isinstance(content, dict) else None
    is_number = isinstance(content, (int, float)) and not isinstance(content, bool)
    return float(content) if is_number else None


def list_lines(path):
    """(number, words) of each line of a text file that is neither empty nor a comment."""
    return [(number, line.split()) for number, line in enumerate(read_text(path).splitlines(), 1)
            if line.strip() and not line.lstrip().startswith("#")]


def read_trajectory(path):
    """Stamps (n) and poses (n x 7, tx ty tz qx qy qz qw) of a TUM file, one pose per line."""
    import numpy as np
    rows = []
    for count, words in list_lines(path):
        try:
            row = [float(word) for word in " ".join(words).replace(",", " ").split()]
        except ValueError:
            row = []
        if len(row) != 8 or not all(map(math.isfinite, row)):
            raise InputError(f"{path}:{count}: expected 8 numbers, stamp tx ty tz qx qy qz qw")
        if max(map(abs, row[1:])) > LARGEST or abs(row[0]) > 1e12:
            raise InputError(f"{path}:{count}: a value is too large to be true")
        rows.append(row)
    if not rows:
        raise InputError(f"{path}: no poses")
    rows = np.array(rows)
    return rows[:, 0], rows[:, 1:]
