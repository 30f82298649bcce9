#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/reproduce_tables.py with small programs instead of those of HullSLAM: which runs
are made, and how two reports are compared."""

import json
import shutil
import unittest

import fake_slam
from fake_tables import TablesTest


class RunsTest(TablesTest):
    def test_every_different_run_is_made_once(self):
        self.succeed("--seeds", 2)
        calls = self.calls()
        # Table I has three different rows in two modes, table II none of its own, and table VI two
        # rows with two numbers of features, and one with worse masks; two seeds each.
        self.assertEqual(len(calls), 2 * (3 * 2 + 2 * 2 + 1))
        self.assertEqual(len({call.split(" --output ")[1] for call in calls}), len(calls))
        self.assertIn(f"rgbd_tum {self.desk} --first 1 --seed 1 --masks {self.desk}/masks --quiet "
                      "--output runs/desk/rgbd/good/seed-1/out", calls)
        self.assertIn(f"mono_tum {self.desk} --first 0 --seed 0 --quiet "
                      "--output runs/desk/mono/points/seed-0/out", calls)
        self.assertTrue(any("--set n=100 --first" in call for call in calls))
        degraded = [call for call in calls if "degraded/" in call]
        self.assertEqual(len(degraded), 2)
        for call in degraded:  # the name of the degraded folder does not tell the camera
            self.assertIn(f" --settings {self.desk}/camera.yaml ", call)
        self.assertEqual(sorted(self.files()), ["tables.csv", "tables.json", "tables.md", "tables.tex"])
        self.assertEqual([path for path in (self.out / "degraded").rglob("seed-*") if path.is_dir()],
                         [], "degraded sequences are removed after their runs")
        self.assertTrue((self.out / "runs/desk/rgbd/good/seed-1/log.txt").exists())

    def test_figures_of_the_runs(self):
        self.succeed("--seeds", 3, "--tables", "I,II")
        runs = self.report()["runs"]
        figures = runs["desk/rgbd/bad/seed-1"]["figures"]
        self.assertAlmostEqual(figures["ate_se3"], 0.022)
        self.assertAlmostEqual(figures["ate_sim3"], 0.0198)
        self.assertAlmostEqual(figures["found"], 6 / 8)
        self.assertAlmostEqual(figures["centre"], 0.2)
        self.assertEqual([figures[key] for key in ("ap25", "ar25", "centre_mm", "axes")], [0.6, 0.7, 0.02, 0.1])
        self.assertAlmostEqual(figures["mtd"], 1e-3)
        # One unit of length of a monocular run has two metres.
        self.assertAlmostEqual(runs["desk/mono/bad/seed-1"]["figures"]["mtd"], 4e-3)
        text = (self.out / "tables" / "tables.md").read_text()
        self.assertIn("| bad | 22.00 (20.00..24.00) | 19.80 (18.00..21.60) | 0.0 (0.0..0.0) | – | 3 |",
                      text)
        self.assertIn("| points only | **11.00 / 9.90 [17.10]** | – | – | +0.0 % (p 1, 3 pairs) |",
                      text)
        self.assertIn("global shutter: the runs of good", text)
        self.assertIn("| Good is better than bad | RGB-D | unclear | good: against bad -50.0 % "
                      "(p 0.25, 3 pairs) |", text)

    def test_the_suite_is_rendered_once_for_each_seed(self):
        arguments = ("--suite", "synthetic", "--seeds", 2, "--frames", 30)
        self.succeed(*arguments, sequence=False)
        renderings = (self.programs / "renderings").read_text().splitlines()
        self.assertEqual(len(renderings), 5, "a list of the sequences, and two of two")
        self.assertEqual({"--only desk1 --frames 30", "--only icl0 --frames 30"},
                         {text.split("--threads")[0].split("--seed")[1][3:].strip()
                          for text in renderings[1:]})
        folder = "sequences/desk1/seed-1-frames-30/desk1"
        self.assertTrue(any(call.startswith(f"mono_tum {folder} --seed 1 --masks {folder}/masks")
                            for call in self.calls()))
        self.assertTrue(any(call.startswith("rgbd_icl ") for call in self.calls()))
        before = self.files()
        self.succeed(*arguments, sequence=False)
        self.assertEqual(len((self.programs / "renderings").read_text().splitlines()), 5)
        self.assertEqual(self.files(), before)
        report = self.report()
        self.assertEqual(report["sequences"]["icl0"]["paper"], "office-traj0")
        self.assertIsNotNone(report["runs"]["icl0/rgbd/good/seed-0"]["figures"]["ate_se3"])

    def test_quick_takes_two_sequences_and_one_seed(self):
        shutil.copytree(self.desk, self.dir / "other")
        result = self.succeed("--suite", "synthetic", "--sequence", self.dir / "other", "--quick",
                              "--tables", "I,VI")
        # The first lines come before anything is rendered or run.
        self.assertEqual(result.stderr.splitlines()[:2], ["asking make_synthetic for its sequences",
                                                          "0 of 12 runs, 3 sequences to make"])
        runs = self.report()["runs"]
        self.assertEqual({run["variant"] for run in runs.values()}, {"points", "good"})
        self.assertEqual({run["sequence"] for run in runs.values()}, {"desk", "icl0"})
        self.assertEqual({run["mode"] for run in runs.values() if run["sequence"] == "icl0"}, {"rgbd"})
        self.assertEqual({run["seed"] for run in runs.values()}, {0})
        self.assertEqual({run["level"] for run in runs.values()}, {None, "500", "0.5"})
        self.assertTrue(any("--first 0 --last 39 --seed" in call for call in self.calls()))

    def test_only_and_modes(self):
        self.succeed("--suite", "synthetic", "--only", "office-traj0", "--modes", "mono", "--seeds",
                     1, "--tables", "I", sequence=False)
        self.assertEqual({call.split()[0] for call in self.calls()}, {"mono_icl"})

    def test_list_and_dry_run_run_nothing(self):
        listed = self.succeed("--seeds", 1, "--list").stdout
        self.assertIn("11 different runs, 0 of them done; 220 images to process", listed)
        self.assertIn("  to do  desk/rgbd/good/seed-0", listed)
        self.assertFalse(self.out.exists())
        dry = self.succeed("--seeds", 1, "--dry-run").stdout
        self.assertRegex(dry, r"run +11")
        self.assertEqual(self.calls(), [])
        self.succeed("--seeds", 1)
        self.assertIn("11 of them done; 0 images", self.succeed("--seeds", 1, "--list").stdout)

    def test_sequences_without_depth_or_masks(self):
        mono = fake_slam.write_tum(self.dir / "mono", with_depth=False)
        shutil.rmtree(mono / "masks")
        self.succeed("--sequence", mono, "--seeds", 1, sequence=False)
        self.assertEqual([call.split()[0] for call in self.calls()], ["mono_tum"])
        text = (self.out / "tables" / "tables.md").read_text()
        self.assertIn("– the sequence has no masks: mono, good; mono, bad; mono, global shutter.",
                      text)
        self.assertIn("– the sequence has no depth: mono, points only;", text)


class CompareTest(TablesTest):
    def test_differences_from_an_older_report(self):
        arguments = ("--seeds", 6, "--tables", "I", "--modes", "rgbd")
        self.succeed(*arguments)
        old = self.dir / "old.json"
        shutil.copy(self.out / "tables" / "tables.json", old)
        path = self.programs / "rgbd_tum"
        path.write_text(path.read_text().replace("(2 if bad else 1)", "(1 if bad else 1)")
                        .replace("abc1234", "def5678"))
        self.succeed(*arguments, "--compare", old)
        text = (self.out / "tables" / "compare.md").read_text()
        self.assertIn("# Differences since abc1234 (now def5678)", text)
        self.assertIn("| bad | rgbd | -50.0 % (p 0.031, 6 pairs), better |", text)
        self.assertIn("| good | rgbd | +0.0 % (p 1, 6 pairs), unclear |", text)
        found = json.loads((self.out / "tables" / "compare.json").read_text())
        self.assertEqual(found["rows"][0]["common"], 6)


if __name__ == "__main__":
    unittest.main()
