#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/object_table.py: the table of a small run, and broken files."""

import json
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "object_table.py"


def make_object(**changes):
    return {"id": 4, "class": "cup", "state": "mapped", "half_axes": [0.04, 0.06, 0.05], "siou": 0.8125,
            "siou_mask": None, "tangent_px": 2.5, "parallax_deg": 90.0, "observations": 2, **changes}


class ObjectTableTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name) / "desk"
        self.dir.mkdir()

    def run_script(self, *objects, arguments=()):
        (self.dir / "objects.json").write_text(json.dumps({"objects": objects}))
        return subprocess.run([SCRIPT, self.dir, *arguments], capture_output=True, text=True,
                              check=False, timeout=60)

    def test_one_row_per_object(self):
        result = self.run_script(make_object(), make_object(id=5, state="candidate"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.splitlines()[2:],
                         ["| desk | 4 | cup | 2 | 90 | 0.060 0.050 0.040 | 0.812 | - | 2.50 |"])

    def test_objects_below_the_least_angle_are_left_out(self):
        result = self.run_script(make_object(), arguments=["--min-angle", "91"])
        self.assertEqual(len(result.stdout.splitlines()), 2)

    def test_broken_files(self):
        for entry in ({"state": "mapped"}, make_object(half_axes=["a"]), make_object(siou="x"),
                      make_object(observations=[1]), 3):
            with self.subTest(entry):
                result = self.run_script(entry)
                self.assertEqual(result.returncode, 2)
                self.assertTrue(result.stderr.startswith("error: "), result.stderr)
                self.assertIn("objects.json", result.stderr)


if __name__ == "__main__":
    unittest.main()
