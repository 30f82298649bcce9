#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the made-up vocabularies."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "make_vocabulary.py"


def make(path, *options):
    return subprocess.run([sys.executable, SCRIPT, path, *options], capture_output=True,
                          text=True, check=False)


class MakeVocabularyTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "voc.txt"

    def test_tree_is_full(self):
        self.assertEqual(make(self.path, "--branching", "3", "--levels", "2").returncode, 0)
        lines = [line.split() for line in self.path.read_text().splitlines()]
        self.assertEqual(lines[0], ["3", "2", "0", "0"])
        self.assertEqual([len(line) for line in lines[1:]], [35] * 12)
        self.assertEqual([int(line[0]) for line in lines[1:]], [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3)
        self.assertEqual([int(line[1]) for line in lines[1:]], [0] * 3 + [1] * 9)
        self.assertTrue(all(0 <= int(byte) <= 255 for line in lines[1:] for byte in line[2:34]))
        self.assertEqual({float(line[34]) for line in lines[1:4]}, {0.0})
        self.assertTrue(all(float(line[34]) > 0 for line in lines[4:]))

    def test_seed_decides(self):
        texts = []
        for seed in ("1", "1", "2"):
            make(self.path, "--levels", "2", "--seed", seed)
            texts.append(self.path.read_text())
        self.assertEqual(texts[0], texts[1])
        self.assertNotEqual(texts[0], texts[2])

    def test_bad_usage(self):
        self.assertEqual(make(self.path, "--branching", "1").returncode, 2)
        self.assertEqual(make(self.path.parent / "none" / "voc.txt").returncode, 2)
        self.assertFalse(self.path.exists())


if __name__ == "__main__":
    unittest.main()
