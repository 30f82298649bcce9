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

from support import exit_code, InputError, number, parser_of, require

require("numpy", "PIL")
import numpy as np  # noqa: E402
import PIL.Image  # noqa: E402

from tum_and_icl import (check_empty, link, link_descriptions, pair, read_rows, stamps_of,  # noqa: E402
                         write_images)

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
    first = images["rgb"][:len(stamps)]
    return {"rgb": [(new, *files) for new, (_, *files) in zip(stamps, first)],
            "depth": [(stamps[i], *images["depth"][j][1:])
                      for i, j in pair(stamps_of(first), stamps_of(images["depth"]))]}


def link_images(out, images):
    """Writes links to the images (kind -> [(stamp, image, masks)]), their masks and their lists."""
    for kind, rows in images.items():
        for stamp, image, masks in rows:
            link(image, out / kind / f"{stamp:.6f}.png")
            target = out / "masks" / f"{stamp:.6f}.txt"
            if kind == "rgb" and masks is not None and masks.exists():
                link(masks, target)
            elif kind == "rgb":
                target.write_text("")
        write_images(out / f"{kind}.txt", [(stamp, f"{kind}/{stamp:.6f}.png") for stamp, *_ in rows])


def part_of(rows, begin, end, shift):
    """The rows (stamp, ...) from one stamp up to, but not including, another one, with shifted stamps."""
    return [(stamp + shift, *others) for stamp, *others in rows if begin <= stamp < end]


def split(arguments, stamps, interval):
    """The parts (begin, end, shift) of the sequence before and after the frames in between."""
    gap = arguments.blank * interval
    if arguments.again:
        return (-np.inf, np.inf, 0.0), (-np.inf, np.inf, stamps[-1] - stamps[0] + interval + gap)
    at = len(stamps) // 2 if arguments.at is None else arguments.at
    if not 2 <= at <= len(stamps) - 1:
        raise InputError(f"--at is {at}, expected 2 to {len(stamps) - 1}")
    # Stamps of depth and ground truth differ from those of the images by up to half an interval.
    leave = (stamps[at - 1] + stamps[at]) / 2
    return (-np.inf, leave, 0.0), (leave, np.inf, gap)


def write_groundtruth(sequence, out, parts, between, interval):
    """Writes groundtruth.txt without poses near the frames in between, which they would be paired with."""
    rows = read_rows(sequence / "groundtruth.txt")
    first, last = between[0] - 0.75 * interval, between[-1] + 0.75 * interval
    (out / "groundtruth.txt").write_text("".join(
        f"{stamp:.6f} {' '.join(words)}\n" for part in parts for stamp, words in part_of(rows, *part)
        if not first <= stamp <= last))


def make(arguments):
    sequence, out, count = arguments.sequence, arguments.out, arguments.blank
    images = images_of(sequence)
    stamps = stamps_of(images["rgb"])
    interval = float(np.median(np.diff(stamps)))
    if not interval > 0.0:
        raise InputError(f"{sequence / 'rgb.txt'}: the time stamps do not increase")
    parts = before, after = split(arguments, stamps, interval)
    check_empty(out)
    other = arguments.other and images_of(arguments.other)
    if other and len(other["rgb"]) < count:
        raise InputError(f"{arguments.other}: has fewer than {count} frames")
    for name in (*KINDS, "masks"):
        (out / name).mkdir(parents=True)
    first, last = part_of(images["rgb"], *before), part_of(images["rgb"], *after)
    between = first[-1][0] + interval * np.arange(1, count + 1)
    filling = images_of_other(between, other) if other else blank_images(between, images["rgb"][0][1], out)
    link_images(out, {kind: [*part_of(rows, *before), *filling[kind], *part_of(rows, *after)]
                      for kind, rows in images.items()})
    link_descriptions(sequence, out)
    if (sequence / "groundtruth.txt").exists():
        write_groundtruth(sequence, out, parts, between, interval)
    print(f"{out}: {len(first)} frames, {count} of something else, {len(last)} frames")


def main(words=None):
    parser = parser_of(__doc__)
    parser.add_argument("sequence", type=pathlib.Path, metavar="SEQUENCE")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    parser.add_argument("--blank", type=number(1, kind=int), default=200, metavar="N",
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
    return exit_code(make, arguments, failure=2)


if __name__ == "__main__":
    sys.exit(main())
