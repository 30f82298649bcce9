#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/reproduce_tables.py: failed runs, full disks and bad input."""

import shutil
import subprocess
import time
import unittest

import fake_slam
from fake_tables import DEFINITIONS, TablesTest


class FailureTest(TablesTest):
    def test_failed_runs_are_shown_with_their_reason(self):
        self.behave("lost")
        result = self.succeed("--seeds", 3, "--tables", "I")
        self.assertIn("18 runs, 6 failed", result.stdout)
        text = (self.out / "tables" / "tables.md").read_text()
        self.assertIn("| good | **11.50 (11.00..12.00)** | **10.35 (9.90..10.80)** | 0.0 (0.0..100.0) "
                      "| 16.10 | 3, 1 failed |", text)
        self.assertIn("failed: desk/rgbd/good/seed-0: no map could be made from 20 frames", text)
        self.assertIn("!1", text)
        cells = self.report()["tables"][0]["sequences"]["desk"]
        self.assertEqual(cells[0]["failures"], {"0": "no map could be made from 20 frames"})
        count = len(self.calls())
        self.succeed("--seeds", 3, "--tables", "I")
        self.assertEqual(len(self.calls()), count, "a failure is a result")
        self.behave()
        self.succeed("--seeds", 3, "--tables", "I", "--retry-failed")
        self.assertEqual(len(self.calls()), count + 6)
        self.assertNotIn("failed:", (self.out / "tables" / "tables.md").read_text())

    def test_crashes_and_timeouts_are_failures(self):
        self.behave("abort")
        self.succeed("--seeds", 1, "--tables", "I", "--modes", "rgbd")
        self.assertIn("crashed with SIGABRT", (self.out / "tables" / "tables.md").read_text())
        self.behave("wait")
        self.succeed("--seeds", 1, "--tables", "I", "--modes", "mono", "--timeout", 1)
        self.assertIn("not finished after 1 s", (self.out / "tables" / "tables.md").read_text())

    def test_input_that_a_program_refuses_ends_the_tables(self):
        self.behave("refuse")
        result = self.run_script("--seeds", 1)
        self.assert_refused(result, "desk/", "camera.yaml:3: Camera.fx is 'x', expected a number")
        self.assertFalse((self.out / "tables").exists())
        self.behave()
        self.succeed("--seeds", 1)

    def test_full_disk(self):
        """In a file system of 6 MB, which the second or third run fills."""
        disk = self.dir / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=6m", "none", disk],
                                 capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("needs the right to mount a file system")
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=False)
        self.behave("fill")
        result = self.run_script("--seeds", 1, "--tables", "I", out=disk / "out")
        self.assert_refused(result, "disk is full", code=1)
        self.assertFalse((disk / "out" / "tables").exists())
        self.behave()
        shutil.rmtree(disk / "out" / "runs" / "desk" / "rgbd" / "points", ignore_errors=True)
        subprocess.run(["mount", "-o", "remount,size=60m", disk], check=True)
        self.succeed("--seeds", 1, "--tables", "I", out=disk / "out")
        self.succeed("--seeds", 1, "--tables", "I")
        self.assertEqual({run for run in self.report(disk / "out")["runs"]},
                         {run for run in self.report()["runs"]})


class BadInputTest(TablesTest):
    def test_two_table_runs_in_one_folder(self):
        self.behave("wait")
        first = subprocess.Popen(self.command("--seeds", 1), stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        self.addCleanup(first.wait)
        self.addCleanup(first.terminate)
        while not list(self.programs.glob("began-*")):
            time.sleep(0.05)
        self.assert_refused(self.run_script("--seeds", 1), "another table run is at work",
                            f"process {first.pid}", "--out")

    def test_folders_that_are_no_sequences(self):
        (self.dir / "empty").mkdir()
        self.assert_refused(self.run_script("--sequence", self.dir / "empty"),
                            f"{self.dir / 'empty'}: is no sequence, expected rgb.txt")
        self.assert_refused(self.run_script("--sequence", self.dir / "none"), "is no folder")
        listed = self.dir / "list.txt"
        listed.write_text("# mine\ndesk\n\nnone  # not there\n")
        self.assert_refused(self.run_script("--sequences", listed, sequence=False),
                            f"{listed}:4:", "is no folder")
        listed.write_text("desk\nempty\n")
        self.assert_refused(self.run_script("--sequences", listed, sequence=False),
                            "empty: is no sequence")
        self.assert_refused(self.run_script("--data", self.dir / "bin", sequence=False),
                            "none of its 0 folders is a sequence")
        self.assertEqual(self.calls(), [])

    def test_half_a_download(self):
        images = sorted((self.desk / "rgb").iterdir())
        for path in images[12:]:
            path.unlink()
        self.assert_refused(self.run_script(), "is not complete: 8 of the 40 images",
                            "rgb/2.200000.png (in rgb.txt)", "download it again")
        for path in images[12:]:
            path.write_bytes(fake_slam.png(0)[:40])
        self.assert_refused(self.run_script(), "8 of the 40 images of the sequence are cut short")
        self.assertFalse(self.out.exists())

    def test_what_is_no_sequence_in_a_folder_of_sequences_is_named(self):
        data = self.dir / "data"
        data.mkdir()
        self.desk.rename(data / "desk")
        (data / "notes").mkdir()
        (data / "rgbd_dataset_freiburg1_xyz.tgz.part").touch()
        result = self.succeed("--data", data, "--list", sequence=False)
        self.assertIn("sequence desk: tum, 20 images", result.stdout)
        for name in ("notes", "rgbd_dataset_freiburg1_xyz.tgz.part"):
            self.assertIn(f"note: {data / name} is no sequence and is left out", result.stderr)

    def test_without_snakemake(self):
        command = self.command("--seeds", 1, "--profile", "slurm")
        result = subprocess.run(command, capture_output=True, text=True, check=False,
                                env={"PATH": str(self.dir)})
        self.assert_refused(result, "snakemake is not installed; run scripts/setup.sh")

    def test_unknown_names(self):
        for arguments, parts in (
                (("--tables", "I,IX"), ("'IX' is unknown", "I, II, VI")),
                (("--modes", "stereo"), ("'stereo' is unknown", "rgbd, mono")),
                (("--only", "house"), ("'house' is unknown", "desk")),
                (("--compare", self.dir / "none.json"), ("cannot read",)),
                (("--compare", self.definitions), ("not valid JSON",)),
                (("--masks", "none"), ("none: does not exist",)),
                (("--programs", self.dir), ("no such program",)),
                (("--seeds", "0"), ("--seeds: is '0'",)),
                (("--timeout", "nan"), ("--timeout",)),
                (("--definitions", self.dir / "none.yaml"), ("cannot read",))):
            with self.subTest(arguments):
                self.assert_refused(self.run_script(*arguments), *parts)
        self.definitions.write_text(DEFINITIONS.replace(
            "good: {label: good}", "good: {label: good, arguments: [--preset, nonsense]}"))
        self.assert_refused(self.run_script(), "unknown preset 'nonsense', expected one of:")
        self.assert_refused(self.run_script(sequence=False), "no sequences")
        self.assertEqual(self.calls(), [])

    def test_two_sequences_of_one_name(self):
        other = self.dir / "copy" / "desk"
        shutil.copytree(self.desk, other)
        self.assert_refused(self.run_script("--sequence", other), "have the same name 'desk'")

    def test_several_masks(self):
        (self.desk / "masks").rename(self.desk / "masks-a")
        shutil.copytree(self.desk / "masks-a", self.desk / "masks-b")
        self.assert_refused(self.run_script(), "has masks-a and masks-b")
        self.succeed("--seeds", 1, "--tables", "II", "--masks", "masks-b")
        self.assertIn(f"--masks {self.desk}/masks-b", self.calls()[0])


if __name__ == "__main__":
    unittest.main()
