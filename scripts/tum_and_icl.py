# SPDX-License-Identifier: GPL-3.0-or-later
"""The lists of a sequence in TUM's format or in ICL-NUIM's (its PNG package): reads and writes
them."""

import shutil

import numpy as np

from disturbances import Frame
from support import InputError, read_text

MAX_DIFFERENCE = 0.02  # s, between an image and its depth, as in TUM's associate.py
ICL_RATE = 30.0  # images per second


def read_rows(path):
    """Stamp and the other words of each line of a TUM list."""
    rows = []
    for count, line in enumerate(read_text(path).splitlines(), 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        try:
            rows.append((float(words[0]), words[1:]))
        except ValueError as error:
            raise InputError(f"{path}:{count}: expected a time stamp") from error
        if len(words) < 2 or not np.isfinite(rows[-1][0]):
            raise InputError(f"{path}:{count}: expected a time stamp and more")
    if not rows:
        raise InputError(f"{path}: no lines")
    return rows


def link(source, target):
    """Makes a link, or a copy if the file system has no links."""
    source = source.resolve(strict=True)
    try:
        target.symlink_to(source)
    except OSError:
        shutil.copy(source, target)


def pair_depth(stamps, depth_stamps):
    """Index of the depth image of each image, by increasing difference of their stamps."""
    order = np.argsort(depth_stamps, kind="stable")
    ordered = np.array(depth_stamps)[order]
    candidates = []
    for i, stamp in enumerate(stamps):
        low, high = np.searchsorted(ordered, [stamp - MAX_DIFFERENCE, stamp + MAX_DIFFERENCE])
        candidates += [(abs(ordered[k] - stamp), i, int(order[k])) for k in range(low, high)]
    pairs_of, taken = {}, set()
    for _, i, j in sorted(candidates):
        if i not in pairs_of and j not in taken:
            pairs_of[i] = j
            taken.add(j)
    return pairs_of


class TumLists:
    """rgb.txt and depth.txt."""

    @staticmethod
    def read(sequence):
        rows = read_rows(sequence / "rgb.txt")
        frames = [Frame(stamp, stamp, sequence / words[0]) for stamp, words in rows]
        if (sequence / "depth.txt").exists():
            depth = read_rows(sequence / "depth.txt")
            chosen = pair_depth([frame.stamp for frame in frames], [stamp for stamp, _ in depth])
            for i, j in chosen.items():
                frames[i].depth = sequence / depth[j][1][0]
        return "rgb.txt", frames

    @staticmethod
    def write(out, frames, name_of):
        for kind in ("rgb", "depth"):
            lines = [f"{frame.stamp:.6f} {kind}/{name_of(kind, path)}\n" for frame in frames
                     if (path := frame.image if kind == "rgb" else frame.depth) is not None]
            if lines:
                text = "# timestamp filename\n" + "".join(lines)
                (out / f"{kind}.txt").write_text(text, encoding="utf-8")


class IclLists:
    """associations.txt with the index of each frame, which is its time."""

    @staticmethod
    def read(sequence):
        frames, path = [], sequence / "associations.txt"
        for index, words in read_rows(path):
            if len(words) != 3 or words[1] != f"{index:g}" or index < 0 or index % 1:
                raise InputError(f"{path}: {index:g} {' '.join(words)}: expected index depth index "
                                 "rgb with the index of a frame")
            stamp = index / ICL_RATE
            frames.append(Frame(stamp, stamp, sequence / words[2], sequence / words[0]))
        return path.name, frames

    @staticmethod
    def write(out, frames, name_of):
        lines = []
        for frame in frames:
            if frame.stamp != frame.taken:
                raise InputError("the images of ICL-NUIM have no time stamps but numbers, so stamps "
                                 "cannot be wrong")
            index = round(frame.stamp * ICL_RATE)
            lines.append(f"{index} depth/{name_of('depth', frame.depth)} "
                         f"{index} rgb/{name_of('rgb', frame.image)}\n")
        (out / "associations.txt").write_text("".join(lines), encoding="utf-8")


def lists_of(sequence):
    """The lists that the sequence has. Neither: those of TUM, whose absence is then an error."""
    is_icl = (sequence / "associations.txt").exists() and not (sequence / "rgb.txt").exists()
    return IclLists if is_icl else TumLists


def read_frames(sequence):
    """The frames of a sequence, whose stamps increase."""
    if not sequence.is_dir():
        raise InputError(f"{sequence}: is no folder")
    if not any((sequence / name).exists() for name in ("rgb.txt", "associations.txt")):
        raise InputError(f"{sequence}: is no sequence, expected rgb.txt (TUM's format) or "
                         "associations.txt (ICL-NUIM)")
    name, frames = lists_of(sequence).read(sequence)
    if any(b.stamp <= a.stamp for a, b in zip(frames, frames[1:])):
        raise InputError(f"{sequence / name}: the time stamps do not increase")
    for frame in frames:
        for path in (frame.image, frame.depth):
            if path is not None and not path.is_file():
                raise InputError(f"{path}: no such file, but {sequence / name} lists it")
    return frames
