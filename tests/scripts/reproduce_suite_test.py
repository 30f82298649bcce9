#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/reproduce_tables.py --suite synthetic --quick with the programs of HullSLAM: the tables are
complete, and a kill in the middle does not change a byte of them.

HULLSLAM_BIN names the folder of the programs; without it the test is skipped.
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "reproduce_tables.py"
PROGRAMS = os.environ.get("HULLSLAM_BIN", "")
FRAMES = 24  # enough for objects, and few enough for a test
TABLES = ("tables.md", "tables.tex", "tables.csv", "tables.json")


@unittest.skipUnless(PROGRAMS, "HULLSLAM_BIN is not set")
class QuickSuiteTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "out"
        self.command = [SCRIPT, "--suite", "synthetic", "--quick", "--frames", str(FRAMES),
                        "--modes", "rgbd", "--out", self.out, "--programs", PROGRAMS, "--quiet"]

    def run_script(self):
        result = subprocess.run(self.command, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        return {name: (self.out / "tables" / name).read_bytes() for name in TABLES}

    def results(self):
        # Not "**", which also looks into output folders that are renamed meanwhile.
        return list(self.out.glob("runs/*/*/*/*/result-*.json"))

    def kill_after(self, count):
        """Kills the script when so many runs are done."""
        with subprocess.Popen(self.command, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and len(self.results()) < count:
                time.sleep(0.05)
            process.send_signal(signal.SIGKILL)

    def test_quick_suite(self):
        self.kill_after(10)
        first = self.run_script()
        report = json.loads(first["tables.json"])
        self.check_report(report)
        # Some runs are made again, and the script is killed in the middle of that.
        for name in list(report["runs"])[::9]:
            shutil.rmtree(self.out / "runs" / name)
        self.kill_after(len(report["runs"]) - 5)
        self.assertEqual(set(self.run_script().items()), set(first.items()))

    def check_report(self, report):
        self.assertEqual({table["table"] for table in report["tables"]},
                         {"I", "II", "III", "IV", "V", "VI", "VII"})
        self.assertEqual({sequence["dataset"] for sequence in report["sequences"].values()},
                         {"tum", "icl"})
        for name, run in report["runs"].items():
            with self.subTest(name):
                if run["degradation"] is None:
                    self.assertIsNone(run["failure"])
                    self.assertGreater(run["figures"]["ate_se3"], 0.0)
                    preset = report["variants"][run["variant"]]["arguments"][1]
                    self.assertEqual(run["preset"], preset)
                elif run["failure"]:
                    self.assertNotIn("crashed", run["failure"])
        # Of the rows with objects, some must have mapped objects.
        for variant in ("paper", "hullslam"):
            self.assertTrue(any(run["figures"].get("siou") for run in report["runs"].values()
                                if run["variant"] == variant), variant)


if __name__ == "__main__":
    unittest.main()
