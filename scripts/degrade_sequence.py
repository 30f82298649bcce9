#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a sequence with disturbances from a sequence in TUM's format.

IN has rgb.txt and may have depth.txt, groundtruth.txt and a folder of masks. OUT gets the same,
with the chosen disturbances. Several can be combined. Stamps and lists change first, in the order
of this help, then the images, the depth and the masks. The same --seed gives the same files.
Unchanged files are linked, so IN must stay where it is. OUT must not exist, or be an empty folder.

Depth images are paired with colour images before anything changes, and in OUT they have the stamps
of their colour images. If stamps or images are wrong, groundtruth.txt of OUT has for each image the
true pose of the moment at which it was taken, under its new stamp, so the error of a run is that of
its poses and not that of the stamps. groundtruth_in.txt is then the file of IN, in true time.

Exit codes: 0 done, 2 bad usage or input.
"""

import argparse
import dataclasses
import pathlib
import sys
import zlib

import numpy as np

from leave_and_return import link, read_rows
from run_files import InputError, read_trajectory

MAX_DIFFERENCE = 0.02  # s, between an image and its depth, as in TUM's associate.py
MIN_STEP = 1e-4  # s, from one late stamp to the next
BRIGHTNESS_PERIOD = 30  # images with the same brightness
HOLE = 32  # px, side of a hole in a depth image


@dataclasses.dataclass
class Frame:
    stamp: float  # s, the one that is written
    taken: float  # s, when the image was really taken
    image: pathlib.Path
    depth: pathlib.Path = None


# ---- stamps and lists: functions (frames, amount, random numbers) -> frames


def early(frames, milliseconds, _):
    for frame, following in zip(frames[::2], frames[1::2]):
        frame.stamp = following.stamp - milliseconds / 1e3
    return frames


def pairs(frames, milliseconds, _):
    for frame, following in zip(frames[::2], frames[1::2]):
        following.stamp = frame.stamp + milliseconds / 1e3
    return frames


def late(frames, milliseconds, rng):
    last = -np.inf
    for frame, delay in zip(frames, np.abs(rng.normal(0.0, milliseconds / 1e3, len(frames)))):
        frame.stamp = last = max(frame.stamp + delay, last + MIN_STEP)
    return frames


def missing(frames, share, _):
    count, period = share
    return [frame for i, frame in enumerate(frames) if i % period < period - count]


def stall(frames, share, _):
    count, period = share
    for i, frame in enumerate(frames):
        over = i % period - (period - count)
        if over > 0:
            shown = frames[i - over]
            frame.taken, frame.image, frame.depth = shown.taken, shown.image, shown.depth
    return frames


def even(frames, interval, _):
    for i, frame in enumerate(frames):
        frame.stamp = frames[0].stamp + i * interval
    return frames


# ---- images and depth: functions (image, amount, random numbers, index of the frame) -> image


def blur(image, sigma, *_):
    import cv2
    return cv2.GaussianBlur(image, (0, 0), sigma)


def brightness(image, factor, _, index):
    changed = index // BRIGHTNESS_PERIOD % 2 == 1
    return np.clip(image * factor, 0, 255).astype(np.uint8) if changed else image


def noise(image, sigma, rng, _):
    return np.clip(image + rng.normal(0.0, sigma, image.shape), 0, 255).astype(np.uint8)


def depth_holes(depth, share, rng, _):
    depth = depth.copy()
    for y in range(0, depth.shape[0], HOLE):
        for x in range(0, depth.shape[1], HOLE):
            if rng.random() < share:
                depth[y:y + HOLE, x:x + HOLE] = 0
    return depth


def turn(image, degrees, *_):
    return np.rot90(image, degrees // 90).copy()


# ---- masks: functions (masks, amount, random numbers, classes of the sequence, size) -> masks
# A mask is its class, its outline as shares of the image's size (n x 2), and its score or nothing.


def mask_shift(masks, pixels, rng, _, size):
    def moved(outline):
        angle = rng.uniform(0.0, 2.0 * np.pi)
        return np.clip(outline + pixels * np.array([np.cos(angle), np.sin(angle)]) / size, 0, 1)
    return [(number, moved(outline), score) for number, outline, score in masks]


def mask_drop(masks, share, rng, *_):
    return [mask for mask in masks if rng.random() >= share]


def mask_confuse(masks, share, rng, classes, _):
    def confused(number):
        others = [other for other in classes if other != number]
        return str(rng.choice(others)) if others and rng.random() < share else number
    return [(confused(number), outline, score) for number, outline, score in masks]


def turn_masks(masks, degrees, *_):
    for _ in range(degrees // 90):
        masks = [(number, np.stack([outline[:, 1], 1.0 - outline[:, 0]], axis=1), score)
                 for number, outline, score in masks]
    return masks


# ---- the table of disturbances


def number_in(low, high):
    def parse(text):
        value = float(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"'{text}' is not a number from {low} to {high}")
        return value
    return parse


def share_of_images(text):
    count, period = (int(word) for word in text.split("/"))
    if not 0 < count < period:
        raise argparse.ArgumentTypeError(f"'{text}' is not N/M with 0 < N < M")
    return count, period


def right_angle(text):
    if text not in ("90", "180", "270"):
        raise argparse.ArgumentTypeError(f"'{text}' is not 90, 180 or 270")
    return int(text)


@dataclasses.dataclass
class Disturbance:
    name: str
    type: object  # reads the amount
    metavar: str
    help: str
    changes: dict  # what it changes (frames, image, depth, masks) -> function


MILLISECONDS, SHARE = number_in(0.0, 1e4), number_in(0.0, 1.0)
DISTURBANCES = [
    Disturbance("missing", share_of_images, "N/M", "the last N of every M images are missing",
                {"frames": missing}),
    Disturbance("stall", share_of_images, "N/M",
                "the last N of every M images show the first one of these N", {"frames": stall}),
    Disturbance("even", None, "", "stamps are even, as if no image were missing", {"frames": even}),
    Disturbance("early", MILLISECONDS, "MS",
                "of two images, the first one has a stamp MS ms before that of the second one",
                {"frames": early}),
    Disturbance("pairs", MILLISECONDS, "MS",
                "of two images, the second one has a stamp MS ms after that of the first one",
                {"frames": pairs}),
    Disturbance("late", MILLISECONDS, "MS",
                "each stamp is late by |N(0, MS ms)|, but never before the stamp before it",
                {"frames": late}),
    Disturbance("blur", number_in(0.1, 100.0), "PX", "images are blurred by a Gaussian of PX px",
                {"image": blur}),
    Disturbance("brightness", number_in(0.0, 10.0), "FACTOR",
                f"images {BRIGHTNESS_PERIOD} to {2 * BRIGHTNESS_PERIOD - 1} are brighter by this "
                "factor, and so on in turn", {"image": brightness}),
    Disturbance("noise", number_in(0.0, 255.0), "LEVELS",
                "noise of so many grey levels is added to images", {"image": noise}),
    Disturbance("depth-holes", SHARE, "SHARE", f"this share of the squares of {HOLE} px of a depth "
                "image has no depth", {"depth": depth_holes}),
    Disturbance("turn", right_angle, "DEGREES", "images, depth and masks are turned by 90, 180 or "
                "270 degrees counterclockwise; the settings of the camera must then be others",
                {"image": turn, "depth": turn, "masks": turn_masks}),
    Disturbance("mask-shift", number_in(0.0, 1e4), "PX",
                "each mask is moved by PX px in a random direction", {"masks": mask_shift}),
    Disturbance("mask-drop", SHARE, "SHARE", "this share of the masks is missing",
                {"masks": mask_drop}),
    Disturbance("mask-confuse", SHARE, "SHARE",
                "this share of the masks has another class of the sequence",
                {"masks": mask_confuse}),
    Disturbance("mask-swap", SHARE, "SHARE",
                "this share of the images has the masks of the next image, which has theirs",
                {"mask files": None}),
]


# ---- files


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


def read_frames(sequence):
    rows = read_rows(sequence / "rgb.txt")
    frames = [Frame(stamp, stamp, sequence / words[0]) for stamp, words in rows]
    if any(b.stamp <= a.stamp for a, b in zip(frames, frames[1:])):
        raise InputError(f"{sequence / 'rgb.txt'}: the time stamps do not increase")
    if (sequence / "depth.txt").exists():
        depth = read_rows(sequence / "depth.txt")
        chosen = pair_depth([frame.stamp for frame in frames], [stamp for stamp, _ in depth])
        for i, j in chosen.items():
            frames[i].depth = sequence / depth[j][1][0]
    return frames


def read_masks(path):
    masks = []
    for count, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        try:
            values = np.array(words[1:], dtype=float)
        except ValueError as error:
            raise InputError(f"{path}:{count}: expected a class and numbers") from error
        if len(values) < 6:
            raise InputError(f"{path}:{count}: expected an outline of three points or more")
        outline = values[:len(values) // 2 * 2].reshape(-1, 2)
        masks.append((words[0], outline, values[-1] if len(values) % 2 else None))
    return masks


def print_masks(masks):
    lines = []
    for number, outline, score in masks:
        numbers = [*outline.flat, *([] if score is None else [score])]
        lines.append(f"{number} " + " ".join(f"{value:.9g}" for value in numbers) + "\n")
    return "".join(lines)


class Degrader:
    def __init__(self, arguments):
        self.sequence, self.out, self.seed = arguments.sequence, arguments.out, arguments.seed
        self.masks = arguments.masks or self.sequence / "masks"
        self.chosen = []
        for row in DISTURBANCES:
            amount = getattr(arguments, row.name.replace("-", "_"))
            if amount is not None and amount is not False:
                self.chosen.append((row, amount))
        self.frames = read_frames(self.sequence)

    def random(self, name, index=0):
        """Random numbers that other disturbances and frames do not change."""
        return np.random.default_rng([self.seed, zlib.crc32(name.encode()), index])

    def chosen_for(self, target):
        return [(row.name, row.changes[target], amount) for row, amount in self.chosen
                if target in row.changes]

    def change_frames(self):
        interval = float(np.median(np.diff([frame.stamp for frame in self.frames])))
        for name, change, amount in self.chosen_for("frames"):
            amount = interval if name == "even" else amount
            self.frames = change(self.frames, amount, self.random(name))
        stamps = [round(frame.stamp, 6) for frame in self.frames]
        if len(stamps) < 2 or any(b <= a for a, b in zip(stamps, stamps[1:])):
            raise InputError("with these disturbances the time stamps would not increase")

    def write_lists(self):
        lists = {"rgb": [], "depth": []}
        for frame in self.frames:
            for kind, path in (("rgb", frame.image), ("depth", frame.depth)):
                if path is not None:
                    lists[kind].append(f"{frame.stamp:.6f} {kind}/{self.name(kind, path)}\n")
        for kind, lines in lists.items():
            if lines:
                (self.out / f"{kind}.txt").write_text("# timestamp filename\n" + "".join(lines))

    def name(self, kind, path):
        changed = self.chosen_for("image" if kind == "rgb" else kind)
        return path.stem + ".png" if changed else path.name

    def write_images(self, kind, target):
        """Each image once, although several frames may show it."""
        changes = self.chosen_for(target)
        paths = [frame.image if kind == "rgb" else frame.depth for frame in self.frames]
        paths = list(dict.fromkeys(path for path in paths if path is not None))
        if paths:
            (self.out / kind).mkdir()
        for index, path in enumerate(paths):
            if changes:
                self.write_image(path, index, changes, self.out / kind / self.name(kind, path))
            else:
                link(path, self.out / kind / path.name)

    def write_image(self, path, index, changes, target):
        import cv2
        flags = cv2.IMREAD_UNCHANGED if target.parent.name == "depth" else cv2.IMREAD_COLOR
        image = cv2.imread(str(path), flags)
        if image is None:
            raise InputError(f"{path}: is no image that can be read")
        for name, change, amount in changes:
            image = change(image, amount, self.random(name, index), index)
        if not cv2.imwrite(str(target), image):
            raise InputError(f"{target}: cannot be written")

    def image_size(self):
        import cv2
        image = cv2.imread(str(self.frames[0].image))
        if image is None:
            raise InputError(f"{self.frames[0].image}: is no image that can be read")
        return np.array(image.shape[1::-1], dtype=float)

    def write_masks(self):
        target = self.out / "masks"
        target.mkdir()
        if (self.masks / "classes.txt").exists():
            link(self.masks / "classes.txt", target / "classes.txt")
        stems = list(dict.fromkeys(frame.image.stem for frame in self.frames))
        files = {stem: self.masks / f"{stem}.txt" for stem in stems
                 if (self.masks / f"{stem}.txt").exists()}
        sources = self.swap_masks(stems, files)
        changes = self.chosen_for("masks")
        if not changes:
            for stem, source in sources.items():
                link(source, target / f"{stem}.txt")
            return
        masks = {stem: read_masks(source) for stem, source in sources.items()}
        classes = sorted({number for of_image in masks.values() for number, _, _ in of_image})
        size = self.image_size() if any(name == "mask-shift" for name, _, _ in changes) else None
        for index, (stem, of_image) in enumerate(masks.items()):
            for name, change, amount in changes:
                of_image = change(of_image, amount, self.random(name, index), classes, size)
            (target / f"{stem}.txt").write_text(print_masks(of_image))

    def swap_masks(self, stems, files):
        """The file of the masks of each image."""
        sources = dict(files)
        for _, _, share in self.chosen_for("mask files"):
            with_masks = [stem for stem in stems if stem in files]
            rng = self.random("mask-swap")
            for a, b in zip(with_masks[::2], with_masks[1::2]):
                if rng.random() < share:
                    sources[a], sources[b] = files[b], files[a]
        return sources

    def write_groundtruth(self):
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
            pose = interpolate(np.asarray(stamps), np.asarray(poses), frame.taken)
            if pose is not None:
                numbers = " ".join(f"{value:.6f}" for value in pose)
                lines.append(f"{frame.stamp:.6f} {numbers}\n")
        (self.out / "groundtruth.txt").write_text("".join(lines))

    def run(self):
        if self.out.exists() and any(self.out.iterdir()):
            raise InputError(f"{self.out}: is not empty")
        self.change_frames()
        self.out.mkdir(parents=True, exist_ok=True)
        self.write_images("rgb", "image")
        self.write_images("depth", "depth")
        self.write_lists()
        if self.masks.is_dir():
            self.write_masks()
        self.write_groundtruth()
        for name in ("camera.yaml", "groundtruth_objects.json"):
            if (self.sequence / name).exists():
                link(self.sequence / name, self.out / name)


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


def parse(words):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", type=pathlib.Path, metavar="IN")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    parser.add_argument("--masks", type=pathlib.Path, metavar="FOLDER",
                        help="masks of IN, format yolo-seg (default: its folder masks, if any)")
    parser.add_argument("--seed", type=int, default=0, help="of all random choices (default 0)")
    for row in DISTURBANCES:
        if row.type is None:
            parser.add_argument(f"--{row.name}", action="store_true", help=row.help)
        else:
            parser.add_argument(f"--{row.name}", type=row.type, metavar=row.metavar, help=row.help)
    arguments = parser.parse_args(words)
    if arguments.seed < 0:
        parser.error("--seed must be 0 or more")
    if arguments.masks and not arguments.masks.is_dir():
        parser.error(f"--masks: {arguments.masks} is no folder")
    return arguments


def main(words=None):
    arguments = parse(words)
    try:
        degrader = Degrader(arguments)
        degrader.run()
    except ImportError:
        print("error: changed images need OpenCV for Python (Debian: python3-opencv)",
              file=sys.stderr)
        return 2
    except (InputError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"{arguments.out}: {len(degrader.frames)} images")
    return 0


if __name__ == "__main__":
    sys.exit(main())
