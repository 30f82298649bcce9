#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/report.py: it passes its arguments on to the program."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "report.py"


class Report(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.program = pathlib.Path(self.folder.name) / "view"
        self.program.write_text('#!/bin/sh\necho "$@"\nexit 2\n', encoding="utf-8")
        self.program.chmod(0o755)

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, "-B", str(SCRIPT), "--programs", self.folder.name,
                               *arguments], text=True, capture_output=True, check=False)

    def test_the_program_gets_the_folder_and_its_exit_code_is_kept(self):
        result = self.run_script("out", "--output", "a b.html")
        self.assertEqual(result.stdout, "out --report --output a b.html\n")
        self.assertEqual(result.returncode, 2)

    def test_a_missing_program_is_named(self):
        self.program.unlink()
        result = self.run_script("out")
        self.assertEqual(result.returncode, 2)
        self.assertIn(f"{self.program}: no such program", result.stderr)

    def test_the_folder_is_required(self):
        result = self.run_script()
        self.assertEqual(result.returncode, 2)
        self.assertIn("RUN_DIR", result.stderr)


if __name__ == "__main__":
    unittest.main()
