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


class Writer:
    """Adds frames to the new sequence."""

    def __init__(self, out):
        self.out, self.lists = out, {"rgb": [], "depth": []}
        for name in ("rgb", "depth", "masks"):
            (out / name).mkdir(parents=True)

    def add_image(self, kind, stamp, source):
        name = f"{kind}/{stamp:.6f}.png"
        link(source, self.out / name)
        self.lists[kind].append(f"{stamp:.6f} {name}\n")

    def add_masks(self, stamp, source):
        """Without a source, or if it does not exist, the frame has no masks."""
        target = self.out / "masks" / f"{stamp:.6f}.txt"
        if source is not None and source.exists():
            link(source, target)
        else:
            target.write_text("")

    def add_frames(self, sequence, rows, depth, shift):
        """`rows` are those of rgb.txt, `depth` those of depth.txt."""
        for stamp, words in depth:
            self.add_image("depth", stamp + shift, sequence / words[0])
        for stamp, words in rows:
            self.add_image("rgb", stamp + shift, sequence / words[0])
            self.add_masks(stamp + shift,
                           sequence / "masks" / (pathlib.PurePath(words[0]).stem + ".txt"))

    def finish(self):
        for kind, lines in self.lists.items():
            (self.out / f"{kind}.txt").write_text("# timestamp filename\n" + "".join(lines))


def size_of_image(path):
    try:
        with PIL.Image.open(path) as image:
            return image.size
    except PIL.UnidentifiedImageError as error:
        raise InputError(f"{path}: not a PNG image") from error


def add_blank_frames(writer, stamps, size):
    PIL.Image.new("RGB", size, (128, 128, 128)).save(writer.out / "blank_rgb.png")
    PIL.Image.new("I;16", size, 0).save(writer.out / "blank_depth.png")
    for stamp in stamps:
        writer.add_image("rgb", stamp, writer.out / "blank_rgb.png")
        writer.add_image("depth", stamp, writer.out / "blank_depth.png")
        writer.add_masks(stamp, None)


def add_other_frames(writer, stamps, other):
    """The first frames of another sequence with the given stamps."""
    rows, depth = read_rows(other / "rgb.txt"), read_rows(other / "depth.txt")
    times = np.array([stamp for stamp, _ in depth])
    for new, (stamp, words) in zip(stamps, rows):
        writer.add_frames(other, [(stamp, words)], [], new - stamp)
        nearest = int(np.argmin(np.abs(times - stamp)))
        if abs(times[nearest] - stamp) < 0.02:
            writer.add_image("depth", new, other / depth[nearest][1][0])


class Part:
    """The frames from one stamp up to, but not including, another one. Their stamps are shifted."""

    def __init__(self, begin, end, shift):
        self.begin, self.end, self.shift = begin, end, shift

    def rows(self, rows):
        return [row for row in rows if self.begin <= row[0] < self.end]


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
    rows, depth = read_rows(sequence / "rgb.txt"), read_rows(sequence / "depth.txt")
    stamps = np.array([stamp for stamp, _ in rows])
    interval = float(np.median(np.diff(stamps)))
    if not interval > 0.0:
        raise InputError(f"{sequence / 'rgb.txt'}: the time stamps do not increase")
    parts = before, after = split(arguments, stamps, interval)
    if out.exists() and any(out.iterdir()):
        raise InputError(f"{out}: is not empty")
    if arguments.other and len(read_rows(arguments.other / "rgb.txt")) < count:
        raise InputError(f"{arguments.other}: has fewer than {count} frames")
    writer = Writer(out)
    writer.add_frames(sequence, before.rows(rows), before.rows(depth), 0.0)
    between = before.rows(rows)[-1][0] + interval * np.arange(1, count + 1)
    if arguments.other:
        add_other_frames(writer, between, arguments.other)
    else:
        add_blank_frames(writer, between, size_of_image(sequence / rows[0][1][0]))
    writer.add_frames(sequence, after.rows(rows), after.rows(depth), after.shift)
    writer.finish()
    for name in ("camera.yaml", "groundtruth_objects.json"):
        if (sequence / name).exists():
            link(sequence / name, out / name)
    if (sequence / "groundtruth.txt").exists():
        write_groundtruth(sequence, out, parts, between, interval)
    print(f"{out}: {len(before.rows(rows))} frames, {count} of something else, "
          f"{len(after.rows(rows))} frames")


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
