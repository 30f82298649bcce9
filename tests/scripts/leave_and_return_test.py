#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/leave_and_return.py with sequences of four frames."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import PIL.Image

from in_process import run_main

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "leave_and_return.py"
sys.path.insert(0, str(SCRIPT.parent))
import leave_and_return  # noqa: E402

STAMPS = (10.0, 10.1, 10.2, 10.3)


class LeaveAndReturnTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.room = self.make_sequence("room", STAMPS)
        self.out = self.dir / "out"

    def make_sequence(self, name, stamps):
        sequence = self.dir / name
        for kind in ("rgb", "depth", "masks"):
            (sequence / kind).mkdir(parents=True)
        for kind in ("rgb", "depth"):
            for stamp in stamps:
                PIL.Image.new("RGB", (4, 2), (7, 7, 7)).save(sequence / kind / f"{stamp:.6f}.png")
            (sequence / f"{kind}.txt").write_text("# stamp file\n" + "".join(
                f"{stamp:.6f} {kind}/{stamp:.6f}.png\n" for stamp in stamps))
        for stamp in stamps[1:]:
            (sequence / "masks" / f"{stamp:.6f}.txt").write_text(f"{name} {stamp}\n")
        (sequence / "groundtruth.txt").write_text("".join(
            f"{stamp + step / 100:.6f} {stamp + step / 100:.6f} 0 0 0 0 0 1\n"
            for stamp in stamps for step in (-2, 0, 2, 5)))
        (sequence / "camera.yaml").write_text("Camera.fx: 1\n")
        return sequence

    def run_script(self, *arguments):
        return run_main(leave_and_return.main, self.room, self.out, *arguments)

    def test_as_a_program(self):
        for arguments, code in (["--again"], 0), (["--at", "1"], 2):
            result = subprocess.run([SCRIPT, self.room, self.out, *arguments], capture_output=True,
                                    text=True, check=False)
            self.assertEqual(result.returncode, code, result.stderr)

    def rows(self, name):
        return [line.split() for line in (self.out / name).read_text().splitlines()
                if not line.startswith("#")]

    def masks_of(self, stamp):
        return (self.out / "masks" / f"{stamp}.txt").read_text()

    def test_blank_frames(self):
        result = self.run_script("--blank", 3)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 frames, 3 of something else, 2 frames", result.stdout)
        for kind in ("rgb", "depth"):
            stamps = [row[0] for row in self.rows(f"{kind}.txt")]
            self.assertEqual(stamps, [f"10.{i}00000" for i in range(7)])
            for row in self.rows(f"{kind}.txt"):
                self.assertEqual(row[1], f"{kind}/{row[0]}.png")
                self.assertTrue((self.out / row[1]).is_symlink())
        self.assertEqual((self.out / "rgb/10.500000.png").resolve().name, "10.200000.png")
        self.assertEqual((self.out / "rgb/10.300000.png").resolve().name, "blank_rgb.png")
        self.assertEqual([self.masks_of(f"10.{i}00000") for i in range(7)],
                         ["", "room 10.1\n", "", "", "", "room 10.2\n", "room 10.3\n"])
        self.assertTrue((self.out / "camera.yaml").exists())

    def test_truth_only_of_the_original_frames(self):
        self.assertEqual(self.run_script("--blank", 3).returncode, 0)
        truth = [(float(row[0]), float(row[1])) for row in self.rows("groundtruth.txt")]
        before = [pair for pair in truth if pair[0] < 10.2]
        after = [pair for pair in truth if pair[0] > 10.4]
        self.assertEqual(len(before) + len(after), len(truth))
        self.assertEqual([stamp for stamp, _ in before],
                         [9.98, 10.0, 10.02, 10.05, 10.08, 10.1, 10.12])
        self.assertTrue(all(stamp == x for stamp, x in before))
        self.assertTrue(all(abs(stamp - x - 0.3) < 1e-9 for stamp, x in after))
        self.assertEqual(min(after)[0], 10.48)

    def test_frames_of_another_sequence(self):
        other = self.make_sequence("desk", [5.0, 5.03, 5.06])
        result = self.run_script("--blank", 2, "--other", other, "--at", 3)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([row[0] for row in self.rows("rgb.txt")],
                         [f"10.{i}00000" for i in range(6)])
        for kind in ("rgb", "depth"):
            self.assertEqual((self.out / kind / "10.400000.png").resolve(),
                             (other / kind / "5.030000.png").resolve())
        self.assertEqual([self.masks_of(f"10.{i}00000") for i in (2, 3, 4, 5)],
                         ["room 10.2\n", "", "desk 5.03\n", "room 10.3\n"])
        self.out = self.dir / "none"
        self.assertIn("fewer than 4 frames", self.run_script("--blank", 4, "--other", other).stderr)
        self.assertFalse(self.out.exists())

    def test_the_whole_sequence_again(self):
        result = self.run_script("--blank", 2, "--again")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("4 frames, 2 of something else, 4 frames", result.stdout)
        for kind in ("rgb", "depth"):
            self.assertEqual([row[0] for row in self.rows(f"{kind}.txt")],
                             [f"10.{i}00000" for i in range(10)])
            self.assertEqual([(self.out / row[1]).resolve().name[:4]
                              for row in self.rows(f"{kind}.txt")],
                             ["10.0", "10.1", "10.2", "10.3", "blan", "blan"]
                             + ["10.0", "10.1", "10.2", "10.3"])
        truth = [(float(row[0]), float(row[1])) for row in self.rows("groundtruth.txt")]
        self.assertEqual({round(stamp - x, 6) for stamp, x in truth}, {0.0, 0.6})

    def test_blank_images(self):
        self.assertEqual(self.run_script().returncode, 0)
        for name, mode, value in (("rgb", "RGB", (128, 128, 128)), ("depth", "I", 0)):
            with PIL.Image.open(self.out / f"blank_{name}.png") as image:
                self.assertEqual((image.size, image.mode), ((4, 2), mode), "16 bits for depth")
                self.assertEqual(set(image.getdata()), {value})

    def test_bad_input(self):
        for arguments in (["--blank", 0], ["--again", "--at", 2], ["--at", 1], ["--at", 4], ["--other", self.dir]):
            with self.subTest(arguments):
                result = self.run_script(*arguments)
                self.assertEqual(result.returncode, 2)
                self.assertNotIn("Traceback", result.stderr)
        self.out.mkdir(exist_ok=True)
        (self.out / "file").touch()
        self.assertIn("is not empty", self.run_script().stderr)
        (self.room / "rgb.txt").write_text("a b\n")
        self.assertIn("rgb.txt:1", self.run_script().stderr)


if __name__ == "__main__":
    unittest.main()
