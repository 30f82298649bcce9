#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/run_frames.py: how images and videos are turned."""

import pathlib
import struct
import sys
import tempfile
import unittest

import cv2
import numpy as np
import PIL.Image
import PIL.ImageOps

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import run_frames  # noqa: E402


class RunFramesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def test_images_are_turned_as_by_pillow(self):
        pixels = np.arange(24, dtype=np.uint8).reshape(4, 6)
        for orientation in range(1, 9):
            image = PIL.Image.fromarray(pixels)
            image.getexif()[0x0112] = orientation
            upright = run_frames.turn(pixels, orientation)
            np.testing.assert_array_equal(upright, np.array(PIL.ImageOps.exif_transpose(image)))
            np.testing.assert_array_equal(run_frames.turn_back(upright, orientation), pixels)

    def write_video(self, matrix):
        """A white corner at the upper left of the stored images."""
        path = self.dir / "a.mp4"
        writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*"mp4v"), 25.0, (64, 48))
        image = np.zeros((48, 64, 3), np.uint8)
        image[:24, :32] = 255
        for _ in range(3):
            writer.write(image)
        writer.release()
        data = bytearray(path.read_bytes())
        at = data.index(b"tkhd") + 4 + 40
        a, b, c, d = (number * 65536 for number in matrix)
        data[at:at + 20] = struct.pack(">5i", a, b, 0, c, d)
        path.write_bytes(data)
        return path

    def test_videos_are_turned_as_they_ask(self):
        for matrix, size, corner in (((1, 0, 0, 1), (48, 64), (9, 9)), ((0, 1, -1, 0), (64, 48), (9, 40)),
                                     ((-1, 0, 0, -1), (48, 64), (40, 56)),
                                     ((0, -1, 1, 0), (64, 48), (56, 9))):
            video = run_frames.VideoFrames(self.write_video(matrix))
            self.assertTrue(video.skip())
            image = video.image()
            self.assertEqual(image.shape[:2], size)
            self.assertGreater(image[corner][0], 200)
            self.assertLess(image.mean(), 120)

    def test_files_that_are_no_mp4_are_not_turned(self):
        for content in (b"", b"RIFF", b"\0\0\0\x04moov", b"\xff" * 50):
            path = self.dir / "a.bin"
            path.write_bytes(content)
            self.assertEqual(run_frames.orientation_of_video(path), 1)

    def test_colour_images_of_folders_without_lists(self):
        for name in ("frame-2.color.png", "frame-10.color.png", "frame-2.depth.png", "notes.txt"):
            (self.dir / name).touch()
        self.assertEqual([path.name for path in run_frames.colour_images(self.dir)],
                         ["frame-2.color.png", "frame-10.color.png"])
        (self.dir / "results").mkdir()
        for name in ("frame0.jpg", "depth0.png"):
            (self.dir / "results" / name).touch()
        self.assertEqual([path.name for path in run_frames.colour_images(self.dir)], ["frame0.jpg"])


if __name__ == "__main__":
    unittest.main()
