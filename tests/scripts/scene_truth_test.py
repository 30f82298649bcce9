#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/scene_truth.py: matching, figures, questions, and broken files."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "scene_truth.py"
sys.path.insert(0, str(SCRIPT.parent))
import scene_truth  # noqa: E402


def true_object(number, label, x):
    return {"id": number, "class": label, "world_from_object": [x, 0, 0, 0, 0, 0, 1],
            "half_extents": [0.1, 0.1, 0.1]}


TRUTH = {
    "objects": [true_object(0, "cup", 0.0), true_object(1, "book", 1.0), true_object(2, "cup", 2.0),
                true_object(3, "tv", 3.0)],
    "supports": [{"height": 0.0}, {"height": 0.7}, {"height": 0.0}],
    "relations": [{"subject": 0, "relation": "on", "object": 1},
                  {"subject": 1, "relation": "on", "support": 2},
                  {"subject": 2, "relation": "on", "support": 0},
                  {"subject": 2, "relation": "beside", "object": 3}]}
SCENE = {
    "objects": [{"id": 10, "class": "cup", "centre": [0.02, 0, 0]},
                {"id": 11, "class": "book", "centre": [1.0, 0.05, 0]},
                {"id": 12, "class": "cup", "centre": [2.0, 0, 0]},
                {"id": 13, "class": "cup", "centre": [2.05, 0, 0]},
                {"id": 14, "class": "chair", "centre": [9.0, 0, 0]}],
    "relations": [{"subject": 10, "relation": "on", "object": 11},
                  {"subject": 11, "relation": "in", "object": 12},
                  {"subject": 14, "relation": "on", "object": 11}],
    "surfaces": [{"objects": [11, 12, 14]}]}


class SceneTruthTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.write(SCENE, TRUTH)

    def write(self, scene, truth):
        (self.dir / "scene.json").write_text(json.dumps(scene))
        (self.dir / "groundtruth_objects.json").write_text(json.dumps(truth))

    def run_script(self, *arguments):
        return subprocess.run([SCRIPT, self.dir, self.dir, *arguments], capture_output=True,
                              text=True, check=False, timeout=60)

    def test_each_true_object_has_the_nearest_mapped_one(self):
        self.assertEqual(scene_truth.match(SCENE, TRUTH["objects"]), {10: 0, 11: 1, 12: 2})

    def test_relations_of_objects_that_are_not_mapped_do_not_count(self):
        found, true = scene_truth.compare(SCENE, TRUTH, {10: 0, 11: 1, 12: 2})
        # The floors of two rooms are one floor.
        self.assertEqual(true, {("on", 0, 1), ("on", 1, "support 0"), ("on", 2, "support 0")})
        self.assertEqual(found, true | {("in", 1, 2)})

    def test_prints_precision_and_recall(self):
        done = self.run_script("--list")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| 3 of 4 | 1.000 1.000 (3 found, 3 true) | 0.000 - (1 found, 0 true) |",
                      done.stdout)
        self.assertIn("wrong: book 1 in cup 2", done.stdout)

    def test_asks_questions_with_one_answer(self):
        questions = scene_truth.make_questions(SCENE, TRUTH, {10: 0, 11: 1, 12: 2}, 20)
        self.assertEqual(questions, [("the cup on the book", 10), ("the book", 11)])
        program = self.dir / "program"
        program.write_text("#!/bin/sh\ncase \"$1 $3\" in 'query the cup on'*) echo '{\"answers\": [{\"object\": 10}]}';;"
                           " *) exit 1;; esac\n")
        program.chmod(0o755)
        done = self.run_script("--questions", "20", "--program", program)
        self.assertIn("all questions: 1 of 2 (0.500)", done.stdout)

    def test_broken_files_are_named(self):
        self.write({"objects": []}, TRUTH)
        done = self.run_script()
        self.assertEqual(done.returncode, 2)
        self.assertIn("scene.json: has no relations", done.stderr)
        (self.dir / "scene.json").write_text("{")
        self.assertEqual(self.run_script().returncode, 2)


if __name__ == "__main__":
    unittest.main()
