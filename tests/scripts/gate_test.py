#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/paper_tables/gate.py: what is a wrong frame, and which differences count."""

import copy
import math
import pathlib
import random
import sys
import tempfile
import unittest

import numpy as np

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
from paper_tables.gate import Comparison, figures_of_poses, frame_line  # noqa: E402
from tum_and_icl import align, align_most, move, pair  # noqa: E402

CASES, RUNS = 12, 3


def make_run(case, mode, variant, seed, **figures):
    return {"case": case, "sequence": case, "mode": mode, "variant": variant, "seed": seed,
            "input": "0", "failure": None, "track_ms": 20.0,
            "figures": {"ate_se3": 0.010, "ate_sim3": 0.010, "lost": 0.0, "wrong": 0.0, "unknown": 0.0,
                        "frames": 100.0, "objects": None, "found": 0.8, "siou": 0.8,
                        "scale_error": 0.001, **figures}}


def make_report():
    runs = {}
    for mode in ("rgbd", "mono"):
        for variant in ("points", "objects"):
            for case in range(CASES):
                for seed in range(RUNS):
                    runs[f"case{case}/{mode}/{variant}/{seed}"] = make_run(
                        f"case{case}", mode, variant, seed)
    return runs


def disturb(runs, draw, spread):
    for run in runs.values():
        run["figures"]["ate_se3"] *= math.exp(draw.gauss(0.0, 0.05))
        run["figures"]["ate_sim3"] *= math.exp(draw.gauss(0.0, spread))
        run["figures"]["siou"] += draw.gauss(0.0, 0.004)


class ComparisonTest(unittest.TestCase):
    def setUp(self):
        self.before = make_report()
        disturb(self.before, random.Random(1), 0.05)
        self.after = copy.deepcopy(self.before)

    def set(self, name, **figures):
        self.after[name]["figures"] |= figures

    def compare(self):
        return Comparison(self.before, self.after)

    def test_equal_runs_are_the_same(self):
        found = self.compare()
        self.assertFalse(found.is_worse())
        self.assertEqual({entry[2] for case in found.cases.values() for entry in case.values()},
                         {"same"})

    def test_chance_is_no_difference(self):
        """Ten builds whose errors differ by 5 % with depth, and by 5 or 15 % without, at random: at
        most one false alarm."""
        alarms = 0
        for number in range(10):
            self.after = copy.deepcopy(self.before)
            disturb(self.after, random.Random(100 + number), 0.05 if number % 2 else 0.15)
            alarms += self.compare().is_worse()
        self.assertLessEqual(alarms, 1)

    def test_a_case_that_is_worse_by_more_than_its_spread(self):
        """A sequence with fast turns as two builds of this project had it."""
        disturb(self.after, random.Random(2), 0.05)
        for seed, (old, new) in enumerate(((7.7, 9.5), (7.7, 9.6), (7.8, 9.5), (7.1, 9.8))):
            name = f"turns/rgbd/points/{seed}"
            for runs, value in ((self.before, old), (self.after, new)):
                runs[name] = make_run("turns", "rgbd", "points", seed, ate_se3=value / 1e3)
        found = self.compare()
        change, limit, verdict = found.cases["turns", "rgbd", "points"]["ate"]
        self.assertEqual(verdict, "worse")
        self.assertAlmostEqual(change, statistics_median([9.5 / 7.7, 9.6 / 7.7, 9.5 / 7.8, 9.8 / 7.1]))
        self.assertLess(limit, change)
        self.assertTrue(found.is_worse())
        self.before, self.after = self.after, self.before
        self.assertEqual(self.compare().cases["turns", "rgbd", "points"]["ate"][2], "better")

    def test_a_small_change_of_nearly_all_runs(self):
        for name, run in self.after.items():
            if run["mode"] == "mono" and run["variant"] == "points":
                run["figures"]["ate_sim3"] *= 0.99 if name.startswith("case0/") else 1.03
        found = self.compare()
        self.assertEqual(found.families["all", "mono", "points"]["ate"][2], "worse")
        self.assertEqual(found.families["all", "mono", "objects"]["ate"][2], "same")
        self.assertEqual(found.cases["case1", "mono", "points"]["ate"][2], "same",
                         "3 % of a single case matter to nobody")
        self.assertTrue(found.is_worse())

    def test_a_single_disaster_counts(self):
        name = "case3/mono/points/1"
        for figures in ({"ate_sim3": 0.025}, {"lost": 40.0, "unknown": 40.0}, {"wrong": 20.0}):
            with self.subTest(figures):
                self.after = copy.deepcopy(self.before)
                self.set(name, **figures)
                found = self.compare()
                self.assertEqual([entry[0] for entry in found.disasters], [name])
                self.assertTrue(found.is_worse())
        self.after = copy.deepcopy(self.before)
        self.set("case3/rgbd/points/1", ate_se3=0.016)
        self.assertTrue(self.compare().is_worse(), "with depth, errors vary less")
        # The case had as bad a run before, with another first frame.
        self.before["case3/mono/points/0"]["figures"]["wrong"] = 50.0
        self.after = copy.deepcopy(self.before)
        self.set(name, wrong=20.0)
        self.assertEqual(self.compare().disasters, [])

    def test_lost_is_better_than_wrong(self):
        self.before["case3/mono/points/0"]["figures"] |= {"wrong": 30.0, "unknown": 30.0}
        self.set("case3/mono/points/0", lost=30.0, wrong=0.0, unknown=30.0)
        self.assertFalse(self.compare().is_worse())
        self.before, self.after = self.after, self.before
        self.assertTrue(self.compare().is_worse())

    def test_errors_of_different_parts_are_not_compared(self):
        """A run that now knows the difficult part has a larger error."""
        name = "case3/mono/points/1"
        self.before[name]["figures"] |= {"lost": 40.0, "unknown": 40.0}
        self.set(name, ate_sim3=0.025)
        self.assertFalse(self.compare().is_worse())
        self.before[name]["figures"] |= {"lost": 2.0, "unknown": 2.0}
        self.assertTrue(self.compare().is_worse())

    def test_a_crash_counts(self):
        self.after["case1/rgbd/points/0"]["failure"] = "crashed with SIGSEGV"
        self.assertTrue(self.compare().is_worse())
        self.before["case1/rgbd/points/0"]["failure"] = "crashed with SIGSEGV"
        self.assertFalse(self.compare().is_worse())

    def test_objects_count(self):
        for seed in range(RUNS):
            self.set(f"case2/rgbd/objects/{seed}", found=0.5)
        found = self.compare()
        self.assertEqual(found.cases["case2", "rgbd", "objects"]["found"][2], "worse")
        self.assertTrue(found.is_worse())

    def test_of_a_monocular_run_the_scale_does_not_count(self):
        for seed in range(RUNS):
            self.set(f"case2/mono/objects/{seed}", scale_error=0.5)
        self.assertFalse(self.compare().is_worse())
        for seed in range(RUNS):
            self.set(f"case2/rgbd/objects/{seed}", scale_error=0.016)
        self.assertTrue(self.compare().is_worse())

    def test_figures_that_are_not_known_are_no_difference(self):
        for run in self.after.values():
            run["figures"] |= dict.fromkeys(("ate_se3", "ate_sim3", "siou", "scale_error"))
        self.assertFalse(self.compare().is_worse())

    def test_counts_of_frames(self):
        self.set("case0/rgbd/points/0", lost=10.0, wrong=3.0)
        line = frame_line("now", list(self.after.values()))
        self.assertIn(f"{100 * len(self.after)} frames in {len(self.after)} runs, 10 without a pose, 3 "
                      "with a wrong one", line)


def statistics_median(ratios):
    logs = sorted(map(math.log, ratios))
    return (logs[1] + logs[2]) / 2.0


class AlignmentTest(unittest.TestCase):
    def setUp(self):
        self.points = np.random.default_rng(1).normal(size=(20, 3))
        self.turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])

    def test_recovers_a_motion_and_a_scale_if_asked_for(self):
        for scale in (1.0, 2.5):
            moved = scale * self.points @ self.turn.T + [1, 2, 3]
            found = align(self.points, moved, scale != 1.0)
            self.assertAlmostEqual(found[0], scale)
            np.testing.assert_allclose(found[1], self.turn, atol=1e-12)
            np.testing.assert_allclose(found[2], [1, 2, 3], atol=1e-12)
        self.assertEqual(align(self.points, moved)[0], 1.0)

    def test_never_mirrors(self):
        _, rotation, _ = align(self.points, self.points * [1, 1, -1])
        self.assertAlmostEqual(np.linalg.det(rotation), 1.0)

    def test_pairs_are_one_to_one_and_the_nearest_first(self):
        pairs = pair(np.array([1.0, 1.012, 5.0]), np.array([0.5, 1.010, 5.03]))
        self.assertEqual(pairs.tolist(), [[1, 1]])
        self.assertEqual(len(pair(np.array([1.0]), np.array([2.0]))), 0)


class PosesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        (self.dir / "out").mkdir()
        t = np.linspace(0.0, 1.0, 101)
        self.truth = np.stack([10.0 * t, np.sin(6.0 * t), 0.3 * np.cos(9.0 * t)], axis=1)
        turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        self.estimate = self.truth @ turn.T + [1.0, 2.0, 3.0]

    def figures(self, mode, frames=101):
        for name, points in (("groundtruth.txt", self.truth), ("out/trajectory.txt", self.estimate)):
            (self.dir / name).write_text("".join(
                f"{i / 10:.6f} {x:.9f} {y:.9f} {z:.9f} 0 0 0 1\n"
                for i, (x, y, z) in enumerate(points)))
        return figures_of_poses(self.dir, mode, frames)

    def test_right_poses(self):
        for mode in ("rgbd", "mono"):
            self.assertEqual(self.figures(mode)["wrong"], 0.0)
        self.assertLess(self.figures("rgbd")["scale_error"], 1e-6)

    def test_a_wrong_part_does_not_spoil_the_rest(self):
        self.estimate[70:] += np.array([0.0, 4.0, 3.0])
        for mode in ("rgbd", "mono"):
            self.assertAlmostEqual(self.figures(mode)["wrong"], 100.0 * 31 / 101)
        errors = np.linalg.norm(move(align(self.estimate, self.truth), self.estimate) - self.truth,
                                axis=1)
        self.assertGreater((errors > 0.5).sum(), 70, "least squares would call most frames wrong")

    def test_frames_without_a_pose_are_not_wrong(self):
        self.truth, self.estimate = self.truth[:50], self.estimate[:50]
        self.estimate[40:] += np.array([0.0, 4.0, 3.0])
        self.assertAlmostEqual(self.figures("rgbd", frames=101)["wrong"], 100.0 * 10 / 101)

    def test_the_scale(self):
        self.estimate *= 1.02
        self.assertAlmostEqual(self.figures("rgbd")["scale_error"], math.log(1.02), places=5)
        self.assertIsNone(self.figures("mono")["scale_error"])

    def test_runs_without_poses(self):
        self.assertEqual(figures_of_poses(self.dir, "rgbd", 101.0),
                         {"wrong": 0.0, "scale_error": None})
        self.assertEqual(figures_of_poses(self.dir, "rgbd", None),
                         {"wrong": None, "scale_error": None})

    def test_the_alignment_of_most_points_ignores_the_others(self):
        rng = np.random.default_rng(5)
        source = rng.normal(size=(100, 3))
        target = 2.0 * source + [1.0, 0.0, -1.0]
        target[:45] = rng.normal(size=(45, 3)) * 5.0
        scale, rotation, shift = align_most(source, target, True)
        self.assertAlmostEqual(scale, 2.0)
        np.testing.assert_allclose(rotation, np.eye(3), atol=1e-9)
        np.testing.assert_allclose(shift, [1.0, 0.0, -1.0], atol=1e-9)
        again = align_most(source, target, True)
        self.assertEqual(scale, again[0], "the same to the bit")


if __name__ == "__main__":
    unittest.main()
