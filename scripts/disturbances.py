# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/degrade_sequence.py can do to a sequence: one function per disturbance, and their
table."""

import argparse
import dataclasses

import numpy as np

from support import number

MIN_STEP = 1e-4  # s, from one late stamp to the next
BRIGHTNESS_PERIOD = 30  # images with the same brightness
HOLE = 32  # px, side of a hole in a depth image


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


def resize(image, size, *_):
    import cv2
    is_depth = image.ndim == 2  # the mean of two surfaces would be no surface
    return cv2.resize(image, size, interpolation=cv2.INTER_NEAREST if is_depth else cv2.INTER_AREA)


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


def mask_swap(images, share, rng):
    """For each image, the one whose masks it gets. `images` are those that have masks."""
    sources = {image: image for image in images}
    for a, b in zip(images[::2], images[1::2]):
        if rng.random() < share:
            sources[a], sources[b] = b, a
    return sources


# ---- the table of disturbances


def share_of_images(text):
    try:
        count, period = (int(word) for word in text.split("/"))
    except ValueError:
        count, period = 0, 0
    if not 0 < count < period:
        raise argparse.ArgumentTypeError(f"'{text}' is not N/M with 0 < N < M")
    return count, period


def image_size(text):
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal() and 16 <= int(width) <= 9999
            and 16 <= int(height) <= 9999):
        raise argparse.ArgumentTypeError(f"'{text}' is not WIDTHxHEIGHT with 16 to 9999 px")
    return int(width), int(height)


@dataclasses.dataclass
class Disturbance:
    name: str
    type: object  # reads the amount; None for a flag
    metavar: str
    help: str
    changes: dict  # what it changes (frames, image, depth, masks, mask files) -> function


MILLISECONDS, SHARE = number(0.0, 1e4), number(0.0, 1.0)
DISTURBANCES = [
    Disturbance("missing", share_of_images, "N/M", "the last N of every M images are missing; 1/M "
                "drops every M-th image", {"frames": missing}),
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
    Disturbance("blur", number(0.1, 100.0), "PX", "images are blurred by a Gaussian of PX px",
                {"image": blur}),
    Disturbance("brightness", number(0.0, 10.0), "FACTOR",
                f"images {BRIGHTNESS_PERIOD} to {2 * BRIGHTNESS_PERIOD - 1} are brighter by this "
                "factor, and so on in turn", {"image": brightness}),
    Disturbance("noise", number(0.0, 255.0), "LEVELS",
                "noise of so many grey levels is added to images", {"image": noise}),
    Disturbance("depth-holes", SHARE, "SHARE", f"this share of the squares of {HOLE} px of a depth "
                "image has no depth", {"depth": depth_holes}),
    Disturbance("resize", image_size, "WxH", "images and depth get this size, in px; the settings of "
                "the camera must then be others", {"image": resize, "depth": resize}),
    Disturbance("mask-shift", number(0.0, 1e4), "PX",
                "each mask is moved by PX px in a random direction", {"masks": mask_shift}),
    Disturbance("mask-drop", SHARE, "SHARE", "this share of the masks is missing",
                {"masks": mask_drop}),
    Disturbance("mask-confuse", SHARE, "SHARE",
                "this share of the masks has another class of the sequence",
                {"masks": mask_confuse}),
    Disturbance("mask-swap", SHARE, "SHARE",
                "this share of the images has the masks of the next image, which has theirs",
                {"mask files": mask_swap}),
]
