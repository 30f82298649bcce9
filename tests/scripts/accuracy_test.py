#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/accuracy.py with small programs instead of those of HullSLAM."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import fake_slam
from in_process import run_main

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "accuracy.py"
sys.path.insert(0, str(SCRIPT.parent))
import accuracy  # noqa: E402
from paper_tables.definitions import read_definitions  # noqa: E402

CASES = """
variants: {points: {masks: false}, objects: {}}
degradations:
  sixth: {label: sixth, levels: [6], arguments: [--stride, "{level}"]}
  late: {label: late, levels: [5], options: [--late, "{level}"]}
renderings: {room: [--scene, room]}
cases:
  desk: {recorded: desk, first: [0, 3], last: 9}
  late: {recorded: desk, degradation: late, modes: [rgbd], variants: [points]}
  walk: {rendering: room, seeds: [0, 2], degradation: sixth, variants: [points]}
  suite: {suite: icl0, modes: [rgbd]}
"""


class AccuracyTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.programs = fake_slam.write_programs(self.dir / "bin")
        self.desk = fake_slam.write_tum(self.dir / "data" / "desk")
        self.out, self.cases = self.dir / "out", self.dir / "accuracy.yaml"
        self.cases.write_text(CASES)
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments):
        command = ["git", "-C", self.dir, "-c", "user.name=a", "-c", "user.email=a@b", *arguments]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()

    def commit(self):
        """Commits the cases, and makes the programs those of this commit."""
        self.git("add", self.cases)
        self.git("commit", "-q", "--allow-empty", "-m", "cases")
        (self.programs / "git").write_text(self.git("describe", "--always"))

    def arguments(self, *arguments):
        return ["--programs", self.programs, "--tools", self.programs, "--definitions", self.cases,
                "--data", self.dir / "data", "--renderings", self.dir / "renderings", "--jobs", "2",
                "--quiet", "--out", self.out, *arguments]

    def run_script(self, *arguments, code=0):
        """In this process, with an accepted file of its own, so that the one of this project plays
        no part."""
        with mock.patch.object(accuracy, "ACCEPTED", self.dir / "docs" / "accuracy.json"), \
                mock.patch.object(accuracy, "TOP", self.dir):
            result = run_main(accuracy.main, *self.arguments(*arguments))
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def call_main(self, *arguments, code=0):
        result = self.run_script(*arguments, code=code)
        return code, result.stdout + result.stderr

    def calls(self):
        return (self.programs / "calls").read_text().splitlines()

    def behave(self, *words):
        (self.programs / "behaviour").write_text(" ".join(words))

    def rendered(self):
        """The calls of make_synthetic but those for the probe."""
        calls = (self.programs / "renderings").read_text().splitlines()
        return [call for call in calls if "/probe " not in call]

    def runs(self):
        return json.loads((self.out / "accuracy.json").read_text())["runs"]

    def test_the_runs_of_the_cases(self):
        _, told = self.call_main()
        self.assertIn("does not exist, so nothing is compared", told)
        calls = self.calls()
        self.assertEqual(len(calls), 2 * 2 * 2 + 1 + 2 * 2 + 2)
        self.assertIn(f"rgbd_tum {self.desk} --first 3 --last 9 --seed 3 --masks {self.desk}/masks "
                      "--quiet --output runs/desk/rgbd/objects/seed-3/out", calls)
        room = next((self.dir / "renderings").glob("room-2-*"))
        self.assertIn(f"mono_tum {room} --stride 6 --first 0 --seed 0 --quiet --output "
                      "runs/room-2/mono/points+sixth-6/seed-0/out", calls)
        self.assertTrue(any(f"--settings {self.desk}/camera.yaml" in call for call in calls
                            if "desk+late-5" in call))
        self.assertTrue(any("rgbd_icl" in call and "icl0-0-" in call and "--masks" in call
                            for call in calls))
        self.assertEqual(len(self.rendered()), 3)
        run = self.runs()["desk/rgbd/objects/seed-3"]
        self.assertEqual((run["case"], run["mode"], run["variant"]), ("desk", "rgbd", "objects"))
        self.assertAlmostEqual(run["figures"]["ate_se3"], 0.013)
        self.assertEqual(run["figures"]["wrong"], 0.0)
        self.assertEqual((run["figures"]["found"], run["figures"]["objects"]), (0.75, None),
                         "more objects may be wrong ones, so the found ones count")
        # It goes on where it was, and renders nothing twice.
        self.call_main()
        self.assertEqual(self.calls(), calls)
        self.assertEqual(len(self.rendered()), 3)
        # Another renderer and other options render anew, and never use what is there.
        with (self.programs / "make_synthetic").open("a") as program:
            program.write("# another renderer\n")
        self.call_main("--only", "walk")
        self.assertEqual(len(self.rendered()), 5)
        self.cases.write_text(CASES.replace("[--scene, room]", "[--scene, room, --readout-time, 0.02]"))
        self.call_main("--only", "walk")
        self.assertEqual(len(self.rendered()), 7)

    def test_figures_of_another_input_are_not_compared(self):
        self.run_script("--only", "desk,suite")
        old = self.dir / "old.json"
        report = json.loads((self.out / "accuracy.json").read_text())
        name = "desk/rgbd/points/seed-3"
        report["runs"][name]["input"] = "0123"
        old.write_text(json.dumps(report))
        self.behave("worse")
        self.out = self.dir / "other"
        told = self.run_script("--only", "desk,suite", "--compare", old, code=1).stdout
        self.assertIn(f"not compared: {name} has another input than before: ATE, mm 39.00", told)
        self.assertNotIn(f"worse: {name}", told)
        self.assertIn("worse: desk/rgbd/points/seed-0", told)
        report["runs"] = {name: report["runs"][name]}
        old.write_text(json.dumps(report))
        self.assertIn("nothing to compare", self.run_script("--only", "desk", "--compare", old, code=2).stderr)

    def test_only_figures_of_a_commit_are_accepted(self):
        self.cases.write_text(CASES + "# changed\n")
        self.assertIn("changes that are not committed", self.call_main("--accept", code=2)[1])
        self.assertFalse((self.programs / "calls").exists(), "known before the runs")
        self.commit()
        for build in ("abc1234", self.git("describe", "--always") + "-dirty"):
            self.out = self.dir / build
            (self.programs / "git").write_text(build)
            self.assertIn(f"the runs are of {build}, and", self.call_main("--accept", code=2)[1])
        self.assertFalse((self.dir / "docs").exists())
        self.out = self.dir / "again"
        self.commit()
        self.call_main("--accept")
        report = json.loads((self.dir / "docs" / "accuracy.json").read_text())
        self.assertEqual(report["git"], [self.git("describe", "--always")])
        self.assertRegex(report["rendering"], "^[0-9a-f]{64}$")
        elsewhere = fake_slam.write_programs(self.dir.parent / f"{self.dir.name}-bin")
        self.addCleanup(shutil.rmtree, elsewhere)
        self.assertIn("is not a program of", self.call_main("--accept", "--tools", elsewhere, code=2)[1])

    def test_accepted_figures_and_worse_ones(self):
        self.call_main("--accept")
        _, told = self.call_main()
        self.assertIn("nothing got worse", told)
        self.behave("worse")
        self.out = self.dir / "worse"
        _, told = self.call_main(code=1)
        self.assertIn("worse: desk/rgbd/objects/seed-3: ATE, mm 13.00 -> 39.00", told)
        self.assertIn("something got worse", told)
        text = (self.out / "accuracy.md").read_text()
        self.assertIn("| desk | rgbd | objects | 2 | **11.50 -> 34.50 (+200 %, worse)** |", text)
        self.call_main("--accept")  # what is accepted is no error
        self.call_main()

    def test_a_part_can_be_accepted(self):
        self.call_main("--only", "desk", "--accept")
        self.call_main("--only", "suite", "--accept")  # a new case
        self.behave("worse")
        self.out = self.dir / "worse"
        self.call_main("--only", "suite", "--accept")
        runs = json.loads((self.dir / "docs" / "accuracy.json").read_text())["runs"]
        self.assertAlmostEqual(runs["desk/rgbd/objects/seed-3"]["figures"]["ate_se3"], 0.013)
        self.assertEqual({run["figures"]["ate_se3"] for run in runs.values() if run["case"] == "suite"},
                         {0.03}, "three times the error")

    def test_pairs_are_run_by_a_program_for_stereo_cameras(self):
        self.cases.write_text(CASES + "  pairs: {recorded: desk, modes: [stereo], variants: [points]}\n")
        _, told = self.call_main("--only", "pairs", code=2)
        self.assertIn("nothing to run", told)
        (self.desk / "right").mkdir()
        self.call_main("--only", "pairs")
        self.assertTrue(self.calls()[-1].startswith(f"stereo_folder {self.desk} "))
        run = self.runs()["desk/stereo/points/seed-0"]
        self.assertAlmostEqual(run["figures"]["ate_se3"], 0.01)
        self.assertIsNotNone(run["figures"]["scale_error"])

    def test_another_report(self):
        self.run_script("--only", "suite")
        old = self.dir / "old.json"
        (self.out / "accuracy.json").rename(old)
        self.behave("worse")
        self.out = self.dir / "other"
        result = self.run_script("--only", "suite", "--compare", old, code=1)
        build = self.git("describe", "--always")
        self.assertIn(f"{build}: 40 frames in 2 runs, 0 without a pose, 0 with a wrong one",
                      result.stdout)
        old.write_text(json.dumps({"version": 1, "git": [], "runs": {}}))
        self.assertIn("no run is in both", self.run_script("--only", "suite", "--compare", old,
                                                           code=2).stderr)

    def test_a_lost_run_counts(self):
        self.run_script("--only", "desk")
        old = self.out / "accuracy.json"
        self.behave("lost")
        self.out = self.dir / "other"
        result = self.run_script("--only", "desk", "--compare", old, code=1)
        self.assertIn("worse: desk/rgbd/points/seed-0: no right pose, % 0.0 -> 100.0", result.stdout)
        self.assertNotIn("worse: desk/rgbd/points/seed-3", result.stdout)

    def test_absent_recordings_are_skipped(self):
        self.desk.rename(self.dir / "elsewhere")
        _, told = self.call_main("--only", "desk,suite")
        self.assertIn("these cases are skipped: desk; --data says where", told)
        self.assertEqual(len(self.calls()), 2)
        _, told = self.call_main("--accept", code=2)
        self.assertIn("--accept: desk is absent", told)
        self.assertFalse((self.dir / "docs").exists())
        self.assertIn("nothing to run", self.run_script("--only", "desk", code=2).stderr)

    def test_the_runs_so_far(self):
        self.run_script("--only", "suite")
        calls = self.calls()
        self.run_script("--only", "suite,late", "--so-far")
        self.assertEqual(self.calls(), calls)
        self.assertEqual({run["case"] for run in self.runs().values()}, {"suite"})

    def test_quick_and_list(self):
        result = self.run_script("--list")
        self.assertIn("to do  desk: desk/rgbd/points/seed-0", result.stdout)
        self.assertIn("15 runs", result.stdout)
        self.assertFalse((self.programs / "calls").exists())
        self.run_script("--quick", "--only", "desk,walk")
        self.assertEqual(sorted(self.runs()), [
            "desk/mono/objects/seed-0", "desk/mono/points/seed-0", "desk/rgbd/objects/seed-0",
            "desk/rgbd/points/seed-0", "room-0/mono/points+sixth-6/seed-0",
            "room-0/rgbd/points+sixth-6/seed-0"])

    def test_bad_usage(self):
        for arguments, part in ((["--only", "desk,chair"], "--only: 'chair' is unknown"),
                                (["--only", ""], "--only: '' is unknown"),
                                (["--jobs", "0"], "--jobs: is '0'"),
                                (["--timeout", "nan"], "--timeout"),
                                (["--accept", "--quick"], "--accept needs all runs of its cases"),
                                (["--compare", self.cases], "not valid JSON"),
                                (["--compare", self.dir / "none"], "cannot read"),
                                (["--programs", self.dir, "--only", "desk"], "no such program")):
            with self.subTest(part):
                self.assertIn(part, self.run_script(*arguments, code=2).stderr)

    def test_bad_cases(self):
        for old, new, part in (("recorded: desk, first", "rendered: desk, first", "unknown key"),
                               ("recorded: desk, first", "first", "expected one of the keys recorded"),
                               ("first: [0, 3]", "first: [0, -3]", "cases.desk.first[1]: is '-3'"),
                               ("first: [0, 3]", "first: [0, 0]", "expected each entry once"),
                               ("first: [0, 3]", "seeds: [0]", "a recorded sequence has no seed"),
                               ("degradation: late", "degradation: rain", "cases.late.degradation"),
                               ("rendering: room", "rendering: hall", "cases.walk.rendering"),
                               ("last: 9", "last: 0", "cases.desk.last: is '0'"),
                               ("  late: {rec", "  a/b: {rec", "'a/b' is no name"),
                               ("cases:", "case:", "unknown key 'case'"),
                               ("degradation: late, modes", "first: [3], modes", "have the same run")):
            with self.subTest(new):
                self.assertIn(old, CASES)
                self.cases.write_text(CASES.replace(old, new))
                self.assertIn(part, self.run_script("--list", code=2).stderr)

    def test_the_cases_of_this_project(self):
        found = read_definitions(SCRIPT.parent / "paper_tables" / "accuracy.yaml", "cases")
        suite = {case.sequence for case in found.cases.values() if case.source == "suite"}
        self.assertEqual(len(suite), 10)
        self.assertEqual({name for name, case in found.cases.items() if len(case.first) == 10},
                         {"walls"})
        self.assertEqual(set(found.degradations),
                         {case.degradation for case in found.cases.values()} - {None})
        self.assertEqual(set(found.renderings), {case.sequence for case in found.cases.values()
                                                 if case.source == "rendering"})


if __name__ == "__main__":
    unittest.main()
