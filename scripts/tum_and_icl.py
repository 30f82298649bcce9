# SPDX-License-Identifier: GPL-3.0-or-later
"""The lists of a sequence in TUM's format or in ICL-NUIM's (its PNG package): reads and writes
them."""

import dataclasses
import pathlib
import shutil

import numpy as np

from run_alignment import pair
from support import InputError, list_lines

ICL_RATE = 30.0  # images per second


@dataclasses.dataclass
class Frame:
    stamp: float  # s, the one that is written
    taken: float  # s, when the image was really taken
    image: pathlib.Path
    depth: pathlib.Path = None


def read_rows(path):
    """Stamp and the other words of each line of a TUM list."""
    rows = []
    for count, words in list_lines(path):
        try:
            rows.append((float(words[0]), words[1:]))
        except ValueError as error:
            raise InputError(f"{path}:{count}: expected a time stamp") from error
        if len(words) < 2 or not np.isfinite(rows[-1][0]):
            raise InputError(f"{path}:{count}: expected a time stamp and more")
    if not rows:
        raise InputError(f"{path}: no lines")
    return rows


def stamps_of(rows):
    """The stamps of rows (stamp, ...) as an array."""
    return np.array([stamp for stamp, *_ in rows])


def write_images(path, rows):
    """Writes a TUM list of images (stamp, name)."""
    lines = [f"{stamp:.6f} {name}\n" for stamp, name in rows]
    path.write_text("".join(["# timestamp filename\n", *lines]), encoding="utf-8")


def link(source, target):
    """Makes a link, or a copy if the file system has no links."""
    source = source.resolve(strict=True)
    try:
        target.symlink_to(source)
    except OSError:
        shutil.copy(source, target)


def link_descriptions(sequence, out):
    """Links the files that describe the camera and the true objects of a sequence, if it has them."""
    for name in ("camera.yaml", "groundtruth_objects.json"):
        if (sequence / name).exists():
            link(sequence / name, out / name)


def check_empty(out):
    """Refuses a folder for a new sequence that has something in it."""
    if out.exists() and not out.is_dir():
        raise InputError(f"{out}: exists and is no folder")
    if out.exists() and any(out.iterdir()):
        raise InputError(f"{out}: is not empty")


# ---- the two formats


def is_icl(sequence):
    """Whether a sequence has only the list of ICL-NUIM."""
    return (sequence / "associations.txt").exists() and not (sequence / "rgb.txt").exists()


def read_tum(sequence):
    """The frames of rgb.txt and depth.txt."""
    rows = read_rows(sequence / "rgb.txt")
    frames = [Frame(stamp, stamp, sequence / words[0]) for stamp, words in rows]
    if (sequence / "depth.txt").exists():
        depth = read_rows(sequence / "depth.txt")
        for i, j in pair(stamps_of(rows), stamps_of(depth)):
            frames[i].depth = sequence / depth[j][1][0]
    return frames


def write_tum(out, frames, name_of):
    for kind, attribute in ("rgb", "image"), ("depth", "depth"):
        rows = [(frame.stamp, f"{kind}/{name_of(kind, path)}") for frame in frames
                if (path := getattr(frame, attribute)) is not None]
        if rows:
            write_images(out / f"{kind}.txt", rows)


def read_icl(sequence):
    """The frames of associations.txt, which has the index of each frame as its time."""
    frames, path = [], sequence / "associations.txt"
    for index, words in read_rows(path):
        if len(words) != 3 or words[1] != f"{index:g}" or index < 0 or index % 1:
            raise InputError(f"{path}: {index:g} {' '.join(words)}: expected index depth index "
                             "rgb with the index of a frame")
        stamp = index / ICL_RATE
        frames.append(Frame(stamp, stamp, sequence / words[2], sequence / words[0]))
    return frames


def write_icl(out, frames, name_of):
    lines = []
    for frame in frames:
        if frame.stamp != frame.taken:
            raise InputError("the images of ICL-NUIM have no time stamps but numbers, so stamps "
                             "cannot be wrong")
        index = round(frame.stamp * ICL_RATE)
        lines.append(f"{index} depth/{name_of('depth', frame.depth)} "
                     f"{index} rgb/{name_of('rgb', frame.image)}\n")
    (out / "associations.txt").write_text("".join(lines), encoding="utf-8")


def read_frames(sequence):
    """The frames of a sequence, whose stamps increase."""
    if not sequence.is_dir():
        raise InputError(f"{sequence}: is no folder")
    path = sequence / ("associations.txt" if is_icl(sequence) else "rgb.txt")
    if not path.exists():
        raise InputError(f"{sequence}: is no sequence, expected rgb.txt (TUM's format) or "
                         "associations.txt (ICL-NUIM)")
    frames = (read_icl if is_icl(sequence) else read_tum)(sequence)
    if any(b.stamp <= a.stamp for a, b in zip(frames, frames[1:])):
        raise InputError(f"{path}: the time stamps do not increase")
    for image in (image for frame in frames for image in (frame.image, frame.depth) if image is not None):
        if not image.is_file():
            raise InputError(f"{image}: no such file, but {path} lists it")
    return frames
