#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_layers.py on small trees; most of them break one rule."""

import pathlib
import sys
import unittest
from unittest import mock

from small_tree import faults_in

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts"))
import check_layers  # noqa: E402


def faults_of(files):
    return faults_in(check_layers.check_tree, files)


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
        self.assert_fault({"include/hullslam/map/a.h": '#include "../optim/b.h"\n'}, "up", "optim")

    def test_private_header_of_another_module(self):
        self.assert_fault({"src/geometry/a.cc": '#include "costs/x.h"\n'},
                          "src/geometry/a.cc:1:", "up", "costs")
        self.assert_fault({"src/geometry/a.cc": "#include <costs/x.h>\n"}, "up", "costs")
        self.assertEqual(faults_of({"src/objects/a.cc": '#include "costs/x.h"\n'}), [])

    def test_link_that_is_not_declared(self):
        source = '#include "hullslam/geometry/rigid3.h"\n'
        for call in ("hullslam_module(map)", "hullslam_module(map LINKS util)",
                     "hullslam_module(map LINKS util PUBLIC geometry)",
                     "hullslam_module(map LINKS util PRIVATE geometry)",
                     "hullslam_module(map LINKS util WITH_SCENE geometry)",
                     "hullslam_module(map LINKS util  # geometry\n)",
                     "# hullslam_module(map LINKS geometry)\nhullslam_module(map LINKS util)"):
            with self.subTest(call):
                self.assert_fault({"src/map/CMakeLists.txt": call + "\n", "src/map/a.cc": source},
                                  "src/map/a.cc:1:", "geometry", "src/map/CMakeLists.txt", "LINKS")
        # The same for public and for private headers, on either side.
        cmake = {"src/map/CMakeLists.txt": "hullslam_module(map LINKS util)\n"}
        self.assert_fault({**cmake, "include/hullslam/map/a.h": source}, "LINKS")
        self.assert_fault({**cmake, "src/map/a.cc": '#include "geometry/polygon.h"\n'}, "LINKS")

    def test_declared_link(self):
        files = {"src/map/a.cc": '#include "hullslam/geometry/rigid3.h"\n'
                                 '#include "geometry/polygon.h"\n'
                                 '#include "hullslam/map/b.h"\n#include "map/c.h"\n'}
        for call in ("hullslam_module(map LINKS geometry)",
                     "hullslam_module(map LINKS util\n  geometry PUBLIC Eigen3::Eigen)",
                     "hullslam_module(map PUBLIC Eigen3::Eigen LINKS util geometry)",
                     "hullslam_module(map LINKS util  # ids\n                geometry)"):
            with self.subTest(call):
                self.assertEqual(faults_of({**files, "src/map/CMakeLists.txt": call}), [])

    def test_declaring_a_link_does_not_allow_to_include_upwards(self):
        self.assert_fault({"src/map/CMakeLists.txt": "hullslam_module(map LINKS optim)\n",
                           "src/map/a.cc": '#include "optim/b.h"\n'}, "up", "optim")

    def test_module_without_a_call_declares_no_links(self):
        for files in ({}, {"src/map/CMakeLists.txt": "add_library(map a.cc)\n"}):
            with self.subTest(files):
                self.assertEqual(faults_of(
                    {**files, "src/map/a.cc": '#include "hullslam/geometry/rigid3.h"\n'}), [])
                self.assert_fault({**files, "src/map/a.cc": '#include "optim/b.h"\n'}, "up")

    def test_private_header_in_a_public_one(self):
        for include in ('"map/graph.h"', '"geometry/polygon.h"', "<geometry/polygon.h>",
                        '"../../../src/map/graph.h"'):
            with self.subTest(include):
                text = f"\n#include {include}\n"
                self.assert_fault({"include/hullslam/map/a.h": text},
                                  "include/hullslam/map/a.h:2:", "private header")
                self.assertEqual(faults_of({"src/map/a.h": text.replace("../../../src/map/", "")}),
                                 [])
        self.assertEqual(faults_of({"include/hullslam/map/a.h": '#include "b.h"\n'}), [])

    def test_unknown_modules(self):
        self.assert_fault({"src/nonsense/a.cc": "int a;\n"}, 'unknown module "nonsense"')
        self.assert_fault({"src/map/a.cc": '#include "hullslam/nonsense/b.h"\n'},
                          'unknown module "nonsense"')
        self.assert_fault({"src/map/a.cc": '#include "hullslam/all.h"\n'}, "unknown module")
        self.assert_fault({"include/hullslam/all.h": "\n"}, "unknown module")

    def test_no_module_may_include_what_the_programs_share(self):
        self.assert_fault({"src/masks/a.cc": '#include "run/progress.h"\n'}, "up", "run")
        self.assertEqual(faults_of({
            "src/run/a.cc": '#include "run/progress.h"\n'
                            '#include "hullslam/settings/settings.h"\n'}), [])

    def test_libraries_that_public_headers_may_not_include(self):
        for header in ("CGAL/convex_hull_2.h", "cholmod.h", "suitesparse/cholmod.h",
                       "Eigen/CholmodSupport", "SuiteSparseQR.hpp", "embree3/rtcore.h"):
            with self.subTest(header):
                text = f"#include <{header}>\n"
                self.assert_fault({"include/hullslam/geometry/a.h": text}, "public header", header)
                self.assertEqual(faults_of({"src/geometry/a.cc": text}), [])

    def test_includes_in_comments_do_not_count(self):
        self.assertEqual(faults_of({"src/util/a.cc": '// #include "hullslam/map/map.h"\n'}), [])

    def test_words_of_few_modules(self):
        for text, home in (("if (camera.IsFisheye()) {}", "camera"), ("LensModel lens;", "map_files"),
                           ("kKannalaBrandt", "settings"), ("SensorKind::kStereo", "frame"),
                           ("OpenTumSequence(folder);", "sequences"), ("TumDataset()", "datasets"),
                           ("bool IsKitti(int);", "datasets"), ('name == "euroc_stereo"', "datasets")):
            with self.subTest(text):
                self.assert_fault({"src/loop/a.cc": f"\n{text}\n"}, "src/loop/a.cc:2:", "WORDS")
                self.assert_fault({"include/hullslam/loop/a.h": f"{text}\n"}, "may")
                self.assertEqual(faults_of({f"src/{home}/a.cc": text + "\n"}), [])
                self.assertEqual(faults_of({"src/loop/a.cc": f"// {text}\n"}), [])
        for text in ("Frustum volume;", "PairingRule::kTum", '"a sequence of TUM"', "kStereoPair"):
            with self.subTest(text):
                self.assertEqual(faults_of({"src/loop/a.cc": text + "\n"}), [])

    def test_exceptions_are_needed(self):
        used = {(word.meaning, module) for path, module, _ in check_layers.source_files(TOP)
                for _, word, _ in check_layers.words_in(path.read_text(encoding="utf-8"))}
        for word in check_layers.WORDS:
            idle = {module for module in word.still if (word.meaning, module) not in used}
            self.assertEqual(idle, set(), f"take these modules out of WORDS: {word.meaning}")

    def test_sizes(self):
        most = check_layers.MOST_FILES
        files = {f"src/loop/a{i}.h": "\n" for i in range(most)}
        self.assertEqual(faults_of(files), [])
        self.assert_fault({**files, "src/loop/b.cc": ""}, f"src/loop: {most + 1} files, at most {most}")
        self.assertEqual(faults_of({**files, "include/hullslam/loop/b.h": ""}), [])
        self.assert_fault({"src/loop/a.cc": "\n" * 901}, "src/loop/a.cc: 901 lines, at most 900")
        self.assert_fault({"src/loop/a.cc": "", "scripts/a.sh": "\n" * (check_layers.SCRIPTS + 1)},
                          f"scripts: {check_layers.SCRIPTS + 1} lines")
        most = check_layers.ALL_FILES
        many = {f"src/loop{i % 30}/a{i}.h": "" for i in range(most + 1)}
        with mock.patch.object(check_layers, "LEVELS", {f"loop{i}": 0 for i in range(30)}):
            self.assert_fault(many, f"src and include: {most + 1} files, at most {most}")
        most = check_layers.PARTS["run"][1]
        self.assert_fault({f"src/run/a{i}.cc": "\n" * 900 for i in range(most // 900 + 1)}, "run: ", "PARTS")

    def test_empty_tree_fails(self):
        self.assert_fault({}, "no C++ files")


if __name__ == "__main__":
    unittest.main()
