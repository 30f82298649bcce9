# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the files of a finished run and checks them. A broken file gives an InputError."""

import json
import math

import numpy as np

from run_errors import InputError, one_line

LARGEST = 1e6  # the largest length (m) and pixel coordinate that a file may contain
MAX_VERTICES = 100_000_000
MAX_PLY_HEADER = 1000  # lines
PLY_TYPES = {"float": "<f4", "float32": "<f4", "double": "<f8", "uchar": "u1", "uint8": "u1",
             "int": "<i4", "uint": "<u4", "short": "<i2", "ushort": "<u2", "char": "i1"}


def read_json(path):
    """The JSON object in a file."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        reason = "nested too deeply" if isinstance(error, RecursionError) else one_line(error)
        raise InputError(f"{path}: not valid JSON: {reason}") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected a JSON object")
    return content


def number(value, name, least=-LARGEST, largest=LARGEST):
    """A JSON number as a float; a ValueError that begins with `name` if it is something else."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not least <= value <= largest:
        raise ValueError(f"{name} is {one_line(json.dumps(value), 40)}, "
                         f"expected a number from {least:g} to {largest:g}")
    return float(value)


def numbers(value, count, name, least=-LARGEST, largest=LARGEST):
    """A JSON list of `count` numbers as an array."""
    if not isinstance(value, list) or len(value) != count:
        raise ValueError(f"{name}: expected {count} numbers")
    return np.array([number(item, name, least, largest) for item in value])


def pose(value, name):
    """A JSON list tx ty tz qx qy qz qw as an array."""
    entries = numbers(value, 7, name)
    if not 0.5 < np.linalg.norm(entries[3:]) < 2.0:
        raise ValueError(f"{name}: expected a quaternion of length 1")
    return entries


class Summary:
    """summary.json of a run. A value that is null or absent is None."""

    def __init__(self, path):
        self.path = path
        self.content = read_json(path) if path.exists() else {}

    def _at(self, keys):
        value = self.content
        for i, key in enumerate(keys):
            if value is None:
                return None
            if not isinstance(value, dict):
                raise InputError(f"{self.path}: {'.'.join(keys[:i])}: expected a JSON object")
            value = value.get(key)
        return value

    def number(self, *keys):
        value = self._at(keys)
        try:
            return None if value is None else number(value, ".".join(keys), -1e15, 1e15)
        except ValueError as error:
            raise InputError(f"{self.path}: {error}") from error

    def text(self, *keys):
        value = self._at(keys)
        if value is not None and not (isinstance(value, str) and value.isprintable()):
            raise InputError(f"{self.path}: {'.'.join(keys)}: expected a text")
        return value

    def texts(self, *keys):
        value = self._at(keys)
        if value is not None and not (isinstance(value, list)
                                      and all(isinstance(text, str) for text in value)):
            raise InputError(f"{self.path}: {'.'.join(keys)}: expected a list of texts")
        return value or []

    def keys(self, *keys):
        value = self._at(keys)
        if value is not None and not isinstance(value, dict):
            raise InputError(f"{self.path}: {'.'.join(keys)}: expected a JSON object")
        return list(value or {})


def read_trajectory(path):
    """Stamps (n) and poses (n x 7, tx ty tz qx qy qz qw) of a TUM file, one pose per line."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file: {error}") from error
    rows = []
    for count, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            row = [float(word) for word in line.replace(",", " ").split()]
        except ValueError:
            row = []
        if len(row) != 8 or not all(math.isfinite(value) for value in row):
            raise InputError(f"{path}:{count}: expected 8 numbers, stamp tx ty tz qx qy qz qw")
        if max(map(abs, row[1:])) > LARGEST or abs(row[0]) > 1e12:
            raise InputError(f"{path}:{count}: a value is too large to be true")
        rows.append(row)
    if not rows:
        raise InputError(f"{path}: no poses")
    rows = np.array(rows)
    return rows[:, 0], rows[:, 1:]


def read_ply_header(file, path):
    """The number of vertices and the numpy type of a vertex. Reads `file` up to the first vertex."""
    if file.readline(100).strip() != b"ply":
        raise InputError(f"{path}: not a PLY file")
    count, fields, binary, element, is_first = 0, [], False, "", True
    for _ in range(MAX_PLY_HEADER):
        words = file.readline(1000).decode("ascii", "replace").split()
        if words[:1] == ["end_header"]:
            break
        if words[:1] == ["format"]:
            binary = words[1:2] == ["binary_little_endian"]
        elif words[:1] == ["element"] and len(words) == 3 and words[2].isdecimal():
            is_first = not element
            element = words[1]
            if element == "vertex":
                count = int(words[2][:18])
                if not is_first or count > MAX_VERTICES:
                    raise InputError(f"{path}: expected at most {MAX_VERTICES} vertices, and that "
                                     "they are the first element")
        elif words[:1] == ["property"] and element == "vertex":
            if len(words) != 3 or words[1] not in PLY_TYPES:
                raise InputError(f"{path}: vertex property of an unknown type: "
                                 f"{one_line(' '.join(words), 60)}")
            fields.append((words[2], PLY_TYPES[words[1]]))
    else:
        raise InputError(f"{path}: the header has no end_header")
    names = [name for name, _ in fields]
    if not binary or not {"x", "y", "z"} <= set(names) or len(set(names)) < len(names):
        raise InputError(f"{path}: expected a binary little-endian PLY with vertices x y z")
    return count, np.dtype(fields)


def read_map(path, max_points):
    """Points (n x 3) and colours (n x 3, 0 to 1; None if the file has none) of a PLY file, and the
    number of vertices that are left out because their positions are no plausible numbers.

    Of more than `max_points` other vertices some are left out too, evenly.
    """
    try:
        with path.open("rb") as file:
            count, kind = read_ply_header(file, path)
            data = file.read(count * kind.itemsize)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    if len(data) < count * kind.itemsize:
        raise InputError(f"{path}: cut short; its header announces {count} vertices")
    vertices = np.frombuffer(data, kind)
    # The comparison is also false for NaN.
    is_plausible = np.all([np.abs(vertices[axis]) <= LARGEST for axis in "xyz"], axis=0)
    vertices = vertices[is_plausible]
    dropped = count - len(vertices)
    vertices = vertices[::max(1, -(-len(vertices) // max_points))]
    points = np.stack([vertices[axis].astype(float) for axis in "xyz"], axis=1)
    if not {"red", "green", "blue"} <= set(kind.names):
        return points, None, dropped
    colours = np.stack([vertices[c] / 255.0 for c in ("red", "green", "blue")], axis=1)
    if not ((colours >= 0) & (colours <= 1)).all():
        raise InputError(f"{path}: the colour of a vertex is not from 0 to 255")
    return points, colours, dropped


def find_sequence_at(text, run_dir):
    """The folder or video file that summary.json names; None if it is not found.

    A relative path was relative to the folder in which the run was started. It is looked for in the
    working directory, then in the folder of the run and in those above it.
    """
    for base in (run_dir.cwd(), *[run_dir.resolve(), *run_dir.resolve().parents]):
        try:
            if (base / text).exists():
                return base / text
        except (OSError, ValueError):  # a name that is too long, or with a zero byte
            return None
    return None
