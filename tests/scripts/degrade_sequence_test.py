#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/degrade_sequence.py with a sequence of eight frames."""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "degrade_sequence.py"
sys.path.insert(0, str(SCRIPT.parent))
import degrade_sequence  # noqa: E402
import leave_and_return  # noqa: E402

try:
    import cv2
except ImportError:
    cv2 = None

STAMPS = [10.0 + i / 10 for i in range(8)]
MASKS = "41 0.4 0.4 0.5 0.4 0.5 0.5 0.75\n63 0.3 0.3 0.4 0.3 0.4 0.4\n"


class DegradeSequenceTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.sequence, self.out = self.dir / "in", self.dir / "out"
        for kind in ("rgb", "depth", "masks"):
            (self.sequence / kind).mkdir(parents=True)
        images, depth = ["# stamp file\n"], []
        for i, stamp in enumerate(STAMPS):
            leave_and_return.write_png(self.sequence / f"rgb/{i}.png", (64, 32), 8, 3, 100 + i)
            leave_and_return.write_png(self.sequence / f"depth/d{i}.png", (64, 32), 16, 1, 5000)
            (self.sequence / f"masks/{i}.txt").write_text(MASKS.replace("41", str(41 + i % 2)))
            images.append(f"{stamp:.6f} rgb/{i}.png\n")
            depth.append(f"{stamp + 0.011:.6f} depth/d{i}.png\n")
        (self.sequence / "rgb.txt").write_text("".join(images))
        (self.sequence / "depth.txt").write_text("".join(depth))
        # The camera moves by 1 m/s.
        (self.sequence / "groundtruth.txt").write_text("".join(
            f"{9.95 + i / 20:.6f} {9.95 + i / 20:.6f} 0 0 0 0 0 1\n" for i in range(18)))

    def run_script(self, *arguments, code=0):
        result = subprocess.run([SCRIPT, self.sequence, self.out, *map(str, arguments)],
                                capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        return result

    def rows(self, name):
        return [line.split() for line in (self.out / name).read_text().splitlines()
                if not line.startswith("#")]

    def stamps(self):
        return [float(row[0]) for row in self.rows("rgb.txt")]

    def assert_stamps(self, expected):
        np.testing.assert_allclose(self.stamps(), expected, atol=1e-9)

    def image_of(self, stamp, kind="rgb"):
        """The number of the image that is shown at a stamp."""
        row, = [row for row in self.rows(f"{kind}.txt") if abs(float(row[0]) - stamp) < 1e-9]
        return pathlib.Path(row[1]).stem

    def masks(self, number):
        return (self.out / f"masks/{number}.txt").read_text()

    def test_without_disturbances_all_is_linked(self):
        self.assertIn("8 images", self.run_script().stdout)
        self.assert_stamps(STAMPS)
        for kind in ("rgb", "depth"):
            self.assertEqual([row[0] for row in self.rows(f"{kind}.txt")],
                             [f"{stamp:.6f}" for stamp in STAMPS])
            for row in self.rows(f"{kind}.txt"):
                self.assertEqual((self.out / row[1]).resolve(),
                                 (self.sequence / row[1]).resolve())
        self.assertTrue((self.out / "groundtruth.txt").is_symlink())
        self.assertEqual(self.masks(3), (self.sequence / "masks/3.txt").read_text())

    def test_stamps_in_pairs(self):
        self.run_script("--early", 5)
        self.assert_stamps([10.095, 10.1, 10.295, 10.3, 10.495, 10.5, 10.695, 10.7])
        # The truth of an image is that of the moment when it was taken.
        truth = [(float(row[0]), float(row[1])) for row in self.rows("groundtruth.txt")]
        np.testing.assert_allclose(truth, list(zip(self.stamps(), STAMPS)), atol=1e-6)
        self.assertEqual((self.out / "groundtruth_in.txt").resolve().name, "groundtruth.txt")
        self.assertEqual(self.image_of(10.295), "2")
        self.assertEqual(self.image_of(10.295, "depth"), "d2")
        self.out = self.dir / "pairs"
        self.run_script("--pairs", 0.002)
        self.assert_stamps([stamp for stamp in STAMPS[::2] for stamp in (stamp, stamp + 2e-6)])

    def test_late_stamps_increase_and_follow_the_seed(self):
        self.run_script("--late", 200)
        late = self.stamps()
        self.assertTrue(all(b >= a + 0.9e-4 for a, b in zip(late, late[1:])))
        self.assertTrue(all(b >= a - 1e-9 for a, b in zip(STAMPS, late)))
        self.assertGreater(max(b - a for a, b in zip(STAMPS, late)), 0.05)
        for name, seed, equal in (("again", 0, True), ("other", 1, False)):
            self.out = self.dir / name
            self.run_script("--late", 200, "--seed", seed)
            self.assertEqual(self.stamps() == late, equal)

    def test_missing_images(self):
        self.run_script("--missing", "2/4")
        self.assert_stamps([10.0, 10.1, 10.4, 10.5])
        self.assertTrue((self.out / "groundtruth.txt").is_symlink(), "the stamps are true")
        self.out = self.dir / "even"
        self.run_script("--missing", "2/4", "--even")
        self.assert_stamps([10.0, 10.1, 10.2, 10.3])
        self.assertEqual(self.image_of(10.2), "4")
        truth = [(float(row[0]), float(row[1])) for row in self.rows("groundtruth.txt")]
        np.testing.assert_allclose(truth, [(10.0, 10.0), (10.1, 10.1), (10.2, 10.4), (10.3, 10.5)])

    def test_an_image_that_is_shown_several_times(self):
        self.run_script("--stall", "3/4")
        self.assert_stamps(STAMPS)
        self.assertEqual([self.image_of(stamp) for stamp in STAMPS], list("01114555"))
        self.assertEqual(self.image_of(10.3, "depth"), "d1")
        truth = [float(row[1]) for row in self.rows("groundtruth.txt")]
        np.testing.assert_allclose(truth, [10.0, 10.1, 10.1, 10.1, 10.4, 10.5, 10.5, 10.5])

    def test_masks(self):
        self.run_script("--mask-shift", 6.4)
        for before, after in zip(degrade_sequence.read_masks(self.sequence / "masks/0.txt"),
                                 degrade_sequence.read_masks(self.out / "masks/0.txt")):
            moves = (after[1] - before[1]) * [64, 32]
            np.testing.assert_allclose(np.linalg.norm(moves, axis=1), 6.4, atol=1e-5)
            np.testing.assert_allclose(moves, moves[:1].repeat(3, axis=0), atol=1e-5)
            self.assertEqual((after[0], after[2]), (before[0], before[2]))
        for name, arguments in (("drop", ["--mask-drop", 1]), ("confuse", ["--mask-confuse", 1]),
                                ("swap", ["--mask-swap", 1])):
            self.out = self.dir / name
            self.run_script(*arguments)
        self.assertEqual((self.dir / "drop/masks/0.txt").read_text(), "")
        classes = [line.split()[0] for line in
                   (self.dir / "confuse/masks/0.txt").read_text().splitlines()]
        self.assertTrue(classes[0] in ("42", "63") and classes[1] in ("41", "42"), classes)
        self.assertEqual([(self.dir / f"swap/masks/{i}.txt").read_text()[:2] for i in range(4)],
                         ["42", "41", "42", "41"])

    @unittest.skipUnless(cv2, "needs OpenCV for Python")
    def test_images_and_depth(self):
        self.run_script("--noise", 5, "--depth-holes", 0.5)
        image = cv2.imread(str(self.out / "rgb/0.png")).astype(float)
        self.assertAlmostEqual(image.std(), 5.0, delta=0.3)
        depth = [cv2.imread(str(self.out / f"depth/d{i}.png"), cv2.IMREAD_UNCHANGED)
                 for i in range(8)]
        self.assertEqual(depth[0].dtype, np.uint16)
        self.assertEqual({int(value) for value in np.unique(depth)}, {0, 5000})
        self.assertTrue(0.2 < np.mean(np.array(depth) == 0) < 0.8)

    @unittest.skipUnless(cv2, "needs OpenCV for Python")
    def test_a_turned_sequence(self):
        pixels = np.zeros((32, 64, 3), np.uint8)
        pixels[2:6, 50:54] = 255  # at the top right
        cv2.imwrite(str(self.sequence / "rgb/0.png"), pixels)
        self.run_script("--turn", 90)
        turned = cv2.imread(str(self.out / "rgb/0.png"))
        self.assertEqual(turned.shape, (64, 32, 3))
        self.assertEqual(turned[12, 4, 0], 255, "now at the top left")
        self.assertEqual(cv2.imread(str(self.out / "depth/d0.png"),
                                    cv2.IMREAD_UNCHANGED).shape, (64, 32))
        np.testing.assert_allclose(degrade_sequence.read_masks(self.out / "masks/0.txt")[1][1],
                                   [[0.3, 0.7], [0.3, 0.6], [0.4, 0.6]])

    def test_changes_of_images(self):
        image = np.full((32, 32, 3), 100, np.uint8)
        self.assertEqual(degrade_sequence.brightness(image, 1.5, None, 29).max(), 100)
        self.assertEqual(degrade_sequence.brightness(image, 1.5, None, 30).min(), 150)
        self.assertEqual(degrade_sequence.brightness(image, 3.0, None, 59).min(), 255)
        if cv2:
            image[:, 16:] = 200
            blurred = degrade_sequence.blur(image, 2.0, None, 0)[16, :, 0].astype(int)
            self.assertTrue(100 < blurred[15] < 150 < blurred[16] < 200, blurred)

    def test_depth_is_paired_by_the_smallest_difference(self):
        self.assertEqual(degrade_sequence.pair_depth([1.0, 1.01], [1.011, 1.03, 0.985]),
                         {0: 2, 1: 0})

    def test_bad_input(self):
        for arguments in (["--missing", "4/4"], ["--missing", "x"], ["--late", "nan"],
                          ["--late", -1], ["--mask-drop", 2], ["--turn", 45], ["--seed", -1],
                          ["--masks", self.dir / "none"], ["--early", 250], ["--stall", "0/3"]):
            with self.subTest(arguments):
                self.run_script(*arguments, code=2)
                self.assertFalse(self.out.exists())
        (self.sequence / "masks/0.txt").write_text("41 0.1 x\n")
        self.assertIn("masks/0.txt:1", self.run_script("--mask-drop", 1, code=2).stderr)
        self.assertIn("is not empty", self.run_script(code=2).stderr)
        self.out = self.dir / "out2"
        (self.sequence / "rgb.txt").write_text("2 a\n1 b\n")
        self.assertIn("do not increase", self.run_script(code=2).stderr)


if __name__ == "__main__":
    unittest.main()
