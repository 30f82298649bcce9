#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/plot_ablation.py: what it reads, the picture it draws, and broken files."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plot_ablation.py"
sys.path.insert(0, str(SCRIPT.parent))
import plot_ablation  # noqa: E402


def result(variant, ate, tracked=300.0, failed=0, sequence="desk"):
    return {"sequence": sequence, "variant": variant, "failed": failed,
            "figures": {"ATE m": {"mean": ate, "sd": 0.001}, "tracked": {"mean": tracked}}}


class PlotAblationTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def write(self, content):
        (self.dir / "ablation.json").write_text(
            content if isinstance(content, str) else json.dumps(content))

    def run_script(self, content):
        self.write(content)
        return subprocess.run([SCRIPT, self.dir, "--output", self.dir / "curve.png"],
                              capture_output=True, text=True, check=False, timeout=100)

    def test_curves_are_sorted_and_in_millimetres(self):
        self.write([result("with-300", 0.002), result("with-30", 0.004), result("off-30", 0.006),
                    result("other", 0.001), result("off-300", None)])
        self.assertEqual(plot_ablation.read_points(self.dir), {"desk": {
            "with": [(30.0, 4.0, 1.0, True), (300.0, 2.0, 1.0, True)],
            "off": [(30.0, 6.0, 1.0, True)]}})

    def test_points_of_fewer_frames_or_failed_runs_are_not_complete(self):
        self.write([result("a-1", 0.1), result("a-2", 0.1, tracked=290.0),
                    result("a-3", 0.1, failed=1),
                    result("a-1", 0.1, tracked=80.0, sequence="short")])
        points = plot_ablation.read_points(self.dir)
        self.assertEqual([point[3] for point in points["desk"]["a"]], [True, False, False])
        self.assertEqual([point[3] for point in points["short"]["a"]], [True])

    def test_draws_a_picture(self):
        run = self.run_script([result("with-300", 0.002), result("with-30", 0.004, tracked=100.0)])
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual((self.dir / "curve.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_broken_files(self):
        for content in ("", "{", [3], [{"sequence": "desk"}], [result("with", 0.1)], []):
            with self.subTest(content):
                run = self.run_script(content)
                self.assertEqual(run.returncode, 2)
                self.assertTrue(run.stderr.startswith("error: "), run.stderr)
                self.assertIn("ablation.json", run.stderr)
                self.assertFalse((self.dir / "curve.png").exists())


if __name__ == "__main__":
    unittest.main()
