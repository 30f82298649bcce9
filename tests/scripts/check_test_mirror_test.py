#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_test_mirror.py on small trees; most of them break one rule."""

import pathlib
import sys
import unittest

from small_tree import faults_in

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_test_mirror  # noqa: E402

HEADER = "include/hullslam/util/id.h"
TEST = "tests/util/id_test.cc"
BODY = "TEST(IdTest, Orders) {}\n"


def faults_of(files):
    return faults_in(check_test_mirror.check_tree, files)


class CheckTestMirrorTest(unittest.TestCase):
    def test_accepts_a_mirror(self):
        self.assertEqual(faults_of({
            HEADER: "", TEST: BODY,
            "src/run/scene.h": "", "tests/run/scene_test.cc": "TEST_F(S, T) {}\n",
            "src/run/parts.cc": "", "tests/run/parts_test.cc": BODY,
            "src/run/untested.h": "",
            "tests/integration/run_test.cc": "", "tests/consumer/any_test.cc": ""}), [])

    def test_header_without_test(self):
        self.assertEqual(faults_of({HEADER: ""}), [f"{HEADER}: no {TEST}"])

    def test_test_in_the_wrong_module(self):
        faults = faults_of({HEADER: "", "tests/map/id_test.cc": BODY})
        self.assertEqual(len(faults), 2, faults)
        self.assertIn("tests/map/id_test.cc: neither", faults[1])

    def test_test_without_header(self):
        faults = faults_of({HEADER: "", TEST: BODY, "tests/util/gone_test.cc": BODY})
        self.assertEqual(len(faults), 1, faults)
        self.assertIn("gone_test.cc: neither", faults[0])

    def test_file_without_a_test(self):
        self.assertEqual(faults_of({HEADER: "", TEST: "// TEST(\n"}), [f"{TEST}: contains no test"])

    def test_empty_tree_fails(self):
        self.assertEqual(len(faults_of({})), 1)


if __name__ == "__main__":
    unittest.main()
