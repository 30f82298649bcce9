#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/draw_architecture.py. They do not need Graphviz."""

import pathlib
import shutil
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))

import draw_architecture as pictures  # noqa: E402


class DrawArchitecture(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        for path in pictures.IMAGES.glob("architecture_*"):
            shutil.copy(path, self.folder)

    def faults(self, levels=pictures.LEVELS):
        return "\n".join(pictures.faults(self.folder, levels))

    def test_the_stored_pictures_show_the_current_levels(self):
        self.assertEqual(self.faults(), "")

    def test_a_new_module_is_noticed(self):
        self.assertIn("is not what modules.toml", self.faults({**pictures.LEVELS, "radar": 4}))

    def test_a_picture_that_was_not_drawn_again_is_noticed(self):
        dot = self.folder / "architecture_data_flow.dot"
        dot.write_text(dot.read_text().replace("KeyframeRequest", "KeyframeWish"))
        self.assertIn("lacks KeyframeWish", self.faults())

    def test_a_missing_picture_is_noticed(self):
        (self.folder / "architecture_modules.svg").unlink()
        self.assertIn("no such file", self.faults())

    def test_every_module_is_in_a_row_of_its_level(self):
        rows = pictures.rows({"a": 0, "b": 1, "c": 1})
        self.assertEqual(rows, [(1, ["b", "c"]), (0, ["a"])])
        text = pictures.modules_dot(pictures.LEVELS)
        for module in pictures.LEVELS:
            self.assertIn(f"<B>{module}</B>", text)


if __name__ == "__main__":
    unittest.main()
