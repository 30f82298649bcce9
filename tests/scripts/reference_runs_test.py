#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/reference_runs.py, with small shell scripts instead of the programs."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "reference_runs.py"
# Writes a trajectory into the folder after --output, and a map file if it is asked for one.
PROGRAM = """#!/bin/sh
[ "$1" = map-objects ] && shift
content={content}
[ -f "$1/rgb.txt" ] || exit 2
while [ $# -gt 0 ]; do
  case "$1" in
    --output) mkdir -p "$2"; echo "$content $2" > "$2/trajectory.txt" ;;
    --save-map) echo "$content" > "$2" ;;
  esac
  shift
done
exit {code}
"""
SYNTHETIC = """#!/bin/sh
mkdir -p "$1"
echo desk > "$1/rgb.txt"
"""


class ReferenceRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "rgb.txt").touch()
        self.write_programs("poses")

    def write_programs(self, content, code=0):
        programs = {"make_synthetic": SYNTHETIC}
        for name in ("rgbd_tum", "mono_tum", "hullslam"):
            programs[name] = PROGRAM.format(content=content, code=code)
        for name, text in programs.items():
            path = self.folder / name
            path.write_text(text, encoding="utf-8")
            path.chmod(0o755)

    def run_script(self, action, *arguments):
        command = [sys.executable, "-B", SCRIPT, action, self.folder / "reference.json",
                   "--programs", self.folder, *arguments]
        return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                              check=False)

    def test_equal_programs_have_no_difference_in_another_folder(self):
        stored = self.run_script("store", "--sequence", self.folder, "--masks", self.folder)
        self.assertEqual(stored.returncode, 0, stored.stderr)
        compared = self.run_script("compare", "--sequence", self.folder, "--masks", self.folder)
        self.assertEqual(compared.returncode, 0, compared.stdout)
        self.assertIn("no difference", compared.stdout)

    def test_a_file_that_differs_is_named(self):
        self.run_script("store")
        self.write_programs("other poses")
        compared = self.run_script("compare")
        self.assertEqual(compared.returncode, 1)
        self.assertIn("desk/trajectory.txt differs", compared.stdout)
        self.assertIn("desk_saved/saved.map differs", compared.stdout)

    def test_a_run_that_is_missing_is_named(self):
        self.run_script("store")
        compared = self.run_script("compare", "--sequence", self.folder)
        self.assertEqual(compared.returncode, 1)
        self.assertIn("rgbd: only after", compared.stdout)

    def test_only_some_runs_can_be_compared(self):
        self.run_script("store")
        compared = self.run_script("compare", "--only", "desk", "desk_masks")
        self.assertEqual(compared.returncode, 0, compared.stdout)
        self.assertNotIn("desk_objects", compared.stdout)
        self.assertEqual(self.run_script("compare", "--only", "nonsense").returncode, 2)

    def test_a_changed_exit_code_is_a_difference(self):
        self.run_script("store")
        self.write_programs("poses", code=1)
        self.assertIn("desk/exit code differs", self.run_script("compare").stdout)

    def test_bad_input_is_an_error(self):
        self.write_programs("poses", code=2)
        refused = self.run_script("store")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("refused its input", refused.stderr)
        for text, told in (("[1]", "expected a JSON object"), ('{"a": 1}', "expected hashes")):
            (self.folder / "reference.json").write_text(text, encoding="utf-8")
            self.assertIn(told, self.run_script("compare").stderr)
        self.assertEqual(self.run_script("compare", "--masks", self.folder).returncode, 2)

    def test_stored_hashes_are_json_by_run(self):
        self.run_script("store")
        content = json.loads((self.folder / "reference.json").read_text(encoding="utf-8"))
        self.assertIn("trajectory.txt", content["desk_loaded"])


if __name__ == "__main__":
    unittest.main()
