#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that the scripts find the observations of objects, which have a file of their own."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
import object_entries  # noqa: E402
import run_objects  # noqa: E402

CAMERA = {"fx": 50.0, "fy": 50.0, "cx": 32.0, "cy": 24.0, "width": 64, "height": 48}


def make_object(number, observations):
    return {"id": number, "class": "cup", "state": "mapped", "half_axes": [0.04, 0.06, 0.05],
            "world_from_object": [0, 0, 2, 0, 0, 0, 1], "siou": 0.8125, "siou_mask": None,
            "tangent_px": 2.5, "observations": observations}


def make_view(number, stamp):
    return {"object": number, "timestamp": stamp, "cam_from_world": [0, 0, 0, 0, 0, 0, 1],
            "hull": [[20, 10], [40, 10], [40, 30]]}


class ObjectEntriesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.path = self.dir / "objects.json"

    def write(self, objects, views=None):
        self.path.write_text(json.dumps({"camera": CAMERA, "objects": objects}))
        if views is not None:
            (self.dir / "objects_observations.json").write_text(json.dumps({"observations": views}))

    def test_each_object_gets_its_own_observations(self):
        self.write([make_object(4, 2), make_object(7, 1), make_object(9, 0)],
                   [make_view(4, 1.0), make_view(7, 1.0), make_view(4, 2.0)])
        _, objects = run_objects.read_objects(self.path)
        self.assertEqual([sorted(item.views) for item in objects], [[1.0, 2.0], [1.0], []])

    def test_the_table_counts_them(self):
        self.write([make_object(4, 2)], [make_view(4, 1.0), make_view(4, 2.0)])
        result = subprocess.run([SCRIPTS / "object_table.py", self.dir], capture_output=True,
                                text=True, check=False, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("| 4 | cup | 2 | 0 |", result.stdout)

    def test_lists_in_the_objects_themselves_are_left_alone(self):
        self.write([make_object(4, [make_view(4, 1.0)])])
        _, objects = run_objects.read_objects(self.path)
        self.assertEqual(sorted(objects[0].views), [1.0])

    def test_broken_and_missing_files(self):
        self.write([make_object(4, 1)])
        with self.assertRaisesRegex(run_objects.InputError, "objects.json.*cannot read objects_obs"):
            run_objects.read_objects(self.path)
        for views in ([], [make_view(4, 1.0)] * 2, [{}], 5, [3]):
            with self.subTest(views):
                self.write([make_object(4, 1)], views)
                with self.assertRaisesRegex(run_objects.InputError, "objects.json"):
                    run_objects.read_objects(self.path)
        (self.dir / "objects_observations.json").write_text("[" * 100000)
        content = {"objects": [make_object(4, 1)]}
        with self.assertRaisesRegex(ValueError, "objects_observations.json is not valid JSON"):
            object_entries.attach_observations(self.path, content)


if __name__ == "__main__":
    unittest.main()
