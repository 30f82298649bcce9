# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames of a sequence as the programs read them: the images of a folder in natural order, images
by the pixels that are stored, videos turned as their containers ask (docs/datasets.md)."""

import pathlib
import re
import struct

import numpy as np

from support import InputError

SUFFIXES = (".png", ".jpg", ".jpeg")
RIGHT_ANGLES = {(1, 0, 0, 1): 1, (0, 1, -1, 0): 6, (-1, 0, 0, -1): 3, (0, -1, 1, 0): 8}


def list_images(folder):
    """In natural order: frame2 before frame10."""
    def key(path):
        return [int(part) if part.isdecimal() else part for part in re.split(r"(\d+)", path.name)]
    return sorted((path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES), key=key)


def colour_images(folder):
    """The colour images of a folder without lists; empty if it has none."""
    if (folder / "rgb").is_dir():
        return list_images(folder / "rgb")
    if (folder / "results").is_dir():  # Replica
        return [path for path in list_images(folder / "results") if path.name.startswith("frame")]
    images = list_images(folder) if folder.is_dir() else []
    return [path for path in images if ".color." in path.name] or images  # 7-Scenes, or photos


def orientation_of(path):
    """The orientation in the EXIF data of a JPEG, 1 to 8; 1 is as stored."""
    if path.suffix.lower() not in (".jpg", ".jpeg"):
        return 1
    from PIL import Image
    try:
        with Image.open(path) as image:
            number = image.getexif().get(0x0112, 1)
    except (OSError, SyntaxError, ValueError):
        return 1  # who reads the pixels will report it
    return number if number in range(1, 9) else 1


def turn(image, orientation):
    """A stored image (height, width, ...) as a viewer shows it."""
    if orientation in (6, 8):
        return np.rot90(image, -1 if orientation == 6 else 1)
    if orientation in (5, 7):
        image = image.swapaxes(0, 1)
    across = orientation in (2, 3, 7)
    down = orientation in (3, 4, 7)
    return image[::-1 if down else 1, ::-1 if across else 1]


def turn_back(image, orientation):
    """The inverse of turn()."""
    return turn(image, {6: 8, 8: 6}.get(orientation, orientation))


class VideoFrames:
    """The frames of a video, one after the other."""

    def __init__(self, path):
        try:
            import cv2  # only videos need it
        except ImportError as error:
            raise InputError(f"{path}: a video needs the Debian package python3-opencv") from error
        self.path, self.cv2 = pathlib.Path(path), cv2
        self.orientation = orientation_of_video(self.path)
        self.video = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
        if not self.video.isOpened():
            raise InputError(f"{path}: is not a video that can be decoded")
        # OpenCV 4.6 turns by 90 degrees the wrong way.
        self.video.set(cv2.CAP_PROP_ORIENTATION_AUTO, 0)

    def skip(self):
        """Goes to the next frame; false after the last one."""
        return self.video.grab()

    def image(self):
        """The frame of the last skip(), with blue first; None if it cannot be decoded."""
        is_good, image = self.video.retrieve()
        return np.ascontiguousarray(turn(image, self.orientation)) if is_good else None


def boxes(data, at, end):
    """(type, begin of the content, end) of the boxes in a part of an MP4 file."""
    while at + 8 <= end:
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        begin = at + 8
        if size == 1:
            size, begin = struct.unpack(">Q", data[begin:begin + 8])[0], begin + 8
        size = end - at if size == 0 else size
        if size < 8:
            return
        yield kind, begin, min(at + size, end)
        at += size


def orientation_of_video(path):
    """How the first track of images of an MP4 or MOV file is turned, as a number of EXIF; 1 for other
    containers, which cameras do not use for turned videos."""
    import mmap
    with open(path, "rb") as file:
        if path.stat().st_size < 8:
            return 1
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            for kind, begin, end in boxes(data, 0, len(data)):
                tracks = [box for box in boxes(data, begin, end) if box[0] == b"trak"] \
                    if kind == b"moov" else []
                for _, inside, last in tracks:
                    if b"vide" in data[inside:last]:  # the handler of the track
                        return orientation_of_track(data, inside, last)
    return 1


def orientation_of_track(data, begin, end):
    for kind, at, last in boxes(data, begin, end):
        if kind == b"tkhd":
            at += 40 if data[at] == 0 else 52
            numbers = struct.unpack(">9i", data[at:at + 36]) if at + 36 <= last else (0,) * 9
            matrix = tuple(numbers[i] >> 16 for i in (0, 1, 3, 4))
            return RIGHT_ANGLES.get(matrix, 1)
    return 1
