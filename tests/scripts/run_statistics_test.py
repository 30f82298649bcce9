#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/run_statistics.py."""

import pathlib
import sys
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


if __name__ == "__main__":
    unittest.main()
