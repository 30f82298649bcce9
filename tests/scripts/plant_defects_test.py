#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/plant_defects.py with a small git repository and a replacement of cmake."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plant_defects.py"
sys.path.insert(0, str(SCRIPT.parent))
import plant_defects  # noqa: E402

# Its build writes a test program that fails unless the source says `limit = 3`. It fails itself if
# the source contains `syntax`.
CMAKE = """#!/bin/bash
[ "$1" = --build ] || exit 0
if grep -q syntax src/objects/a.cc; then echo "a.cc:1: error: bad syntax"; exit 1; fi
mkdir -p build/release/bin
printf '#!/bin/bash\\n%s\\n' "$(cat test_body)" >build/release/bin/objects_tests
chmod +x build/release/bin/objects_tests
"""
TEST = "grep -q 'limit = 3' src/objects/a.cc"


def entry(name, find, replace, file="src/objects/a.cc", **more):
    return {"name": name, "file": file, "find": find, "replace": replace, **more}


CAUGHT = entry("caught", "limit = 3", "limit = 4")
SURVIVES = entry("survives", "margin = 1", "margin = 2")


class PlantDefectsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.tree = self.dir / "tree"
        self.source = self.tree / "src/objects/a.cc"
        self.source.parent.mkdir(parents=True)
        self.source.write_text("limit = 3\nmargin = 1\nx x\n")
        (self.tree / "test_body").write_text(TEST)
        subprocess.run(["git", "init", "-q", self.tree], check=True)
        (self.dir / "path").mkdir()
        (self.dir / "path/cmake").write_text(CMAKE)
        (self.dir / "path/cmake").chmod(0o755)

    def plant(self, entries, *arguments):
        self.list = self.dir / "list.json"
        self.list.write_text(entries if isinstance(entries, str) else json.dumps(entries))
        path = f"{self.dir / 'path'}:{os.environ['PATH']}"
        return subprocess.run(
            [SCRIPT, "--tree", self.tree, "--list", self.list, *arguments], check=False,
            env={**os.environ, "PATH": path}, capture_output=True, text=True, timeout=60)

    def test_caught_and_survivor(self):
        before = self.source.read_text()
        result = self.plant([CAUGHT, SURVIVES])
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stdout, r"(?m)^caught +caught$")
        self.assertRegex(result.stdout, r"(?m)^survives +SURVIVED$")
        self.assertIn("2 defects, 1 caught\n  src/objects/a.cc: survives: SURVIVED", result.stdout)
        self.assertEqual(self.source.read_text(), before)
        self.assertFalse((self.tree / "build").exists())

    def test_the_test_program_is_that_of_the_module(self):
        for file in ("src/objects/a.cc", "src/objects/comparison/a.cc",
                     "include/hullslam/objects/a.h"):
            self.assertEqual(plant_defects.command_of(entry("a", "x", "y", file)),
                             ["objects_tests"])

    def test_all_caught(self):
        result = self.plant([CAUGHT])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(result.stdout.endswith("1 defects, 1 caught\n"))

    def test_selected_by_name(self):
        self.assertEqual(self.plant([CAUGHT, SURVIVES], "caught").returncode, 0)
        result = self.plant([CAUGHT], "caught", "none")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no defect none", result.stderr)

    def test_a_sample_follows_from_its_seed(self):
        (self.tree / "test_body").write_text("grep -q 'limit = 3' src/objects/a.cc")
        entries = [entry(f"defect {i}", "limit = 3", f"limit = {i}") for i in range(4, 24)]

        def names(*arguments):
            result = self.plant(entries, *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            return [line for line in result.stdout.splitlines() if line.endswith(" caught")
                    and line.startswith("defect ")], result.stdout

        first, printed = names("--sample", "3", "--seed", "7")
        self.assertEqual(len(first), 3)
        self.assertTrue(printed.startswith("3 of 20 defects, --seed 7\n"))
        self.assertEqual(names("--sample", "3", "--seed", "7")[0], first)
        drawn = {tuple(names("--sample", "3", "--seed", str(seed))[0]) for seed in range(4)}
        self.assertGreater(len(drawn), 1)
        self.assertEqual(len(names("--sample", "99", "--seed", "0")[0]), 20)
        self.assertEqual(self.plant(entries, "--sample", "0").returncode, 2)

    def test_without_a_seed_it_follows_from_the_commit(self):
        def commit(text):
            self.source.write_text(text)
            git = ["git", "-C", self.tree, "-c", "user.name=a", "-c", "user.email=a@b"]
            subprocess.run([*git, "add", "."], check=True)
            subprocess.run([*git, "commit", "-qm", text], check=True)
            return plant_defects.seed_of_commit(self.tree)

        seed = commit("limit = 3\n")
        result = self.plant([CAUGHT], "--sample", "1")
        self.assertIn(f"1 of 1 defects, --seed {seed}\n", result.stdout)
        self.assertNotEqual(commit("limit = 3 \n"), seed)

    def test_defects_that_do_not_apply_or_compile(self):
        entries = [entry("absent", "limit = 9", "y"), entry("twice", "x", "y"),
                   entry("no file", "x", "y", file="src/objects/none.cc"),
                   entry("broken", "margin = 1", "syntax")]
        result = self.plant(entries)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("absent: does not apply (0 matches)", result.stdout)
        self.assertIn("twice: does not apply (2 matches)", result.stdout)
        self.assertIn("no file: does not apply (0 matches)", result.stdout)
        self.assertIn("broken: does not compile: a.cc:1: error: bad syntax", result.stdout)
        result = self.plant(entries, "--check")
        self.assertEqual(result.returncode, 1)
        self.assertIn("4 defects, 3 do not apply", result.stdout)
        self.assertEqual(self.plant([CAUGHT], "--check").returncode, 0)

    def test_a_test_that_hangs_is_a_catch(self):
        (self.tree / "test_body").write_text(TEST + " || sleep 30")
        self.assertEqual(self.plant([CAUGHT], "--timeout", "1").returncode, 0)

    def test_arguments_of_the_test(self):
        (self.tree / "test_body").write_text('[ "$1 $2" = "--filter=a b" ] && ' + TEST)
        self.assertEqual(self.plant([{**CAUGHT, "test": "objects_tests '--filter=a' b"}]).returncode,
                         0)

    def test_tests_that_fail_without_a_defect(self):
        (self.tree / "test_body").write_text("false")
        result = self.plant([CAUGHT])
        self.assertEqual(result.returncode, 2)
        self.assertIn("`objects_tests` fails without a defect", result.stderr)

    def test_kept_copy(self):
        work = self.dir / "work"
        self.assertEqual(self.plant([CAUGHT], "--work", work).returncode, 0)
        copied = work / "src/objects/a.cc"
        self.assertEqual(copied.read_text(), self.source.read_text())
        (self.tree / "new").write_text("1")
        (self.tree / "test_body").unlink()
        (self.tree / "test_body").write_text(TEST + " ")
        (work / "old").write_text("1")
        self.assertEqual(self.plant([SURVIVES], "--work", work).returncode, 1)
        self.assertTrue((work / "new").exists())
        self.assertFalse((work / "old").exists())
        self.assertTrue((work / "build/release/bin/objects_tests").exists())

    def test_other_folders_are_not_overwritten(self):
        for work in (self.tree, self.dir):
            result = self.plant([CAUGHT], "--work", work)
            self.assertEqual(result.returncode, 2)
            self.assertIn("is not empty and no copy", result.stderr)
        self.assertTrue(self.source.exists())

    def test_broken_lists(self):
        for text in ("{", "5", "[5]", '[{"name": "a"}]', json.dumps([{**CAUGHT, "strange": "x"}]),
                     json.dumps([CAUGHT, CAUGHT]), json.dumps([entry("a", "x", "x")]),
                     json.dumps([entry("a", "", "x")]), json.dumps([entry("a", "x", 5)])):
            with self.subTest(text):
                result = self.plant(text)
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertTrue(result.stderr.startswith("error: "), result.stderr)

    def test_the_list_of_the_project(self):
        """Does not test that all defects apply: a change of the code need not update the list."""
        entries = plant_defects.read_defects(SCRIPT.parent / "defects.json", [])
        self.assertGreaterEqual(len(entries), 40)
        for item in entries:
            self.assertTrue((SCRIPT.parent.parent / item["file"]).exists(), item["file"])
            self.assertEqual(len(plant_defects.command_of(item)), 1)


if __name__ == "__main__":
    unittest.main()
