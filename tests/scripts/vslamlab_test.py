#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/vslamlab.py with a rendered sequence of 20 frames. The programs are in $HULLSLAM_BIN."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from in_process import run_main

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import vslamlab  # noqa: E402

BIN = pathlib.Path(os.environ.get("HULLSLAM_BIN", ROOT / "build" / "release" / "bin"))
FIRST = 1305031102175304031  # ns; no double has this value
POSE = "T_BS: [1, 0, 0, {x}, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"
CALIBRATION = """%YAML:1.0
cameras:
- {{cam_name: other, cam_model: fov}}
- {{cam_name: rgb_0, cam_model: pinhole, focal_length: [{fx}, {fy}], principal_point: [{cx}, {cy}],
   image_dimension: [{width}, {height}], fps: 30.0, depth_name: depth_0, depth_factor: 5000}}
"""


class VslamlabTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.desk = pathlib.Path(folder.name) / "desk"
        subprocess.run([BIN / "make_synthetic", cls.desk, "--frames", "20", "--quiet"], check=True)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        for patch in (mock.patch.object(vslamlab, "programs_folder", lambda: BIN),
                      mock.patch.object(vslamlab.subprocess, "run", self.run_shown)):
            patch.start()
            self.addCleanup(patch.stop)
        rows = ["ts_rgb_0 (ns),path_rgb_0,ts_depth_0 (ns),path_depth_0"]
        lists = [[line.split()[1] for line in (self.desk / f"{kind}.txt").read_text().splitlines()
                  if not line.startswith("#")] for kind in ("rgb", "depth")]
        for i, (rgb, depth) in enumerate(zip(*lists)):
            stamp = FIRST + i * 33333333
            rows.append(f"{stamp},{rgb},{stamp},{depth}")
        (self.dir / "rgb.csv").write_text("\n".join(rows) + "\n")
        self.write_calibration(1.0)

    @staticmethod
    def run_shown(command, check, start=subprocess.run):
        """Shows what a program prints where run_main() sees it."""
        done = start(command, check=check, capture_output=True, text=True)
        print(done.stdout, end="")
        print(done.stderr, end="", file=sys.stderr)
        return done

    def write_calibration(self, y):
        lines = (self.desk / "camera.yaml").read_text().splitlines()
        camera = dict(line[len("Camera."):].split(": ") for line in lines if line.startswith("Camera."))
        camera["fy"] = y * float(camera["fy"])
        (self.dir / "calibration.yaml").write_text(CALIBRATION.format(**camera))

    def run_script(self, name, *more, mode="rgbd"):
        words = {"sequence_path": self.desk, "calibration_yaml": self.dir / "calibration.yaml",
                 "rgb_csv": self.dir / "rgb.csv", "exp_folder": self.dir / "exp", "exp_id": name,
                 "verbose": "0"}
        words |= dict(word.split(":", 1) for word in more)
        return run_main(lambda given: vslamlab.main(given, f"vslamlab_hullslam_{mode}"),
                        *(f"{key}:{value}" for key, value in words.items()))

    def rows(self, name):
        header, *lines = (self.dir / f"exp/{name}_KeyFrameTrajectory.csv").read_text().splitlines()
        self.assertEqual(header, "ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw")
        return [line.split(",") for line in lines]

    def keyframes(self, name):
        text = (self.dir / f"exp/{name}_hullslam/keyframes.txt").read_text()
        return [[float(word) for word in line.split()] for line in text.splitlines()
                if not line.startswith("#")]

    def test_the_keyframes_have_the_stamps_of_the_list(self):
        result = self.run_script("7")
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        rows, keyframes = self.rows("7"), self.keyframes("7")
        self.assertEqual(rows, self.rows("00007"))
        self.assertEqual(rows[0][0], str(FIRST))
        self.assertEqual(len(rows), len(keyframes))
        for row, keyframe in zip(rows, keyframes):
            self.assertEqual((int(row[0]) - FIRST) % 33333333, 0)
            self.assertAlmostEqual(int(row[0]) / 1e9, keyframe[0], delta=0.01)
            for value, expected in zip(row[1:], keyframe[1:]):
                self.assertAlmostEqual(float(value), expected, delta=1e-8)

    def test_a_negative_focal_length_mirrors_the_poses(self):
        self.write_calibration(-1.0)
        self.assertEqual(self.run_script("00001").returncode, 0)
        for row, (_, x, y, z, qx, qy, qz, qw) in zip(self.rows("00001"), self.keyframes("00001")):
            for value, expected in zip(row[1:], (x, -y, z, -qx, qy, -qz, qw)):
                self.assertAlmostEqual(float(value), expected, delta=1e-8)

    def test_settings_and_choices_reach_the_program(self):
        settings = self.dir / "settings.yaml"
        settings.write_text("%YAML:1.0\ncam_mono: rgb_0\ncam_rgbd: rgb_0\nORBextractor.nFeatures: 700\n")
        job = vslamlab.Run("mono", vslamlab.parse_values(
            [f"{key}:{self.dir / value}" for key, value in
             {"calibration_yaml": "calibration.yaml", "rgb_csv": "rgb.csv", "exp_folder": "exp"}.items()]
            + [f"sequence_path:{self.desk}", f"settings_yaml:{settings}", "exp_id:a", "seed:3",
               "preset:paper", "masks:m"], "mono"))
        words = " ".join(map(str, job.command()))
        self.assertIn("mono_tum ", words)
        for part in ("--seed 3", "--preset paper", "--masks m", "--set ORBextractor.nFeatures=700"):
            self.assertIn(part, words)
        self.assertNotIn("cam_", words)
        self.assertNotIn("DepthMapFactor", words)
        self.assertNotIn("--quiet", words)

    def test_a_list_of_windows_and_a_folder_with_blanks_are_read(self):
        images = self.dir / "rgb.csv"
        images.write_bytes(b"\xef\xbb\xbf" + images.read_bytes().replace(b"\n", b"\r\n"))
        blanks = self.dir / "my desk"
        blanks.symlink_to(self.desk)
        self.assertEqual(self.run_script("1", f"sequence_path:{blanks}").returncode, 0)
        self.assertEqual(self.rows("1")[0][0], str(FIRST))

    def test_every_model_of_vslamlab_has_its_lens(self):
        text = (self.dir / "calibration.yaml").read_text()
        for model, expected in (("pinhole", [0.0] * 4), ("radtan4", [0.1, 0.2, 0.0, 0.0]),
                                ("radtan5", [0.1, 0.2, 0.0, 0.0, 0.3]), ("equid4", [0.1, 0.2, 0.0, 0.0])):
            (self.dir / "calibration.yaml").write_text(text.replace(
                "cam_model: pinhole", f"cam_model: {model}, distortion_coefficients: {expected}"))
            camera = vslamlab.Camera(self.dir / "calibration.yaml", "rgb_0", False)
            self.assertEqual(camera.sensor["distortion_coefficients"], expected)
            self.assertEqual(camera.sensor["distortion_model"] == "equidistant", model == "equid4")

    def assert_refused(self, result, *parts):
        self.assertEqual(result.returncode, 2, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertFalse((self.dir / "exp").exists())

    def test_bad_usage(self):
        self.assert_refused(run_main(vslamlab.main, "zebra:1"), "'zebra:1'")
        self.assert_refused(run_main(vslamlab.main, "sequence_path"), "expected key:value")
        self.assert_refused(self.run_script("1", "rgb_csv:"), "rgb_csv: is not given")
        self.assert_refused(self.run_script("1", "mode:mono"), "mode is 'mono'")
        self.assert_refused(self.run_script("1", "verbose:2"), "verbose is '2'")
        self.assert_refused(self.run_script("a/b"), "exp_id is 'a/b'")

    def test_bad_input(self):
        self.assert_refused(self.run_script("1", f"settings_yaml:{self.dir}/none.yaml"), "none.yaml")
        calibration = self.dir / "calibration.yaml"
        text = calibration.read_text()
        for change, parts in ((("rgb_0", "left"), ("has no camera 'rgb_0'", "other, left")),
                              (("pinhole", "fov"), ("cam_model is 'fov'", "radtan5")),
                              (("30.0", "often"), ("fps is 'often'", "1 number")),
                              (("depth_name: depth_0,", ""), ("has no depth_name",)),
                              (("depth_factor", "factor"), ("depth_factor is 'None'",)),
                              (("cameras:", "cameras: ["), ("not valid YAML",))):
            calibration.write_text(text.replace(*change))
            self.assert_refused(self.run_script("1"), "calibration.yaml", *parts)
        calibration.write_text(text)
        images = self.dir / "rgb.csv"
        text = images.read_text()
        for change, parts in ((("path_depth_0", "depth"), ("rgb.csv:1:", "'path_depth_0'")),
                              ((f"\n{FIRST},", "\n1.5,"), ("rgb.csv:2:", "'1.5'", "nanoseconds")),
                              (("rgb/", "none/"), ("rgb.csv:2:", "none/")),
                              ((f",{FIRST},", ","), ("rgb.csv:2:", "columns"))):
            images.write_text(text.replace(*change))
            self.assert_refused(self.run_script("1"), *parts)

    def write_pair(self, x):
        """Gives the left camera a right one at `x` m, with the same images."""
        text = (self.dir / "calibration.yaml").read_text()
        left = text[text.index("- {cam_name: rgb_0"):].replace("fps: 30.0", "fps: 30.0, " + POSE.format(x=0))
        right = left.replace("rgb_0", "rgb_1").replace("T_BS", "T_SC").replace("1, 0, 0, 0,", f"1, 0, 0, {x},", 1)
        (self.dir / "calibration.yaml").write_text("cameras:\n" + left + right)
        rows = (self.dir / "rgb.csv").read_text().replace("depth_0", "rgb_1").replace("depth/", "rgb/")
        (self.dir / "rgb.csv").write_text(rows)

    def test_a_pair_becomes_a_sequence_of_euroc(self):
        self.write_pair(0.1)
        (self.dir / "settings.yaml").write_text("cam_stereo: [rgb_0, rgb_1]\n")
        job = vslamlab.Run("stereo", vslamlab.parse_values(
            [f"sequence_path:{self.desk}", f"calibration_yaml:{self.dir}/calibration.yaml",
             f"rgb_csv:{self.dir}/rgb.csv", f"exp_folder:{self.dir}/exp", "exp_id:1",
             f"settings_yaml:{self.dir}/settings.yaml"], "stereo"))
        job.write_input()
        for i, x in enumerate((0.0, 0.1)):
            folder = job.input / "mav0" / f"cam{i}"
            sensor = vslamlab.read_yaml(folder / "sensor.yaml", "a map")
            self.assertEqual(float(sensor["T_BS"]["data"][3]), x)
            stamp, image = (folder / "data.csv").read_text().splitlines()[0].split(",")
            self.assertEqual(int(stamp), FIRST)
            self.assertTrue((folder / "data" / image).is_file())
        self.assertTrue(str(job.command()[0]).endswith("stereo_euroc"))

    def test_pairs_that_cannot_be_used_are_refused(self):
        calibration, rows = (self.dir / "calibration.yaml").read_text(), (self.dir / "rgb.csv").read_text()
        for x, part in ((0.0, "baseline is 0 m"), (-0.1, "swapped"), (0.1, "same image"), (".inf", "T_SC is"),
                        ("0.1, 1", "16 numbers")):
            (self.dir / "calibration.yaml").write_text(calibration)
            (self.dir / "rgb.csv").write_text(rows)
            self.write_pair(x)
            self.assert_refused(self.run_script("1", mode="stereo"), part)
        (self.dir / "settings.yaml").write_text("cam_stereo: rgb_0\n")
        self.assert_refused(self.run_script("1", f"settings_yaml:{self.dir}/settings.yaml", mode="stereo"),
                            "cam_stereo is", "left and the right")

    def test_what_the_program_refuses_leaves_nothing(self):
        for word in ("preset:zebra", "seed:-1"):
            result = self.run_script("1", word)
            self.assertEqual(result.returncode, 2)
            self.assertFalse((self.dir / "exp").exists())

    def test_help(self):
        for name, code in ((["--help"], 0), ([], 2)):
            result = run_main(vslamlab.main, *name)
            self.assertEqual(result.returncode, code)
            self.assertIn("settings_yaml:", result.stdout)


if __name__ == "__main__":
    unittest.main()
