#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/demo.sh and scripts/test.sh. Replacements of the programs that these call log
their arguments."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


class StepsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        self.log = self.top / "log"
        (self.top / "scripts").mkdir()
        for name in ("common.sh", "demo.sh", "run_demo.sh", "test.sh"):
            shutil.copy(SCRIPTS / name, self.top / "scripts")
        for name in ("scripts/setup.sh", "scripts/plot_run.py", "path/cmake", "path/ctest",
                     "build/release/bin/rgbd_tum", "build/release/bin/hullslam"):
            self.stand_in(name)
        self.stand_in("build/release/bin/make_synthetic", 'mkdir "$1" && touch "$1/rgb.txt"')

    def stand_in(self, name, body="true"):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'#!/bin/bash\necho "{path.name} $*" >>{self.log}\n{body}\n')
        path.chmod(0o755)

    def run_script(self, name, *arguments):
        self.log.write_text("")
        path = f"{self.top / 'path'}:{os.environ['PATH']}"
        result = subprocess.run([self.top / "scripts" / name, *arguments], cwd="/", text=True,
                                env={**os.environ, "PATH": path}, capture_output=True, check=False)
        return result, self.log.read_text().splitlines()

    def test_demo_from_any_folder(self):
        result, calls = self.run_script("demo.sh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([call.split()[0] for call in calls],
                         ["setup.sh", "cmake", "cmake", "make_synthetic", "rgbd_tum", "hullslam",
                          "plot_run.py"])
        built = set(calls[2].split("--target ")[1].split())
        self.assertEqual(built, {"rgbd_tum", "hullslam_program", "make_synthetic"})
        self.assertEqual(calls[-3], "rgbd_tum build/demo/desk --masks build/demo/desk/masks "
                                    "--output build/demo/run --report")
        self.assertEqual(calls[-2], "hullslam evaluate objects build/demo/run --truth "
                                    "build/demo/desk/groundtruth_objects.json --upright")
        self.assertEqual(calls[-1], "plot_run.py build/demo/run --overlay 6")
        self.assertRegex(result.stdout.splitlines()[-1],
                         "^Open the report in a browser: file:///.*/build/demo/run/report.html$")

    def test_cdpath_does_not_matter(self):
        """With CDPATH, `cd scripts/..` prints a path, and may even go elsewhere."""
        for path in SCRIPTS.glob("*.sh"):
            shutil.copy(path, self.top / "scripts")
        (self.top / ".ci").mkdir()
        shutil.copy(SCRIPTS.parent / ".ci" / "run", self.top / ".ci")
        (self.top / "elsewhere" / "scripts").mkdir(parents=True)
        path = f"{self.top / 'path'}:{os.environ['PATH']}"
        for cdpath in (".", str(self.top / "elsewhere")):
            environment = {**os.environ, "CDPATH": cdpath, "PATH": path}
            for script in sorted(self.top.glob("scripts/*.sh")):
                if script.name in ("common.sh", "download_common.sh"):
                    continue
                with self.subTest(cdpath=cdpath, script=script.name):
                    result = subprocess.run([f"scripts/{script.name}", "--help"], cwd=self.top,
                                            env=environment, capture_output=True, text=True,
                                            check=False)
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertTrue(result.stdout.startswith("Usage: scripts/"), result.stdout)
            self.stand_in("scripts/setup.sh")
            for words in (["scripts/test.sh"], ["scripts/demo.sh"], [".ci/run"]):
                with self.subTest(cdpath=cdpath, words=words):
                    result = subprocess.run(words, cwd=self.top, env=environment, check=False,
                                            capture_output=True, text=True)
                    self.assertEqual(result.returncode, 0, result.stderr)
            shutil.copy(SCRIPTS / "setup.sh", self.top / "scripts")

    def test_demo_renders_once(self):
        self.run_script("demo.sh")
        result, calls = self.run_script("demo.sh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse([call for call in calls if call.startswith("make_synthetic")])

    def test_demo_renders_again_after_an_interrupted_one(self):
        self.stand_in("build/release/bin/make_synthetic", 'mkdir "$1" && exit 3')
        result, calls = self.run_script("demo.sh")
        self.assertEqual(result.returncode, 3)
        self.assertIn('step "render build/demo/desk" failed', result.stderr)
        self.stand_in("build/release/bin/make_synthetic", 'mkdir "$1" && touch "$1/rgb.txt"')
        result, calls = self.run_script("demo.sh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.top / "build/demo/desk/rgb.txt").exists())

    def test_demo_names_the_failing_step(self):
        self.stand_in("build/release/bin/rgbd_tum", "exit 1")
        result, calls = self.run_script("demo.sh")
        self.assertEqual(result.returncode, 1)
        self.assertIn('step "run" failed with exit code 1', result.stderr)
        self.assertTrue(calls[-1].startswith("rgbd_tum"))

    def test_tests_release_by_default_and_ends_with_ctest(self):
        self.stand_in("path/ctest", 'echo "100% tests passed"')
        result, calls = self.run_script("test.sh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(calls[1], "cmake --preset release")
        self.assertTrue(calls[-1].startswith("ctest --preset release"))
        self.assertTrue(result.stdout.endswith("100% tests passed\n"))

    def test_slow_tests_run_only_with_all(self):
        for arguments, is_run in (((), False), (("--all",), True)):
            with self.subTest(arguments=arguments):
                _, calls = self.run_script("test.sh", *arguments)
                self.assertEqual("--label-exclude slow" not in calls[-1], is_run, calls[-1])

    def test_failing_tests_fail(self):
        self.stand_in("path/ctest", "exit 8")
        result, _ = self.run_script("test.sh")
        self.assertEqual(result.returncode, 8)
        self.assertIn('step "test (release)" failed', result.stderr)

    def test_other_presets(self):
        result, calls = self.run_script("test.sh", "--preset", "asan", "--preset", "tidy")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([call.split()[2] for call in calls if call.startswith("ctest")], ["asan"])
        self.assertIn("cmake --preset tidy", calls)
        self.assertNotIn("cmake --preset release", calls)

    def test_bad_usage(self):
        for name, arguments in (("demo.sh", ["--nonsense"]), ("test.sh", ["nonsense"]),
                                ("test.sh", ["--preset"]), ("test.sh", ["--preset", "fast"])):
            with self.subTest(name=name, arguments=arguments):
                result, calls = self.run_script(name, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn("--help", result.stderr)
                self.assertEqual(calls, [])


if __name__ == "__main__":
    unittest.main()
