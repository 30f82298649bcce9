# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of sequences in TUM's format or ICL-NUIM's (its PNG package), pairs of stamps, alignments."""

import dataclasses
import pathlib
import shutil

import numpy as np

from support import InputError, list_lines

ICL_RATE = 30.0  # images per second
MAX_DIFFERENCE = 0.02  # s, between stamps of a pair: estimated and true pose, or image and depth
LEAST_POSES = 3  # for an alignment
STARTS = 50  # of align_most(). If half of the points are right, so is one of 8 triples, and no triple of
#              50 is right with a probability of (7/8)^50 = 0.1 %


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


def pair(stamps, truth_stamps):
    """Pairs of indices (k x 2) of stamps that differ by less than MAX_DIFFERENCE.

    Each stamp is in one pair at most; the pair with the smallest difference is taken first, as in TUM's
    associate.py.
    """
    order = np.argsort(truth_stamps, kind="stable")
    begin = np.searchsorted(truth_stamps, stamps - MAX_DIFFERENCE, sorter=order)
    end = np.searchsorted(truth_stamps, stamps + MAX_DIFFERENCE, side="right", sorter=order)
    candidates = sorted((abs(stamp - truth_stamps[j]), i, j) for i, stamp in enumerate(stamps)
                        for j in order[begin[i]:end[i]])
    used_i, used_j, pairs = set(), set(), []
    for difference, i, j in candidates:
        if difference < MAX_DIFFERENCE and i not in used_i and j not in used_j:
            used_i.add(i)
            used_j.add(j)
            pairs.append((i, j))
    return np.array(sorted(pairs), dtype=int).reshape(-1, 2)


def align(source, target, with_scale=False):
    """Returns s, R (3 x 3) and t (3) that minimise |s R source + t - target| (Umeyama 1991).

    `source` and `target` are n x 3, one point per row. s is 1 unless `with_scale`.
    """
    source_mean, target_mean = source.mean(axis=0), target.mean(axis=0)
    u, singular, vt = np.linalg.svd((target - target_mean).T @ (source - source_mean))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = u @ flip @ vt
    spread = np.sum((source - source_mean) ** 2)
    scale = float(singular @ np.diag(flip) / spread) if with_scale and spread > 0 else 1.0
    return scale, rotation, target_mean - scale * rotation @ source_mean


def move(alignment, points):
    """Points moved by a result of align()."""
    scale, rotation, shift = alignment
    return scale * points @ rotation.T + shift


def align_most(source, target, with_scale=False):
    """align() for the half of the points that agrees best, so that up to half may be wrong.

    Least trimmed squares (Rousseeuw and Van Driessen 2006): from triples of points, the half with
    the smallest errors is aligned anew until it stays the same, and of all results the one with the
    smallest sum of squares in its half counts. The triples are always the same.
    """
    count = len(source)
    half, rng = count // 2 + 1, np.random.default_rng(1)
    best, least = align(source, target, with_scale), np.inf
    for _ in range(STARTS):
        chosen, last = rng.choice(count, min(3, count), replace=False), np.inf
        while True:
            found = align(source[chosen], target[chosen], with_scale)
            squares = np.sum((move(found, source) - target) ** 2, axis=1)
            chosen = np.argpartition(squares, half - 1)[:half]
            total = squares[chosen].sum()
            if total >= last * (1.0 - 1e-6):
                break
            last = total
        if last < least:
            best, least = found, last
    return best
