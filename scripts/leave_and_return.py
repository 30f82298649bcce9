#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a sequence whose camera leaves the scene for N frames and then goes on from the same pose.

The first half of SEQUENCE is followed by N frames that show something else, then by its second
half. The frames in between are blank, or the first N frames of --other. There is no gap between the
stamps: those of the second half are later by N frame intervals. groundtruth.txt has only the poses of
the frames of SEQUENCE. A run on the result shows whether a map keeps its objects while they are not
seen. With --again the whole SEQUENCE comes twice, with the N frames in between. This shows whether
tracking finds its map again.

SEQUENCE is a folder in TUM's format with PNG images, such as one of make_synthetic. Its masks
(format yolo-seg) are used too. Frames in between have the masks of --other, or none. OUT gets links
to the files of SEQUENCE, so SEQUENCE must not be moved. OUT must not exist, or be an empty folder.

Exit codes: 0 done, 2 bad usage or input.
"""

import pathlib
import sys

from support import exit_code, InputError, parser_of, require
from tum_and_icl import link, read_rows

require("numpy", "PIL")
import numpy as np  # noqa: E402
import PIL.Image  # noqa: E402


KINDS = ("rgb", "depth")


def images_of(sequence):
    """For each kind (stamp, image, masks) of the images in its list; the masks may not exist."""
    return {kind: [(stamp, sequence / words[0], sequence / "masks" / f"{pathlib.PurePath(words[0]).stem}.txt")
                   for stamp, words in read_rows(sequence / f"{kind}.txt")] for kind in KINDS}


def blank_images(stamps, like, out):
    """Blank images of the size of an image."""
    try:
        with PIL.Image.open(like) as image:
            size = image.size
    except PIL.UnidentifiedImageError as error:
        raise InputError(f"{like}: not a PNG image") from error
    for kind, mode, colour in ("rgb", "RGB", (128, 128, 128)), ("depth", "I;16", 0):
        PIL.Image.new(mode, size, colour).save(out / f"blank_{kind}.png")
    return {kind: [(stamp, out / f"blank_{kind}.png", None) for stamp in stamps] for kind in KINDS}


def images_of_other(stamps, images):
    """The first images of another sequence, with the given stamps."""
    times = np.array([stamp for stamp, *_ in images["depth"]])
    found = {kind: [] for kind in KINDS}
    for new, (stamp, *files) in zip(stamps, images["rgb"]):
        found["rgb"].append((new, *files))
        nearest = int(np.argmin(np.abs(times - stamp)))
        if abs(times[nearest] - stamp) < 0.02:
            found["depth"].append((new, *images["depth"][nearest][1:]))
    return found


def write_images(out, images):
    """Writes links to the images (kind -> [(stamp, image, masks)]), their masks and their lists."""
    for kind, rows in images.items():
        lines = ["# timestamp filename\n"]
        for stamp, image, masks in rows:
            name = f"{kind}/{stamp:.6f}.png"
            link(image, out / name)
            lines.append(f"{stamp:.6f} {name}\n")
            target = out / "masks" / f"{stamp:.6f}.txt"
            if kind == "rgb" and masks is not None and masks.exists():
                link(masks, target)
            elif kind == "rgb":
                target.write_text("")
        (out / f"{kind}.txt").write_text("".join(lines))


class Part:
    """The frames from one stamp up to, but not including, another one. Their stamps are shifted."""

    def __init__(self, begin, end, shift):
        self.begin, self.end, self.shift = begin, end, shift

    def rows(self, rows):
        return [row for row in rows if self.begin <= row[0] < self.end]

    def images(self, images):
        """(stamp, image, masks) of the part, with the new stamps."""
        return [(stamp + self.shift, *files) for stamp, *files in self.rows(images)]


def split(arguments, stamps, interval):
    """The parts of the sequence before and after the frames in between."""
    gap = arguments.blank * interval
    # Stamps of depth and ground truth differ from those of the images by up to half an interval.
    first, last = stamps[0] - interval / 2, stamps[-1] + interval / 2
    if arguments.again:
        return Part(-np.inf, np.inf, 0.0), Part(-np.inf, np.inf, last - first + gap)
    at = len(stamps) // 2 if arguments.at is None else arguments.at
    if not 2 <= at <= len(stamps) - 1:
        raise InputError(f"--at is {at}, expected 2 to {len(stamps) - 1}")
    leave = (stamps[at - 1] + stamps[at]) / 2
    return Part(-np.inf, leave, 0.0), Part(leave, np.inf, gap)


def write_groundtruth(sequence, out, parts, between, interval):
    """Writes groundtruth.txt without poses near the frames in between, which they would be paired with."""
    lines = []
    for part in parts:
        for stamp, words in part.rows(read_rows(sequence / "groundtruth.txt")):
            new = stamp + part.shift
            if new < between[0] - 0.75 * interval or new > between[-1] + 0.75 * interval:
                lines.append(f"{new:.6f} {' '.join(words)}\n")
    (out / "groundtruth.txt").write_text("".join(lines))


def make(arguments):
    sequence, out, count = arguments.sequence, arguments.out, arguments.blank
    images = images_of(sequence)
    stamps = np.array([stamp for stamp, *_ in images["rgb"]])
    interval = float(np.median(np.diff(stamps)))
    if not interval > 0.0:
        raise InputError(f"{sequence / 'rgb.txt'}: the time stamps do not increase")
    parts = before, after = split(arguments, stamps, interval)
    if out.exists() and any(out.iterdir()):
        raise InputError(f"{out}: is not empty")
    other = arguments.other and images_of(arguments.other)
    if other and len(other["rgb"]) < count:
        raise InputError(f"{arguments.other}: has fewer than {count} frames")
    for name in (*KINDS, "masks"):
        (out / name).mkdir(parents=True)
    first, last = before.images(images["rgb"]), after.images(images["rgb"])
    between = first[-1][0] + interval * np.arange(1, count + 1)
    filling = images_of_other(between, other) if other else blank_images(between, images["rgb"][0][1], out)
    write_images(out, {kind: [*before.images(rows), *filling[kind], *after.images(rows)]
                       for kind, rows in images.items()})
    for name in ("camera.yaml", "groundtruth_objects.json"):
        if (sequence / name).exists():
            link(sequence / name, out / name)
    if (sequence / "groundtruth.txt").exists():
        write_groundtruth(sequence, out, parts, between, interval)
    print(f"{out}: {len(first)} frames, {count} of something else, {len(last)} frames")


def main(words=None):
    parser = parser_of(__doc__)
    parser.add_argument("sequence", type=pathlib.Path, metavar="SEQUENCE")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    parser.add_argument("--blank", type=int, default=200, metavar="N",
                        help="number of frames in between (default 200)")
    parser.add_argument("--other", type=pathlib.Path, metavar="SEQUENCE",
                        help="sequence whose first frames come in between (default: blank images)")
    parser.add_argument("--at", type=int, metavar="FRAME",
                        help="index of the first frame after the return (default: the middle)")
    parser.add_argument("--again", action="store_true",
                        help="the whole SEQUENCE, the frames in between, the whole SEQUENCE again")
    arguments = parser.parse_args(words)
    if arguments.again and arguments.at is not None:
        parser.error("--again and --at exclude each other")
    if arguments.blank < 1:
        parser.error("--blank must be 1 or more")
    return exit_code(make, arguments, failure=2)


if __name__ == "__main__":
    sys.exit(main())
