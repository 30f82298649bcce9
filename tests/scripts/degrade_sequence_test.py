#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/degrade_sequence.py with a sequence of eight frames."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import PIL.Image

from in_process import run_main

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "degrade_sequence.py"
sys.path.insert(0, str(SCRIPT.parent))
import degrade_sequence  # noqa: E402
import disturbances  # noqa: E402
import tum_and_icl  # noqa: E402
import yolo_masks  # noqa: E402

try:
    import cv2
except ImportError:
    cv2 = None

STAMPS = [10.0 + i / 10 for i in range(8)]
MASKS = "41 0.4 0.4 0.5 0.4 0.5 0.5 0.75\n63 0.3 0.3 0.4 0.3 0.4 0.4\n"


def write_png(path, mode, colour):
    PIL.Image.new(mode, (64, 32), colour).save(path)


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
            write_png(self.sequence / f"rgb/{i}.png", "RGB", (100 + i,) * 3)
            write_png(self.sequence / f"depth/d{i}.png", "I;16", 5000)
            (self.sequence / f"masks/{i}.txt").write_text(MASKS.replace("41", str(41 + i % 2)))
            images.append(f"{stamp:.6f} rgb/{i}.png\n")
            depth.append(f"{stamp + 0.011:.6f} depth/d{i}.png\n")
        (self.sequence / "rgb.txt").write_text("".join(images))
        (self.sequence / "depth.txt").write_text("".join(depth))
        # The camera moves by 1 m/s.
        (self.sequence / "groundtruth.txt").write_text("".join(
            f"{9.95 + i / 20:.6f} {9.95 + i / 20:.6f} 0 0 0 0 0 1\n" for i in range(18)))

    def run_script(self, *arguments, code=0):
        result = run_main(degrade_sequence.main, self.sequence, self.out, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def test_as_a_program(self):
        for arguments, code in (([], 0), (["--blur"], 2)):
            result = subprocess.run([SCRIPT, self.sequence, self.out, *arguments], capture_output=True,
                                    text=True, check=False)
            self.assertEqual(result.returncode, code, result.stderr)

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

    def test_masks(self):
        self.run_script("--mask-shift", 6.4)
        for before, after in zip(yolo_masks.read_masks(self.sequence / "masks/0.txt"),
                                 yolo_masks.read_masks(self.out / "masks/0.txt")):
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
    def test_a_resized_sequence(self):
        depth = np.full((32, 64), 1000, np.uint16)
        depth[:, 33:] = 9000
        cv2.imwrite(str(self.sequence / "depth/d0.png"), depth)
        self.run_script("--resize", "48x16")
        self.assertEqual(cv2.imread(str(self.out / "rgb/3.png")).shape, (16, 48, 3))
        small = cv2.imread(str(self.out / "depth/d0.png"), cv2.IMREAD_UNCHANGED)
        self.assertEqual(small.shape, (16, 48))
        self.assertEqual(set(np.unique(small)), {1000, 9000}, "no depth between two surfaces")
        self.assertEqual(self.masks(0), MASKS, "outlines are shares of the size")
        for bad in ("48", "48x", "0x16", "48x16x3", "-48x16"):
            self.assertIn("WIDTHxHEIGHT", self.run_script(f"--resize={bad}", code=2).stderr)

    def test_changes_of_images(self):
        image = np.full((32, 32, 3), 100, np.uint8)
        self.assertEqual(disturbances.brightness(image, 1.5, None, 29).max(), 100)
        self.assertEqual(disturbances.brightness(image, 1.5, None, 30).min(), 150)
        self.assertEqual(disturbances.brightness(image, 3.0, None, 59).min(), 255)
        if cv2:
            image[:, 16:] = 200
            blurred = disturbances.blur(image, 2.0, None, 0)[16, :, 0].astype(int)
            self.assertTrue(100 < blurred[15] < 150 < blurred[16] < 200, blurred)

    def test_depth_is_paired_by_the_smallest_difference(self):
        pairs = tum_and_icl.pair(np.array([1.0, 1.01]), np.array([1.011, 1.03, 0.985]))
        self.assertEqual(pairs.tolist(), [[0, 2], [1, 0]])

    def files(self):
        return {str(path.relative_to(self.out)): path.read_bytes()
                for path in sorted(self.out.rglob("*")) if path.is_file()}

    @unittest.skipUnless(cv2, "needs OpenCV for Python")
    def test_each_random_disturbance_repeats_with_its_seed(self):
        for option, amount in (("--late", 50), ("--noise", 5), ("--depth-holes", 0.5),
                               ("--mask-shift", 3), ("--mask-drop", 0.5),
                               ("--mask-confuse", 0.5), ("--mask-swap", 0.5)):
            found = []
            for name, seed in (("first", 3), ("again", 3), ("other", 4)):
                self.out = self.dir / f"{option[2:]}-{name}"
                self.run_script(option, amount, "--seed", seed)
                found.append(self.files())
            with self.subTest(option):
                self.assertEqual(found[0], found[1])
                self.assertNotEqual(found[0], found[2])

    @unittest.skipUnless(cv2, "needs OpenCV for Python")
    def test_blur_and_brightness_are_the_same_for_all_seeds(self):
        found = []
        for seed in (1, 2):
            self.out = self.dir / str(seed)
            self.run_script("--blur", 2, "--brightness", 1.5, "--seed", seed)
            found.append(self.files())
        self.assertEqual(found[0], found[1])

    def test_every_nth_image_is_dropped(self):
        self.run_script("--missing", "1/3")
        self.assert_stamps([10.0, 10.1, 10.3, 10.4, 10.6, 10.7])
        self.assertEqual(sorted(path.stem for path in (self.out / "masks").iterdir()),
                         ["0", "1", "3", "4", "6", "7"])

    def test_masks_may_be_left_out(self):
        (self.sequence / "masks/0.txt").write_text("broken")
        self.run_script("--no-masks")
        self.assertFalse((self.out / "masks").exists())

    def make_icl(self):
        (self.sequence / "rgb.txt").unlink()
        for i in range(8):
            (self.sequence / f"depth/d{i}.png").rename(self.sequence / f"depth/{i}.png")
        (self.sequence / "associations.txt").write_text("".join(
            f"{i} depth/{i}.png {i} rgb/{i}.png\n" for i in range(8)))
        (self.sequence / "groundtruth.txt").rename(self.sequence / "made.gt.freiburg")

    @unittest.skipUnless(cv2, "needs OpenCV for Python")
    def test_a_sequence_of_icl_nuim(self):
        self.make_icl()
        self.run_script("--missing", "1/4", "--noise", 4, "--mask-drop", 1)
        self.assertEqual((self.out / "associations.txt").read_text().splitlines(), [
            f"{i} depth/{i}.png {i} rgb/{i}.png" for i in (0, 1, 2, 4, 5, 6)])
        self.assertFalse((self.out / "rgb.txt").exists())
        self.assertTrue((self.out / "made.gt.freiburg").is_symlink())
        self.assertEqual((self.out / "masks/4.txt").read_text(), "")
        self.assertEqual(len(list((self.out / "rgb").iterdir())), 6)

    def test_images_of_icl_nuim_have_no_stamps(self):
        self.make_icl()
        for arguments in (["--late", 5], ["--even", "--missing", "1/4"]):
            self.out = self.dir / arguments[0][2:]
            self.assertIn("numbers", self.refuse(*arguments))
        list_file = self.sequence / "associations.txt"
        for text in ("0 depth/0.png 1 rgb/1.png\n", "0 depth/0.png\n", "0.5 a 0.5 b\n"):
            list_file.write_text(text)
            self.assertIn("associations.txt", self.refuse())

    def refuse(self, *arguments):
        """The message of a call that must fail and write nothing."""
        before = set(self.dir.iterdir())
        errors = self.run_script(*arguments, code=2).stderr
        self.assertEqual(set(self.dir.iterdir()), before)
        return errors

    def test_bad_amounts(self):
        for arguments in (["--missing", "4/4"], ["--missing", "x"], ["--missing", "1/2/3"],
                          ["--late", "nan"],
                          ["--late", -1], ["--early", 250], ["--pairs", "x"], ["--blur", 0],
                          ["--blur", "inf"], ["--brightness", -1], ["--brightness", 11],
                          ["--noise", -1], ["--noise", 256], ["--depth-holes", 1.1],
                          ["--depth-holes", "nan"], ["--mask-shift", -1],
                          ["--mask-drop", 2], ["--mask-confuse", -0.1],
                          ["--mask-swap", "nan"], ["--seed", -1], ["--seed", "x"],
                          ["--masks", self.dir / "none"], ["--no-masks", "--masks", "x"]):
            with self.subTest(arguments):
                errors = self.refuse(*arguments)
                self.assertIn("time stamps" if arguments == ["--early", 250] else arguments[0],
                              errors)

    def test_masks_in_other_formats_are_refused(self):
        first = self.sequence / "masks/0.txt"
        for line, part in (("41 0.1 x", "masks/0.txt:1"), ("cup 0.1 0.1 0.2 0.1 0.2 0.2", "class"),
                           ("41 0.5 0.5 0.1 0.1 0.9", "boxes"), ("41 10 20 30 20 30 40", "shares"),
                           ("41 0.1 0.1 0.2 0.1 0.2 nan", "shares"),
                           ("\n0 3 41 0.9 100.5 20 30 20 30 40", "masks/0.txt:2")):
            first.write_text(line + "\n")
            with self.subTest(line):
                self.assertIn(part, self.refuse("--mask-drop", 1))
                self.assertIn("yolo-seg", self.refuse() if "x" not in line else "yolo-seg")
        first.write_bytes(b"\xff\xfe\0")
        self.assertIn("no text file", self.refuse())
        other = self.sequence / "labels"
        other.mkdir()
        (other / "0.png").write_bytes(b"")
        self.assertIn("labels: has no file 0.txt but 0.png", self.refuse("--masks", other))
        self.assertIn("yolo-seg", self.refuse("--masks", other))
        self.assertIn("is no folder", self.refuse("--masks", first))

    def test_masks_that_are_not_there(self):
        (self.sequence / "masks").rename(self.sequence / "others")
        self.assertIn("--mask-drop needs masks", self.refuse("--mask-drop", 0.5))
        self.run_script("--mask-drop", 0.5, "--masks", self.sequence / "others")

    @unittest.skipUnless(cv2, "needs OpenCV for Python")
    def test_broken_images(self):
        write_png(self.sequence / "depth/d3.png", "L", 50)
        self.assertIn("d3.png: expected a depth image with one channel of 16 bits",
                      self.refuse("--depth-holes", 0.5))
        (self.sequence / "rgb/2.png").write_bytes(b"no image")
        self.assertIn("rgb/2.png: is no image", self.refuse("--blur", 1))
        (self.sequence / "rgb/2.png").unlink()
        self.assertIn("rgb/2.png: no such file", self.refuse())

    def test_broken_lists_and_folders(self):
        rgb = self.sequence / "rgb.txt"
        for text, part in (("2 rgb/0.png\n1 rgb/1.png\n", "do not increase"), ("", "no lines"),
                           ("x rgb/0.png\n", "rgb.txt:1"), ("nan rgb/0.png\n", "rgb.txt:1"),
                           ("1\n", "rgb.txt:1"), ("1 rgb/0.png\n", "fewer than two images")):
            rgb.write_text(text)
            with self.subTest(text):
                self.assertIn(part, self.refuse())
        rgb.unlink()
        self.assertIn("is no sequence, expected rgb.txt", self.refuse())
        self.sequence = self.dir / "none"
        self.assertIn("none: is no folder", self.refuse())

    def test_an_output_that_may_not_be_written(self):
        self.out.mkdir()
        self.run_script()  # an empty folder is filled
        self.assertIn("is not empty", self.refuse())
        self.out = self.dir / "in/rgb.txt"
        self.assertIn("is no folder", self.refuse())
        self.out = self.dir / "in/rgb.txt/out"
        self.refuse()


if __name__ == "__main__":
    unittest.main()
