#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_layers.py on small trees, most of them broken."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_layers  # noqa: E402


def faults_of(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_layers.check_tree(root)


class CheckLayersTest(unittest.TestCase):
    def assert_fault(self, files, *parts):
        faults = faults_of(files)
        self.assertEqual(len(faults), 1, faults)
        for part in parts:
            self.assertIn(part, faults[0])

    def test_accepts_lower_own_and_foreign_headers(self):
        self.assertEqual(faults_of({
            "include/hullslam/map/map.h": '#include <vector>\n#include <Eigen/Core>\n'
                                          '#include "hullslam/util/id.h"\n'
                                          '#include "hullslam/map/landmark.h"\n',
            "src/map/map.cc": '#include "hullslam/map/map.h"\n#include "private.h"\n'
                              '#include "hullslam/features/feature_set.h"\n',
        }), [])

    def test_up(self):
        self.assert_fault({"src/map/map.cc": '\n#include "hullslam/tracking/tracker.h"\n'},
                          "src/map/map.cc:2:", "up", "tracking")

    def test_sideways(self):
        self.assert_fault({"include/hullslam/camera/a.h": '#include "hullslam/features/b.h"\n'},
                          "include/hullslam/camera/a.h:1:", "sideways")

    def test_angle_brackets_and_spaces_count(self):
        self.assert_fault({"src/util/a.cc": "#  include <hullslam/geometry/rigid3.h>\n"}, "up")

    def test_relative_path_into_another_module(self):
        self.assert_fault({"src/map/a.cc": '#include "../optim/b.h"\n'}, "up", "optim")
        self.assert_fault(
            {"include/hullslam/map/a.h": '#include "../../../src/optim/b.h"\n'}, "up", "optim")

    def test_unknown_modules(self):
        self.assert_fault({"src/nonsense/a.cc": "int a;\n"}, 'unknown module "nonsense"')
        self.assert_fault({"src/map/a.cc": '#include "hullslam/nonsense/b.h"\n'},
                          'unknown module "nonsense"')
        self.assert_fault({"src/map/a.cc": '#include "hullslam/all.h"\n'}, "unknown module")
        self.assert_fault({"include/hullslam/all.h": "\n"}, "unknown module")

    def test_no_module_sees_the_synthetic_world(self):
        self.assert_fault({"src/io/a.cc": '#include "synthetic/scene.h"\n'}, "up", "synthetic")
        self.assertEqual(faults_of({
            "src/synthetic/a.cc": '#include "synthetic/scene.h"\n#include <embree3/rtcore.h>\n'
                                  '#include "hullslam/io/settings.h"\n'}), [])

    def test_kept_out_of_public_headers(self):
        for header in ("CGAL/convex_hull_2.h", "cholmod.h", "suitesparse/cholmod.h",
                       "Eigen/CholmodSupport", "SuiteSparseQR.hpp", "embree3/rtcore.h"):
            with self.subTest(header):
                text = f"#include <{header}>\n"
                self.assert_fault({"include/hullslam/geometry/a.h": text}, "public header", header)
                self.assertEqual(faults_of({"src/geometry/a.cc": text}), [])

    def test_comments_are_no_includes(self):
        self.assertEqual(faults_of({"src/util/a.cc": '// #include "hullslam/map/map.h"\n'}), [])

    def test_empty_tree_fails(self):
        self.assert_fault({}, "no C++ files")


if __name__ == "__main__":
    unittest.main()
