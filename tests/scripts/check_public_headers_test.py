#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_public_headers.py on small trees."""

import pathlib
import sys
import unittest

from small_tree import faults_in

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_public_headers  # noqa: E402

HEADER = "include/hullslam/map/map.h"
INCLUDE = '#include "hullslam/map/map.h"\n'


def faults_of(files):
    return faults_in(check_public_headers.check_tree, files)


class CheckPublicHeadersTest(unittest.TestCase):
    def assert_fault(self, files, header):
        faults = faults_of(files)
        self.assertEqual(len(faults), 1, faults)
        self.assertTrue(faults[0].startswith(header + ":"), faults[0])

    def test_users(self):
        for user, text in (("Examples/library/01_minimal.cc", INCLUDE), ("Examples/tools/a.h", INCLUDE),
                           ("tools/a.cc", INCLUDE), ("bench/a_bench.cc", INCLUDE),
                           ("python/module.cc", INCLUDE), ("tests/consumer/main.cc", INCLUDE),
                           ("bench/b.cc", "#  include <hullslam/map/map.h>\n"),
                           ("README.md", "`Map` (`hullslam/map/map.h`) holds all.\n"),
                           ("docs/topics/map.md", "```cpp\n" + INCLUDE + "```\n")):
            with self.subTest(user):
                self.assertEqual(faults_of({HEADER: "", user: text}), [])

    def test_the_library_and_its_tests_are_no_users(self):
        for other, text in (("src/map/map.cc", INCLUDE), ("src/system/system.cc", INCLUDE),
                            ("src/run/slam_run.cc", INCLUDE), ("tests/map/map_test.cc", INCLUDE),
                            ("tests/support/world.h", INCLUDE), ("Examples/a.cc", "// " + INCLUDE),
                            ("Examples/CMakeLists.txt", INCLUDE),
                            ("docs/a.md", "`map/map.h` and `src/hullslam/map/other.h`\n")):
            with self.subTest(other):
                self.assert_fault({HEADER: "", other: text}, HEADER)

    def test_headers_that_public_headers_need(self):
        files = {HEADER: '#include "hullslam/map/keyframe.h"\n',
                 "include/hullslam/map/keyframe.h": '#include "hullslam/frame/frame.h"\n',
                 "include/hullslam/frame/frame.h": "#include <vector>\n"}
        self.assertEqual(faults_of({**files, "Examples/a.cc": INCLUDE}), [])
        self.assertEqual(len(faults_of(files)), 3)

    def test_a_header_that_only_an_unused_header_includes_is_unused(self):
        faults = faults_of({HEADER: "", "Examples/a.cc": INCLUDE,
                            "include/hullslam/eval/a.h": '#include "hullslam/eval/b.h"\n',
                            "include/hullslam/eval/b.h": '#include "hullslam/eval/a.h"\n'})
        self.assertEqual([fault.partition(":")[0] for fault in faults],
                         ["include/hullslam/eval/a.h", "include/hullslam/eval/b.h"])

    def test_the_fault_names_the_folder(self):
        self.assertIn("belongs in src/map", faults_of({HEADER: ""})[0])

    def test_empty_tree_fails(self):
        self.assertEqual(len(faults_of({})), 1)


if __name__ == "__main__":
    unittest.main()
