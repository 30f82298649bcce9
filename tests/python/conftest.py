# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the Python module share: programs, a rendered sequence, and a wall."""

import os
import pathlib
import subprocess

import cv2
import numpy as np
import pytest

import hullslam

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("HULLSLAM_BIN", ROOT / "build" / "release" / "bin"))
WIDTH, HEIGHT = 320, 240
CAMERA = {"fx": 260.0, "fy": 260.0, "cx": 159.5, "cy": 119.5, "bf": 20.0, "width": WIDTH,
          "height": HEIGHT}


def run_program(name, *arguments):
    """Runs a program of HullSLAM, such as "rgbd_tum" or "hullslam view", and returns what it printed.
    Skips the test if it is not built."""
    program, *command = name.split()
    program = BIN / program
    if not program.exists():
        pytest.skip(f"{program} is not built")
    result = subprocess.run([program, *command, *map(str, arguments)], capture_output=True, text=True,
                            check=False)
    assert result.returncode == 0, result.stderr
    return result.stdout


class Wall:
    """A wall of random patches, 2 m in front of a camera that moves to the right.

    Every 40 frames the camera is back at the beginning. A square on the wall is an object.
    """

    DISTANCE = 2.0  # m
    TEXELS = 130.0  # per metre
    PERIOD = 40  # frames

    def __init__(self):
        random = np.random.default_rng(3)
        self.texture = np.full((450, 600), 120, np.uint8)
        for _ in range(3000):
            x, y = random.integers(0, 580), random.integers(0, 430)
            w, h = random.integers(3, 20, 2)
            self.texture[y:y + h, x:x + w] = random.integers(0, 256)
        self.texture = cv2.GaussianBlur(self.texture, (3, 3), 0.8)
        self.images = [self._photograph(i) for i in range(self.PERIOD)]
        self.depth = np.full((HEIGHT, WIDTH), self.DISTANCE, np.float32)

    @staticmethod
    def center(index):
        """Centre of the camera in the frame of the first camera, m."""
        phase = 2.0 * np.pi * index / Wall.PERIOD
        return np.array([0.1 * np.sin(phase), 0.05 * (1.0 - np.cos(phase)), 0.0])

    def _photograph(self, index, baseline=0.0):
        pixels = self.TEXELS * self.DISTANCE / CAMERA["fx"]  # texels per pixel
        x, y, _ = (self.center(index) + [baseline, 0.0, 0.0]) * self.TEXELS
        pixel_to_texel = np.array([[pixels, 0.0, 300 + x - pixels * CAMERA["cx"]],
                                   [0.0, pixels, 225 + y - pixels * CAMERA["cy"]]])
        return cv2.warpAffine(self.texture, pixel_to_texel, (WIDTH, HEIGHT),
                              flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)

    def image(self, index):
        """(HEIGHT, WIDTH) uint8"""
        return self.images[index % self.PERIOD]

    def right(self, index, baseline):
        """The image of a second camera, `baseline` m to the right."""
        return self._photograph(index, baseline)

    def masks(self, index, shift=0):
        """The mask of the picture, moved to the left by `shift` px as in a right image."""
        x, y, _ = self.center(index) * CAMERA["fx"] / self.DISTANCE
        x += shift
        stack = np.zeros((1, HEIGHT, WIDTH), bool)
        stack[0, int(100 - y):int(150 - y), int(140 - x):int(200 - x)] = True
        return hullslam.Masks(stack, ["picture"], [0.9])

    def track(self, slam, first, last, masks=False):
        """Tracks the frames from `first` to before `last` and returns the results."""
        return [slam.track(self.image(i), self.depth, self.masks(i) if masks else None,
                           timestamp=i / 30.0) for i in range(first, last)]


@pytest.fixture(scope="session")
def wall():
    return Wall()


@pytest.fixture
def settings():
    return hullslam.Settings(Camera=CAMERA, ORBextractor={"nFeatures": 400})


@pytest.fixture
def slam(settings):
    return hullslam.System(settings)


@pytest.fixture(scope="session")
def desk(tmp_path_factory):
    """The folder of a rendered sequence of 25 frames with depth and masks."""
    folder = tmp_path_factory.mktemp("synthetic") / "desk"
    run_program("make_synthetic", folder, "--frames", 25, "--quiet")
    return folder
