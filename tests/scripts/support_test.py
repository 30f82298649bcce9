#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/support.py."""

import hashlib
import pathlib
import sys
import tempfile
import unittest

import numpy as np

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
import support  # noqa: E402


class SummaryTest(unittest.TestCase):
    def test_only_numbers_are_figures(self):
        summary = {"a": {"b": 2, "c": True, "d": None, "e": "3"}, "f": [1]}
        self.assertEqual(support.value_at(summary, "a", "b"), 2.0)
        for keys in (("a",), ("a", "c"), ("a", "d"), ("a", "e"), ("f", "g"), ("x", "y")):
            self.assertIsNone(support.value_at(summary, *keys), keys)


class FileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "file.json"

    def test_a_broken_file_has_no_content(self):
        self.assertIsNone(support.try_read_json(self.path))
        for text in ("{", "[1]", '"a"', "[" * 100000):
            self.path.write_text(text)
            self.assertIsNone(support.try_read_json(self.path))
        self.path.write_bytes(b"\xff\xfe")
        self.assertIsNone(support.try_read_json(self.path))

    def test_written_files_replace_others_and_leave_nothing_else(self):
        for text in ("{}", '{"a": 1}'):
            support.write(self.path, text)
            self.assertEqual(self.path.read_text(), text)
        self.assertEqual(support.try_read_json(self.path), {"a": 1})
        self.assertEqual(list(self.path.parent.iterdir()), [self.path])

    def test_the_hash_is_that_of_all_bytes(self):
        data = bytes(range(256)) * 8192
        self.path.write_bytes(data)
        self.assertEqual(support.hash_file(self.path), hashlib.sha256(data).hexdigest())


class TrajectoryTest(FileTest):
    def assert_refused(self, text, *parts):
        self.path.write_text(text)
        with self.assertRaises(support.InputError) as caught:
            support.read_trajectory(self.path)
        for part in parts:
            self.assertIn(part, str(caught.exception))

    def test_stamps_and_poses(self):
        self.path.write_text("# comment\n\n1.5 1 2 3 0 0 0 1\n2,4,5,6,0,0,1,0\n")
        stamps, poses = support.read_trajectory(self.path)
        np.testing.assert_array_equal(stamps, [1.5, 2.0])
        np.testing.assert_array_equal(poses[1], [4, 5, 6, 0, 0, 1, 0])

    def test_malformed_trajectories(self):
        for line in ("1 2 3", "1 0 0 0 0 0 0 x", "1 nan 0 0 0 0 0 1", "1 0 0 0 0 0 0 1 9"):
            self.assert_refused(f"# stamp\n{line}\n", f"{self.path}:2", "8 numbers")
        for line in ("1 1e155 0 0 0 0 0 1", "1e300 0 0 0 0 0 0 1"):
            self.assert_refused(line, f"{self.path}:1", "too large")
        self.assert_refused("# nothing\n", "no poses")
        self.path.write_bytes(b"\x00\xff\xfe")
        self.assertRaisesRegex(support.InputError, "not a text", support.read_trajectory, self.path)
        self.path.unlink()
        self.assertRaisesRegex(support.InputError, "cannot read", support.read_trajectory, self.path)


if __name__ == "__main__":
    unittest.main()
