# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the images of a run by their time stamps: in a sequence with rgb.txt, in folders of images
and in videos. The stamps are those that the programs give to the images (docs/datasets.md)."""

import pathlib
import re

import matplotlib.pyplot as plt
import numpy as np

from run_files import InputError, one_line
from run_frames import VideoFrames, list_images

DEFAULT_FPS = 30.0
CLOCKS = {13: 1e3, 16: 1e6, 19: 1e9}  # digits of a stamp without a point: its units per second
TOLERANCE = 1e-3  # s


class ImageFiles:
    """Images in files."""

    def __init__(self, place, stamps, files):
        self.place, self.stamps, self.files = place, np.array(stamps, dtype=float), files
        if not files:
            raise InputError(f"{place}: lists no images")
        if not np.isfinite(self.stamps).all():
            raise InputError(f"{place}: a time stamp is not finite")

    def at(self, stamp):
        """The image of this time stamp."""
        number = nearest(self.place, self.stamps, stamp)
        return read_image(self.files[number])


class Video:
    """Images of a video file."""

    def __init__(self, path, fps, offset):
        self.path, stamps = path, []
        video = VideoFrames(path)
        while video.skip():
            stamps.append(video.milliseconds() / 1e3)
        if not stamps:
            raise InputError(f"{path}: no frame of the video can be decoded")
        stamps = np.array(stamps)
        if not fps and (np.diff(stamps) <= 0).any():
            # OpenCV 4.6 does not know the stamps of frames that the decoder delivers late. Cameras
            # take most videos at a constant rate.
            fps = video.rate()
        self.stamps = (np.arange(len(stamps)) / fps if fps else stamps) + offset

    def at(self, stamp):
        number = nearest(self.path, self.stamps, stamp)
        video = VideoFrames(self.path)
        for _ in range(number + 1):
            video.skip()
        image = video.image()
        if image is None:
            raise InputError(f"{self.path}: frame {number} cannot be decoded")
        return image[:, :, ::-1]  # OpenCV's images have blue first


def nearest(place, stamps, stamp):
    number = int(np.argmin(np.abs(stamps - stamp)))
    if abs(stamps[number] - stamp) > TOLERANCE:
        raise InputError(f"{place}: no image of {stamp:.6f}; is it the sequence of the run, and are "
                         "--fps and --stamp-offset those of the run?")
    return number


def read_image(path):
    try:
        image = plt.imread(path)
    except Exception as error:  # noqa: BLE001: the decoders raise errors of many types
        raise InputError(f"{path}: not an image: {one_line(error)}") from error
    if image.ndim == 3 and image.shape[2] == 2:  # grey with transparency
        image = image[:, :, 0]
    return image


def read_list(path):
    try:
        rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
        rows = [row for row in rows if row and not row[0].startswith("#")]
        return ImageFiles(path, [float(row[0]) for row in rows],
                          [path.parent / row[1] for row in rows])
    except (OSError, ValueError, IndexError) as error:
        raise InputError(f"{path}: not a list of images with one line `stamp file` per image: "
                         f"{one_line(error)}; give the folder of the images by --sequence") from error


def stamp_of_name(path, fps):
    """The stamp by the last number in a name; the same rules as for rgbd_tum."""
    numbers = re.findall(r"\d+(?:\.\d+)?", path.stem)
    if not numbers:
        raise InputError(f"{path}: the name has neither a number nor a time stamp")
    units = 1.0 if "." in numbers[-1] else CLOCKS.get(len(numbers[-1]), fps)
    return float(numbers[-1]) / units


def open_images(sequence, fps=None, offset=0.0):
    """The images of a sequence, which is a folder or a video. `fps` is None if it was not given."""
    sequence = pathlib.Path(sequence)
    if sequence.is_file():
        return Video(sequence, fps, offset)
    if (sequence / "rgb.txt").exists():
        return read_list(sequence / "rgb.txt")
    try:
        if (sequence / "rgb").is_dir():
            files = list_images(sequence / "rgb")
            stamps = [stamp_of_name(path, fps or DEFAULT_FPS) for path in files]
            return ImageFiles(sequence / "rgb", stamps, files)
        files = list_images(sequence)
    except OSError as error:
        raise InputError(f"{sequence}: has no rgb.txt and is no folder of images: "
                         f"{error.strerror}; give the folder of the images by --sequence") from error
    return ImageFiles(sequence, np.arange(len(files)) / (fps or DEFAULT_FPS) + offset, files)
