#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/add_supporting_mask.py with two frames and a few masks."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "add_supporting_mask.py"
sys.path.insert(0, str(SCRIPT.parent))
import add_supporting_mask  # noqa: E402

CUP = "41 0.40 0.40 0.50 0.40 0.50 0.50 0.40 0.50 1\n"
CHAIR = "56 0.10 0.10 0.20 0.10 0.20 0.20 1\n"
CAMERA = "Camera.fx: 100\nCamera.fy: 100\nCamera.cx: 50\nCamera.cy: 50\n"


def thing(number, centre):
    return {"class_id": number, "world_from_object": [*centre, 0, 0, 0, 1],
            "half_extents": [0.1, 0.1, 0.1]}


class AddSupportingMaskTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.sequence = pathlib.Path(folder.name) / "desk"
        self.masks, self.out = self.sequence / "masks", self.sequence.parent / "out"
        self.masks.mkdir(parents=True)
        (self.masks / "1.000000.txt").write_text(CUP + CHAIR)
        (self.masks / "2.000000.txt").write_text("")

    def write_truth(self):
        (self.sequence / "camera.yaml").write_text(CAMERA)
        # The camera is 1 m above the origin and looks down: x right, y backward in the image.
        (self.sequence / "groundtruth.txt").write_text("1.0 0 0 1 1 0 0 0\n2.0 0 0 1 1 0 0 0\n")
        # The cup, a mouse and another cup stand at a height of 0.75 m, a chair on the floor.
        objects = [thing(41, (0, 0, 0.85)), thing(64, (0.3, 0, 0.85)), thing(41, (0, 0.3, 0.85)),
                   thing(56, (0, 0, 0.1))]
        (self.sequence / "groundtruth_objects.json").write_text(json.dumps({"objects": objects}))

    def run_script(self, *arguments):
        return subprocess.run([SCRIPT, self.masks, self.out, "--size", "100x100", *arguments],
                              capture_output=True, text=True, check=False, timeout=60)

    def surface(self, name="1.000000.txt"):
        words = (self.out / name).read_text().splitlines()[-1].split()
        self.assertEqual((words[0], words[-1]), ("60", "1"))
        return 100 * np.array(words[1:-1], dtype=float).reshape(-1, 2)

    def test_lies_under_the_things_on_the_table(self):
        self.write_truth()
        result = self.run_script("--margin", "30")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 files with 3 detections, 1 of them added", result.stdout)
        text = (self.out / "1.000000.txt").read_text()
        self.assertTrue(text.startswith(CUP + CHAIR))
        self.assertEqual(text.count("\n"), 3)
        surface = self.surface()  # the cup's mask is 40 to 50, the chair's 10 to 20
        np.testing.assert_allclose(surface.min(axis=0), [10, 10], atol=1e-3)
        np.testing.assert_allclose(surface.max(axis=0), [80, 80], atol=1e-3)
        self.assertEqual((self.out / "2.000000.txt").read_text(), "")

    def test_all_masks_without_truth_and_clipped_to_the_image(self):
        self.assertEqual(self.run_script("--margin", "30").returncode, 0)
        surface = self.surface()
        np.testing.assert_allclose(surface.min(axis=0), [0, 0], atol=1e-3)
        self.assertLessEqual(surface.max(), 80.001)

    def test_hull_and_clip(self):
        square = [(0, 0), (4, 0), (4, 4), (0, 4)]
        hull = add_supporting_mask.convex_hull(np.array([*square, (2, 2), (2, 0)]))
        self.assertEqual(sorted(map(tuple, hull)), sorted(square))
        part = add_supporting_mask.clip(np.array(square, dtype=float) - 2, (1, 9))
        self.assertEqual(sorted(map(tuple, part)), [(0, 0), (0, 2), (1, 0), (1, 2)])

    def test_bad_input(self):
        (self.masks / "1.000000.txt").write_text("41 0.1 x\n")
        result = self.run_script()
        self.assertEqual(result.returncode, 2)
        self.assertIn("1.000000.txt:1", result.stderr)
        (self.out / "file").touch()
        self.assertIn("is not empty", self.run_script().stderr)
        self.masks = self.sequence
        self.assertIn("contains no *.txt", self.run_script().stderr)
        self.assertEqual(self.run_script("--size", "0x3").returncode, 2)


if __name__ == "__main__":
    unittest.main()
