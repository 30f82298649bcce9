#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a sequence with disturbances from a sequence in the format of TUM or ICL-NUIM.

IN has the lists of its format, and may have ground truth and a folder of masks in the format
yolo-seg. OUT gets the same, with the chosen disturbances. Several can be combined. Stamps and lists
change first, in the order of this help, then the images, the depth and the masks. The same --seed
gives the same files. Unchanged files are linked, so IN must stay where it is. OUT must not exist,
or be an empty folder. If something fails, OUT is not written.

Depth images are paired with colour images before anything changes, and in OUT they have the stamps
of their colour images. If stamps or images are wrong, groundtruth.txt of OUT has for each image the
true pose of the moment at which it was taken, under its new stamp, so the error of a run is that of
its poses and not that of the stamps. groundtruth_in.txt is then the file of IN, in true time.

The images of ICL-NUIM (rgb/N.png and associations.txt) have numbers instead of stamps. They can be
missing, but stamps cannot be wrong.

Exit codes: 0 done, 2 bad usage or input.
"""

import pathlib
import shutil
import sys
import tempfile
import zlib

from support import exit_code, InputError, number, parser_of, read_trajectory, require

require("numpy")
import numpy as np  # noqa: E402

from disturbances import DISTURBANCES  # noqa: E402
from tum_and_icl import (check_empty, is_icl, link, link_descriptions, read_frames, write_icl,  # noqa: E402
                         write_tum)
from yolo_masks import mask_files, print_masks, read_masks  # noqa: E402


class Degrader:
    """Writes the files of a degraded sequence into a folder."""

    def __init__(self, arguments, out):
        self.sequence, self.out, self.seed = arguments.sequence, out, arguments.seed
        self.masks = None if arguments.no_masks else arguments.masks or self.sequence / "masks"
        amounts = [(row, getattr(arguments, row.name.replace("-", "_"))) for row in DISTURBANCES]
        self.chosen = [(row, amount) for row, amount in amounts if amount not in (None, False)]
        self.frames = read_frames(self.sequence)

    def random(self, name, index=0):
        """Random numbers that other disturbances and frames do not change."""
        return np.random.default_rng([self.seed, zlib.crc32(name.encode()), index])

    def chosen_for(self, target):
        return [(row.name, row.changes[target], amount) for row, amount in self.chosen
                if target in row.changes]

    def change_frames(self):
        interval = float(np.median(np.diff([frame.stamp for frame in self.frames]))) \
            if len(self.frames) > 1 else 0.0
        for name, change, amount in self.chosen_for("frames"):
            amount = interval if name == "even" else amount
            self.frames = change(self.frames, amount, self.random(name))
        stamps = [round(frame.stamp, 6) for frame in self.frames]
        if len(stamps) < 2 or any(b <= a for a, b in zip(stamps, stamps[1:])):
            raise InputError("with these disturbances there would be fewer than two images, or the "
                             "time stamps would not increase")

    def name(self, kind, path):
        changed = self.chosen_for("image" if kind == "rgb" else kind)
        return path.stem + ".png" if changed else path.name

    def write_images(self, kind, target):
        """Each image once, although several frames may show it."""
        changes = self.chosen_for(target)
        paths = dict.fromkeys(getattr(frame, "image" if kind == "rgb" else kind) for frame in self.frames)
        paths.pop(None, None)
        if paths:
            (self.out / kind).mkdir()
        for index, path in enumerate(paths):
            if changes:
                self.write_image(path, index, changes, self.out / kind / self.name(kind, path))
            else:
                link(path, self.out / kind / path.name)

    def write_image(self, path, index, changes, target):
        import cv2
        image = read_image(path, target.parent.name)
        for name, change, amount in changes:
            image = change(image, amount, self.random(name, index), index)
        if not cv2.imwrite(str(target), image):
            raise InputError(f"{target.name}: cannot be written; is the disk full?")

    def write_masks(self):
        target = self.out / "masks"
        target.mkdir()
        files = mask_files(self.masks, list(dict.fromkeys(frame.image.stem for frame in self.frames)))
        if (self.masks / "classes.txt").exists():
            link(self.masks / "classes.txt", target / "classes.txt")
        masks = {stem: read_masks(path) for stem, path in files.items()}
        classes = sorted({number for of_image in masks.values() for number, _, _ in of_image})
        sources = {stem: stem for stem in files}
        for name, change, amount in self.chosen_for("mask files"):
            sources = change(list(files), amount, self.random(name))
        changes, size = self.chosen_for("masks"), None
        if any(name == "mask-shift" for name, _, _ in changes):
            size = np.array(read_image(self.frames[0].image, "rgb").shape[1::-1], dtype=float)
        for index, (stem, source) in enumerate(sources.items()):
            if not changes:
                link(files[source], target / f"{stem}.txt")
                continue
            of_image = masks[source]
            for name, change, amount in changes:
                of_image = change(of_image, amount, self.random(name, index), classes, size)
            (target / f"{stem}.txt").write_text(print_masks(of_image), encoding="utf-8")

    def write_groundtruth(self):
        for path in self.sequence.glob("*.gt.freiburg"):
            link(path, self.out / path.name)
        source = self.sequence / "groundtruth.txt"
        if not source.exists():
            return
        if all(frame.stamp == frame.taken for frame in self.frames):
            link(source, self.out / "groundtruth.txt")
            return
        link(source, self.out / "groundtruth_in.txt")
        stamps, poses = read_trajectory(source)
        lines = ["# timestamp tx ty tz qx qy qz qw of each image, under its new stamp\n"]
        for frame in self.frames:
            if (pose := interpolate(stamps, poses, frame.taken)) is not None:
                lines.append(" ".join(f"{value:.6f}" for value in (frame.stamp, *pose)) + "\n")
        (self.out / "groundtruth.txt").write_text("".join(lines), encoding="utf-8")

    def run(self):
        self.change_frames()
        if self.masks is not None and self.masks.is_dir():
            self.write_masks()
        elif needing := [row.name for row, _ in self.chosen if set(row.changes) <= {"masks", "mask files"}]:
            raise InputError(f"--{needing[0]} needs masks, and {self.sequence} has no folder masks; "
                             "--masks says where they are")
        (write_icl if is_icl(self.sequence) else write_tum)(self.out, self.frames, self.name)
        self.write_images("rgb", "image")
        self.write_images("depth", "depth")
        self.write_groundtruth()
        link_descriptions(self.sequence, self.out)


def read_image(path, kind):
    """A colour image as 8-bit BGR, or a depth image with 16 bits."""
    import cv2
    is_depth = kind == "depth"
    image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED if is_depth else cv2.IMREAD_COLOR)
    if image is None:
        raise InputError(f"{path}: is no image that can be read")
    if is_depth and (image.dtype != np.uint16 or image.ndim != 2):
        raise InputError(f"{path}: expected a depth image with one channel of 16 bits")
    return image


def interpolate(stamps, poses, time):
    """The pose (x y z qx qy qz qw) at a time; None before the first pose and after the last one."""
    after = int(np.searchsorted(stamps, time))
    if after < len(stamps) and stamps[after] == time:
        return poses[after]
    if not 0 < after < len(stamps):
        return None
    share = (time - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
    first, second = poses[after - 1].copy(), poses[after].copy()
    if first[3:] @ second[3:] < 0.0:
        second[3:] *= -1.0
    pose = (1.0 - share) * first + share * second
    pose[3:] /= np.linalg.norm(pose[3:])
    return pose


def degrade(arguments):
    """Writes OUT as a whole."""
    out = arguments.out.resolve()
    check_empty(out)
    out.parent.mkdir(parents=True, exist_ok=True)
    staging = pathlib.Path(tempfile.mkdtemp(prefix=f"{out.name}.partial-", dir=out.parent))
    try:
        content = staging / "content"
        content.mkdir()
        degrader = Degrader(arguments, content)
        degrader.run()
        content.rename(out)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    print(f"{arguments.out}: {len(degrader.frames)} images")


def parse(words):
    parser = parser_of(__doc__)
    parser.add_argument("sequence", type=pathlib.Path, metavar="IN")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    masks = parser.add_mutually_exclusive_group()
    masks.add_argument("--masks", type=pathlib.Path, metavar="FOLDER",
                       help="masks of IN, format yolo-seg (default: its folder masks, if any)")
    masks.add_argument("--no-masks", action="store_true", help="OUT gets no masks")
    parser.add_argument("--seed", type=number(0, kind=int), default=0,
                        help="of all random choices (default 0)")
    for row in DISTURBANCES:
        amount = {"type": row.type, "metavar": row.metavar} if row.type else {"action": "store_true"}
        parser.add_argument(f"--{row.name}", help=row.help, **amount)
    arguments = parser.parse_args(words)
    if arguments.masks and not arguments.masks.is_dir():
        parser.error(f"--masks: {arguments.masks} is no folder, expected masks in the format "
                     "yolo-seg, one text file per image")
    return arguments


def main(words=None):
    try:
        return exit_code(degrade, parse(words), failure=2)
    except (ImportError, ValueError) as error:
        told = "changed images need OpenCV for Python (Debian: python3-opencv)" \
            if isinstance(error, ImportError) else error
        print(f"error: {told}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
