#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/report.py with a replacement of the program `view`."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


class ReportTest(unittest.TestCase):
    def test_view_does_the_work(self):
        with tempfile.TemporaryDirectory() as folder:
            top = pathlib.Path(folder)
            (top / "scripts").mkdir()
            for name in ("report.py", "support.py"):
                shutil.copy(SCRIPTS / name, top / "scripts")
            command = [top / "scripts" / "report.py", "out", "--output", "a b.html"]
            missing = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual(missing.returncode, 2)
            self.assertIn("view: no such program; build it", missing.stderr)
            view = top / "build" / "release" / "bin" / "view"
            view.parent.mkdir(parents=True)
            view.write_text('#!/bin/bash\nprintf "%s|" "$@"\nexit 2\n')
            view.chmod(0o755)
            called = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual((called.returncode, called.stdout), (2, "--report|out|--output|a b.html|"))


if __name__ == "__main__":
    unittest.main()
