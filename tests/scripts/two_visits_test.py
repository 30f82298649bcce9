#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/two_visits.py with programs that compute nothing."""

import csv
import pathlib
import sys
import tempfile
import unittest

from in_process import run_main

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "two_visits.py"
sys.path.insert(0, str(SCRIPT.parent))
import two_visits  # noqa: E402

# A second session that reports one departure, unless it begins at frame 0.
SLAM = """#!/usr/bin/python3
import json, pathlib, sys
words = sys.argv[1:]
value = lambda name: words[words.index(name) + 1] if name in words else None
out = pathlib.Path(value("--output"))
out.mkdir(parents=True)
if value("--save-map"):
    pathlib.Path(value("--save-map")).touch()
changes = {"seen_again": 4, "gone": 0 if value("--first") == "0" else 1}
(out / "summary.json").write_text(json.dumps({"objects": {"changes": changes}}))
with (pathlib.Path(sys.argv[0]).parent / "calls").open("a") as calls:
    calls.write(" ".join(words) + "\\n")
"""
RENDER = """#!/usr/bin/python3
import pathlib, sys
folder = pathlib.Path(sys.argv[1])
(folder / "masks").mkdir(parents=True)
(folder / "groundtruth_objects.json").touch()
"""
EVALUATE = """#!/usr/bin/python3
import json
counts = {"in_truth": 5, "reported": 4, "right": 3}
print(json.dumps({"groundtruth": {"changes": {"places_left": counts, "places_taken": counts}}}))
"""


class TwoVisitsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.out = self.dir / "out"
        for name, text in ("rgbd_tum", SLAM), ("make_synthetic", RENDER), ("hullslam", EVALUATE):
            (self.dir / name).write_text(text)
            (self.dir / name).chmod(0o755)

    def run_script(self, *arguments):
        return run_main(two_visits.main, *arguments, "--programs", self.dir)

    def rows(self, name):
        with (self.out / name).open(encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_counts_departures_of_a_still_scene(self):
        result = self.run_script("still", self.dir, self.out, "--masks", self.dir, "--cut",
                                 "0:3,4:9", "5:9,0:4")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 false departures in 2 runs", result.stdout)
        self.assertEqual([row["gone"] for row in self.rows("still.csv")], ["1", "0"])
        calls = (self.dir / "calls").read_text().splitlines()
        self.assertEqual(len(calls), 4)
        self.assertIn("--first 4 --last 9", calls[1])
        self.assertIn("--load-map", calls[1])
        self.assertEqual(self.run_script("still", self.dir, self.out, "--cut", "0:3,4:9",
                                         "5:9,0:4").stdout, result.stdout)
        self.assertEqual(len((self.dir / "calls").read_text().splitlines()), 4, "kept")

    def test_compares_rendered_scenes_with_the_truth(self):
        result = self.run_script("scenes", self.out, "--scene", "desk:0", "room:1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("places_left: 6 of 8 reported are right (75 %), 6 of 10 were found (60 %)",
                      result.stdout)
        self.assertEqual([row["scene"] for row in self.rows("scenes.csv")], ["desk:0", "room:1"])

    def test_refuses_bad_usage(self):
        for words in (["--cut", "0:3"], ["--recall", "0"]):
            self.assertEqual(self.run_script("still", self.dir, self.out, *words).returncode, 2)

    def test_a_failed_run_ends_it(self):
        (self.dir / "rgbd_tum").write_text("#!/bin/sh\nexit 1\n")
        result = self.run_script("still", self.dir, self.out, "--cut", "0:3,4:9")
        self.assertEqual(result.returncode, 1)
        self.assertIn("first.log", result.stderr)


if __name__ == "__main__":
    unittest.main()
