# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder with small programs, a sequence and tables, for tests of scripts/reproduce_tables.py."""

import json
import pathlib
import sys
import tempfile
import unittest

import fake_slam
from in_process import run_main

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "reproduce_tables.py"
sys.path.insert(0, str(SCRIPT.parent))
import reproduce_tables  # noqa: E402

DEFINITIONS = """
variants:
  points: {label: points only, masks: false}
  good: {label: good}
  bad: {label: bad, arguments: [--set, objects.residual=bad]}
  global: {label: global shutter, arguments: [--set, Camera.readout_time=0], same_as: good}
paper_sequences: {fr1-desk: desk, fr2-desk: freiburg2_desk, office-traj0: traj0_frei_png}
tables:
  I:
    title: Pose error
    figures: [ate, lost]
    paper: ate
    baseline: good
    rows: [{variant: points, paper: ORB-SLAM2}, {variant: good, paper: paper}, bad, global]
  II:
    title: Mapping quality
    figures: [siou, mtd, found]
    rows: [good, bad]
  VI:
    title: Robustness
    modes: [rgbd]
    figures: [ate, lost]
    rows: [points, good]
    degradations: [features, mask_drop]
degradations:
  features: {label: features, levels: [500, 100], arguments: [--set, "n={level}"]}
  mask_drop: {label: masks missing, levels: [0.5], options: [--mask-drop, "{level}"], only_with_objects: true}
claims:
  - {text: Good is better than bad, figure: ate, better: good, than: [bad]}
"""


class TablesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.programs = fake_slam.write_programs(self.dir / "bin")
        self.desk = fake_slam.write_tum(self.dir / "desk")
        self.definitions = self.dir / "tables.yaml"
        self.definitions.write_text(DEFINITIONS)
        self.out = self.dir / "out"

    def command(self, *arguments, sequence=True, out=None):
        return [SCRIPT, "--programs", self.programs, "--definitions", self.definitions, "--jobs", "2",
                "--out", out or self.out, *(["--sequence", self.desk] if sequence else []),
                *map(str, arguments)]

    def run_script(self, *arguments, **options):
        return run_main(reproduce_tables.main, *self.command(*arguments, **options)[1:])

    def succeed(self, *arguments, **options):
        result = self.run_script(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def assert_refused(self, result, *parts, code=2):
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertNotIn("Traceback", result.stderr)

    def calls(self):
        path = self.programs / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def behave(self, *words):
        (self.programs / "behaviour").write_text(" ".join(words))

    def report(self, out=None):
        return json.loads(((out or self.out) / "tables" / "tables.json").read_text())

    def files(self, out=None):
        return {path.name: path.read_bytes() for path in ((out or self.out) / "tables").iterdir()}
