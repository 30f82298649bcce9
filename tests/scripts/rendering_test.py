#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer makes the bytes with which the accepted figures of scripts/accuracy.py were made."""

import json
import os
import pathlib
import sys
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts"))
from paper_tables.sequences import probe_hash  # noqa: E402


class RenderingTest(unittest.TestCase):
    def test_the_accepted_figures_can_be_made_again(self):
        accepted = json.loads((TOP / "docs" / "results" / "accuracy.json").read_text())
        program = pathlib.Path(os.environ["HULLSLAM_BIN"]) / "make_synthetic"
        self.assertEqual(probe_hash(program), accepted["rendering"],
                         "make_synthetic renders other images than those of the accepted figures: run "
                         "scripts/accuracy.py --accept")


if __name__ == "__main__":
    unittest.main()
