#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/run_statistics.py."""

import hashlib
import pathlib
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
import run_statistics  # noqa: E402


class ComparisonTest(unittest.TestCase):
    def test_p_of_the_sign_flip_test(self):
        self.assertEqual(run_statistics.flip_probability([0.3]), 1.0)
        self.assertEqual(run_statistics.flip_probability([-0.1, -0.2]), 0.5)
        self.assertEqual(run_statistics.flip_probability([1.0, 2.0, 3.0, 4.0, 5.0]), 2 / 32)
        self.assertEqual(run_statistics.flip_probability([1.0, 1.0, -1.0]), 1.0)
        # +-1 +-2 +-4 has 8 sums; 7 and -7, 5 and -5 are at least as large as 5.
        self.assertEqual(run_statistics.flip_probability([-1.0, 2.0, 4.0]), 0.5)
        many = [0.1] * 20
        self.assertLess(run_statistics.flip_probability(many), 1e-3)
        self.assertGreater(run_statistics.flip_probability([0.1, -0.1] * 10), 0.9)

    def test_p_of_the_sign_test(self):
        self.assertEqual(run_statistics.sign_probability([]), 1.0)
        self.assertEqual(run_statistics.sign_probability([5.0, 0.0]), 1.0)
        self.assertEqual(run_statistics.sign_probability([1.0] * 8), 2 / 256)
        self.assertEqual(run_statistics.sign_probability([-1.0] * 8), 2 / 256)
        # One of eight: (1 + 8) / 256 on each side. Its size does not matter.
        self.assertEqual(run_statistics.sign_probability([0.1] * 7 + [-99.0]), 18 / 256)
        self.assertEqual(run_statistics.sign_probability([1.0, -1.0] * 5), 1.0)

    def test_only_runs_of_the_same_sequence_and_seed_are_paired(self):
        change, p, pairs = run_statistics.compare({"a 0": 1.0, "a 1": 2.0}, {"a 1": 4.0, "a 2": 1.0})
        self.assertAlmostEqual(change, 1.0)
        self.assertEqual((p, pairs), (1.0, 1))
        self.assertEqual(run_statistics.compare({"a 0": 1.0}, {}), (None, None, 0))


class SummaryTest(unittest.TestCase):
    def test_only_numbers_are_figures(self):
        summary = {"a": {"b": 2, "c": True, "d": None, "e": "3"}, "f": [1]}
        self.assertEqual(run_statistics.value_at(summary, ("a", "b")), 2.0)
        for keys in (("a",), ("a", "c"), ("a", "d"), ("a", "e"), ("f", "g"), ("x", "y")):
            self.assertIsNone(run_statistics.value_at(summary, keys), keys)


class FileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "file.json"

    def test_a_broken_file_has_no_content(self):
        self.assertIsNone(run_statistics.try_read_json(self.path))
        for text in ("{", "[1]", '"a"', "[" * 100000):
            self.path.write_text(text)
            self.assertIsNone(run_statistics.try_read_json(self.path))
        self.path.write_bytes(b"\xff\xfe")
        self.assertIsNone(run_statistics.try_read_json(self.path))

    def test_written_files_replace_others_and_leave_nothing_else(self):
        for text in ("{}", '{"a": 1}'):
            run_statistics.write(self.path, text)
            self.assertEqual(self.path.read_text(), text)
        self.assertEqual(run_statistics.try_read_json(self.path), {"a": 1})
        self.assertEqual(list(self.path.parent.iterdir()), [self.path])

    def test_the_hash_is_that_of_all_bytes(self):
        data = bytes(range(256)) * 8192
        self.path.write_bytes(data)
        self.assertEqual(run_statistics.hash_file(self.path), hashlib.sha256(data).hexdigest())


if __name__ == "__main__":
    unittest.main()
