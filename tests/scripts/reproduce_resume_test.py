#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/reproduce_tables.py: it goes on where it was stopped, and repeats only what has
changed."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from fake_tables import DEFINITIONS, SCRIPT, TablesTest


def is_running(process):
    """Whether there is such a process that has not ended."""
    try:
        state = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


class ResumeTest(TablesTest):
    def test_finished_runs_are_kept(self):
        self.succeed("--seeds", 1)
        before, count = self.files(), len(self.calls())
        self.succeed("--seeds", 1)
        self.assertEqual(len(self.calls()), count)
        self.assertEqual(self.files(), before)
        self.succeed("--seeds", 2)
        self.assertEqual(len(self.calls()), 2 * count)

    def changed_runs(self, change):
        """How many runs are made again after a change."""
        arguments = ("--seeds", 1, "--tables", "I", "--modes", "rgbd")
        self.succeed(*arguments)
        count = len(self.calls())
        change()
        self.succeed(*arguments)
        return [call.split()[-1] for call in self.calls()[count:]]

    def test_only_what_changed_is_run_again(self):
        def add_mask():
            (self.desk / "masks" / "1.000000.txt").write_text("42 0.1 0.1 0.5 0.1 0.5 0.5 0.9\n")

        def change(name):
            path = self.desk / name
            return lambda: path.write_text(path.read_text() + "\n# changed\n")

        def build():
            path = self.programs / "rgbd_tum"
            path.write_text(path.read_text() + "\n# another build\n")
        with_masks = {f"runs/desk/rgbd/{name}/seed-0/out" for name in ("good", "bad")}
        every = with_masks | {"runs/desk/rgbd/points/seed-0/out"}
        for name, action, expected in (
                ("masks", add_mask, with_masks), ("settings", change("camera.yaml"), every),
                ("sequence list", change("rgb.txt"), every), ("program", build, every),
                ("nothing", (self.desk / "rgb.txt").touch, set())):
            with self.subTest(name):
                self.assertEqual(set(self.changed_runs(action)), expected)

    def test_a_changed_preset_repeats_its_runs_only(self):
        config = self.dir / "config"
        shutil.copytree(SCRIPT.parent.parent / "config", config)
        preset = config / "presets" / "mine.yaml"
        preset.write_text("a: 1\n")
        self.definitions.write_text(DEFINITIONS.replace(
            "good: {label: good}", "good: {label: good, arguments: [--preset, mine]}"))
        os.environ["HULLSLAM_CONFIG"] = str(config)
        self.addCleanup(os.environ.pop, "HULLSLAM_CONFIG")
        again = self.changed_runs(lambda: preset.write_text("a: 2\n"))
        self.assertEqual(again, ["runs/desk/rgbd/good/seed-0/out"])

    def test_a_kill_at_any_moment_gives_the_same_tables(self):
        self.behave("slow")
        self.succeed("--seeds", 2, out=self.dir / "whole")
        for number, delay in enumerate((0.0, 1.2, 2.0, 2.8, 4.0)):
            process = subprocess.Popen(self.command("--seeds", 2), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(delay)
            # Only the script: what it has started must not hinder the next start.
            process.send_signal((signal.SIGKILL, signal.SIGTERM)[number % 2])
            process.wait()
        self.succeed("--seeds", 2)
        self.assertEqual(self.files(), self.files(self.dir / "whole"))

    def test_ctrl_c_ends_all_programs(self):
        self.behave("wait")
        process = subprocess.Popen(self.command("--seeds", 1), stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        while len(list(self.programs.glob("began-*"))) < 2:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 1)
        self.assertIn("interrupted; start again to go on", told)
        for path in self.programs.glob("began-*"):
            self.assertFalse(is_running(path.name.split("-")[1]))
        self.behave()
        self.succeed("--seeds", 1)

    def test_a_part_of_a_degraded_sequence_is_not_used(self):
        """As a kill leaves it while the sequence is removed."""
        arguments = ("--seeds", 1, "--tables", "VI")
        self.succeed(*arguments)
        before = self.files()
        plan = json.loads((self.out / "plan.json").read_text())
        parts = [self.out / name for name in plan["folders"] if name.startswith("degraded/")]
        self.assertTrue(parts)
        for part in parts:
            part.mkdir(parents=True)
            (part / "rgb.txt").touch()
        for result in self.out.glob("runs/**/result-*.json"):
            result.unlink()
        self.succeed(*arguments)
        self.assertEqual(self.files(), before)

    def test_tables_so_far(self):
        self.succeed("--seeds", 1, "--tables", "I")
        count = len(self.calls())
        self.succeed("--seeds", 2, "--tables", "I", "--so-far")
        self.assertEqual(len(self.calls()), count)
        self.assertIn("| 1, 1 not run |", (self.out / "tables" / "tables.md").read_text())


if __name__ == "__main__":
    unittest.main()
