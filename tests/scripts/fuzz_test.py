#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/fuzz.sh with replacements for cmake and for the fuzz targets."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


class FuzzTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        (self.top / "scripts").mkdir()
        for name in ("common.sh", "fuzz.sh"):
            shutil.copy(SCRIPTS / name, self.top / "scripts")
        self.stand_in("path/cmake", "true")
        for reader, executions in (("coco", 123), ("boxes", 7)):
            (self.top / "tests/fuzz/corpus" / reader).mkdir(parents=True)
            self.stand_in(f"build/fuzz/bin/fuzz_{reader}",
                          f'echo "$*" >{self.top}/{reader}.called\n'
                          f'echo "stat::number_of_executed_units: {executions}"')

    def stand_in(self, name, body):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!/bin/bash\n{body}\n")
        path.chmod(0o755)

    def run_script(self, *arguments):
        path = f"{self.top / 'path'}:{os.environ['PATH']}"
        return subprocess.run([self.top / "scripts/fuzz.sh", *arguments], cwd="/", text=True,
                              env={**os.environ, "PATH": path}, capture_output=True, check=False)

    def test_all_readers_run_and_their_executions_are_printed(self):
        result = self.run_script("5")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"coco +123 executions")
        self.assertRegex(result.stdout, r"boxes +7 executions")
        self.assertIn("-max_total_time=5 ", (self.top / "coco.called").read_text())

    def test_given_readers_run_alone(self):
        result = self.run_script("5", "boxes")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("coco", result.stdout)

    def test_a_finding_is_reported_and_the_others_still_run(self):
        self.stand_in("build/fuzz/bin/fuzz_boxes", "exit 77")
        result = self.run_script("5")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stdout, r"boxes +finding, see .*build/fuzz/boxes.log")
        self.assertRegex(result.stdout, r"coco +123 executions")

    def test_wrong_arguments_are_refused(self):
        for arguments in ((), ("0",), ("soon",), ("5", "nothing"), ("--what",)):
            result = self.run_script(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertTrue(result.stderr.startswith("error: "), result.stderr)
        self.assertEqual(self.run_script("--help").returncode, 0)


if __name__ == "__main__":
    unittest.main()
