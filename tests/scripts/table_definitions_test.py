#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of what scripts/reproduce_tables.py reads: its definitions and the sequences of the user."""

import json
import pathlib
import sys
import tempfile
import unittest

import fake_slam
from fake_tables import DEFINITIONS, SCRIPT

sys.path.insert(0, str(SCRIPT.parent))
from paper_tables.definitions import read_definitions  # noqa: E402
from paper_tables.sequences import (find_dataset, find_masks, has_rolling_shutter,  # noqa: E402
                                    in_order, paper_name, read_sequence, read_suite, short_name)
from paper_tables.tables import paper_value  # noqa: E402
from support import InputError  # noqa: E402

OWN = SCRIPT.parent / "paper_tables"
CONFIG = SCRIPT.parent.parent / "config"


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)


class DefinitionsTest(FolderTest):
    def read(self, text):
        path = self.dir / "tables.yaml"
        path.write_text(text)
        return read_definitions(path)

    def assert_refused(self, text, *parts):
        with self.assertRaises(InputError) as caught:
            self.read(text)
        for part in ("tables.yaml", *parts):
            self.assertIn(part, str(caught.exception))

    def test_the_definitions_of_the_paper(self):
        found = read_definitions(OWN / "tables.yaml")
        self.assertEqual(list(found.tables), ["I", "II", "III", "IV", "V", "VI", "VII"])
        self.assertEqual(len(found.paper_sequences), 10)
        self.assertEqual({row.variant for row in found.tables["I"].rows} >= {
            "orb_slam2", "hullslam", "hullslam_global_shutter", "hullslam_objects_off"}, True)
        self.assertFalse(found.variants["hullslam_objects_off"].objects)
        self.assertTrue(found.variants["hullslam_objects_off"].masks)

    def test_the_example_of_an_ablation(self):
        found = read_definitions(OWN / "ablation.yaml")
        self.assertEqual([row.variant for row in found.tables["ablation"].rows], list(found.variants))
        self.assertEqual(found.tables["ablation"].baseline, "without")

    def test_every_figure_of_the_paper_is_in_a_table(self):
        """So no name of a row or a sequence is misspelt."""
        found = read_definitions(OWN / "tables.yaml")
        paper = json.loads((OWN / "paper_tables.json").read_text())
        counts = {}
        for table in found.tables.values():
            for row in table.rows:
                for mode in table.modes:
                    for sequence in table.only or found.paper_sequences:
                        for figure in table.figures:
                            if paper_value(paper, table.paper, mode, row.paper, sequence,
                                           figure) is not None:
                                counts[table.name, figure] = counts.get((table.name, figure), 0) + 1

        def numbers(value):
            if isinstance(value, dict):
                return sum(numbers(item) for item in value.values())
            return isinstance(value, float)
        # Table II of the paper has SIoU and MTD, III and IV have ATE and SIoU.
        self.assertEqual(counts, {
            ("I", "ate"): numbers(paper["ate"]), ("II", "siou"): numbers(paper["mapping"]) // 2,
            ("II", "mtd"): numbers(paper["mapping"]) // 2,
            ("III", "ate"): numbers(paper["constraints"]) // 2,
            ("III", "siou"): numbers(paper["constraints"]) // 2,
            ("IV", "ate"): numbers(paper["simplification"]) // 2,
            ("IV", "siou"): numbers(paper["simplification"]) // 2,
            ("V", "ate"): numbers(paper["integration"])})

    def test_figures_of_the_paper_in_metres(self):
        paper = json.loads((OWN / "paper_tables.json").read_text())
        for value, arguments in (
                (0.0161, ("ate", "rgbd", "paper", "fr1-desk", "ate")),
                (0.0142, ("ate", "mono", "paper", "fr1-desk", "ate")),
                (None, ("ate", "mono", "paper", "fr2-dishes", "ate")),
                (0.01414, ("constraints", "mono", "algebraic_plane/hull", "fr1-desk", "ate")),
                (0.719, ("constraints", "mono", "algebraic_plane/hull", "fr1-desk", "siou")),
                (None, ("constraints", "rgbd", "algebraic_plane/hull", "fr1-desk", "ate")),
                (0.0227, ("integration", "mono", "jpe+object_ba", "fr3-teddy", "ate")),
                (6.385e-3, ("mapping", "mono", "paper", "fr1-desk", "mtd")),
                (None, (None, "mono", "paper", "fr1-desk", "ate"))):
            with self.subTest(arguments):
                self.assertAlmostEqual(paper_value(paper, *arguments), value) if value else \
                    self.assertIsNone(paper_value(paper, *arguments))

    def test_broken_definitions_are_refused(self):
        self.read(DEFINITIONS)
        for old, new, parts in (
                ("variants:", "variant:", ("unknown key 'variant'",)),
                ("points: {", "off: {", ("variants", "'False' is no text", "quotes")),
                ("points: {label: points only, masks: false}", "points: [1]",
                 ("variants.points: is '[1]', expected a map",)),
                ("masks: false", "masks: 3", ("variants.points.masks: is '3', expected true",)),
                ("same_as: good", "same_as: none", ("global.same_as: is 'none', expected one of",)),
                ("figures: [ate, lost]", "figures: [ate, time]", ("tables.I.figures[1]: is 'time'",)),
                ("figures: [ate, lost]", "figures: [ate, ate]", ("expected each entry once",)),
                ("baseline: good", "baseline: other", ("tables.I.baseline: is 'other'",)),
                ("rows: [good, bad]", "rows: [good, worse]", ("tables.II.rows[1]: is 'worse'",)),
                ("rows: [good, bad]", "rows: [good, good]", ("each with another variant",)),
                ("modes: [rgbd]", "modes: [stereo]", ("tables.VI.modes[0]: is 'stereo'",)),
                ("[features, mask_drop]", "[features, rain]", ("degradations[1]: is 'rain'",)),
                ("title: Pose error", "titel: x", ("tables.I: unknown key 'titel'",)),
                ('options: [--mask-drop, "{level}"]', "level: 1", ("unknown key 'level'",)),
                ('options: [--mask-drop, "{level}"],', "", ("expected arguments or options",)),
                ("label: features,", "label: features, unchanged: 3,",
                 ("tables.VI.degradations", "one degradation, if it has the key unchanged")),
                ("levels: [500, 100]", "unchanged: 3, levels: [500, many]",
                 ("degradations.features.levels[1]: is 'many', expected a number",)),
                ("levels: [500, 100]", "unchanged: yes, levels: [500]",
                 ("degradations.features.unchanged: is 'True', expected a number",)),
                ("better: good", "better: none", ("claims[0].better: is 'none'",))):
            with self.subTest(new):
                self.assertIn(old, DEFINITIONS)
                self.assert_refused(DEFINITIONS.replace(old, new), *parts)
        self.assert_refused("a: [", "not valid YAML")
        self.assert_refused("- 1", "top level: is '[1]', expected a map")
        self.assert_refused("variants: {}", "has no key tables")
        self.assert_refused(DEFINITIONS.replace("  good:", "  g/d:").replace("good", "g/d"),
                            "'g/d' is no name")


class SequencesTest(FolderTest):
    def read(self, folder, masks=None):
        return read_sequence(str(folder), masks, {"fr1-desk": "freiburg1_desk"}, CONFIG)

    def test_a_sequence_of_tum(self):
        folder = fake_slam.write_tum(self.dir / "rgbd_dataset_freiburg1_desk", count=5)
        (folder / "camera.yaml").unlink()
        found = self.read(folder)
        self.assertEqual((found.name, found.dataset, found.paper, found.frames),
                         ("freiburg1_desk", "tum", "fr1-desk", 5))
        self.assertTrue(found.has_rolling_shutter, "config/TUM1.yaml has one")
        self.assertEqual(found.masks, str(folder / "masks"))
        self.assertEqual(found.path("masks", 7), found.masks)

    def test_a_sequence_of_icl_nuim(self):
        folder = fake_slam.write_icl(self.dir / "traj0_frei_png", count=5)
        found = self.read(folder)
        self.assertEqual((found.dataset, found.frames, found.modes), ("icl", 5, ("rgbd", "mono")))
        self.assertFalse(found.has_rolling_shutter)
        (folder / "associations.txt").write_text("0 depth/0.png 0\n")
        with self.assertRaisesRegex(InputError, "expected lines: index depth index rgb"):
            self.read(folder)

    def test_the_data_set_can_be_said(self):
        """Some copies of ICL-NUIM have lists in TUM's format too."""
        folder = fake_slam.write_icl(self.dir / "traj0")
        (folder / "rgb.txt").write_text("0 rgb/0.png\n")
        self.assertEqual(find_dataset(folder), "tum")
        self.assertEqual(self.read(f"icl={folder}").dataset, "icl")

    def test_folders_without_lists(self):
        folder = fake_slam.write_tum(self.dir / "desk", count=4)
        (folder / "rgb.txt").unlink()
        (folder / "depth.txt").unlink()
        found = self.read(folder)
        self.assertEqual((found.dataset, found.frames), ("tum", 4))

    def test_what_is_no_sequence(self):
        for name, text in (("rgb.txt", ""), ("rgb.txt", "one rgb/1.png\n"), ("rgb.txt", "1.0\n")):
            folder = self.dir / f"bad{len(text)}"
            folder.mkdir()
            (folder / name).write_text(text)
            with self.assertRaisesRegex(InputError, "rgb.txt"):
                self.read(folder)
        folder = fake_slam.write_tum(self.dir / "desk")
        (folder / "camera.yaml").unlink()
        with self.assertRaisesRegex(InputError, "its camera is not known; .* camera.yaml"):
            self.read(folder)

    def test_images_that_are_cut_short(self):
        folder = fake_slam.write_tum(self.dir / "desk")
        path = folder / "depth" / "1.300000.png"
        for data in (b"", path.read_bytes()[:-5]):
            path.write_bytes(data)
            with self.assertRaisesRegex(InputError, r"1 of the 40 .* cut short, .*depth/1.300000.png"):
                self.read(folder)

    def test_fingerprints(self):
        folder = fake_slam.write_tum(self.dir / "desk")
        first = self.read(folder)
        mask = folder / "masks" / "1.000000.txt"
        mask.write_text("1 0.1 0.1 0.5 0.1 0.5 0.5\n")
        second = self.read(folder)
        self.assertEqual(first.fingerprint, second.fingerprint)
        self.assertNotEqual(first.masks_fingerprint, second.masks_fingerprint)
        (folder / "rgb" / "1.000000.png").write_bytes(fake_slam.png(1) + fake_slam.png(2))
        self.assertNotEqual(self.read(folder).fingerprint, first.fingerprint)

    def test_masks(self):
        (self.dir / "masks-yolo").mkdir()
        self.assertEqual(find_masks(self.dir, None, "desk"), self.dir / "masks-yolo")
        (self.dir / "elsewhere" / "desk").mkdir(parents=True)
        wanted = f"{self.dir}/elsewhere/{{name}}"
        self.assertEqual(find_masks(self.dir, wanted, "desk"), self.dir / "elsewhere" / "desk")
        with self.assertRaisesRegex(InputError, "does not exist"):
            find_masks(self.dir, wanted, "room")
        (self.dir / "masks-other").mkdir()
        with self.assertRaisesRegex(InputError, "has masks-other and masks-yolo"):
            find_masks(self.dir, None, "desk")

    def test_names(self):
        self.assertEqual(short_name("/data/rgbd_dataset_freiburg2_desk"), "freiburg2_desk")
        self.assertEqual(short_name("/data/my desk"), "my_desk")
        paper = {"fr2-desk": "freiburg2_desk", "fr2-person": "freiburg2_desk_with_person"}
        self.assertEqual(paper_name("freiburg2_desk_with_person", paper), "fr2-person")
        self.assertEqual(paper_name("fr2_desk", paper), "fr2-desk")
        self.assertIsNone(paper_name("my_desk", paper))

    def test_the_order_is_that_of_the_paper(self):
        paper = {"fr1-desk": "b", "fr2-desk": "a"}
        found = [read_sequence(str(fake_slam.write_tum(self.dir / name)), None, paper, CONFIG)
                 for name in ("a", "other", "b")]
        self.assertEqual([sequence.name for sequence in in_order(found, paper)], ["b", "a", "other"])

    def test_settings_without_a_shutter(self):
        path = self.dir / "camera.yaml"
        for text, expected in (("Camera.readout_time: 0.026", True), ("Camera.readout_time: 0", False),
                               ("#Camera.readout_time: 0.026", False), ("", False)):
            path.write_text(f"%YAML:1.0\n{text}\n")
            self.assertEqual(has_rolling_shutter(path), expected, text)


class SuiteTest(unittest.TestCase):
    ENTRY = {"name": "desk1", "folder": "desk1", "dataset": "tum", "masks": "desk1/masks",
             "objects": "desk1/true.json", "plays": "fr1-desk", "readout_time": 0.026,
             "special": "a desk"}

    def test_each_seed_has_a_rendering(self):
        found, = read_suite({"sequences": [self.ENTRY]}, {"fr1-desk": "x"}, None)
        self.assertEqual(found.path("masks", 2), "sequences/desk1/seed-2/desk1/masks")
        self.assertEqual(found.rendered["options"], ["--only", "desk1"])
        self.assertTrue(found.has_rolling_shutter)
        short, = read_suite({"sequences": [self.ENTRY]}, {}, 40)
        self.assertEqual(short.path("folder", 0), "sequences/desk1/seed-0-frames-40/desk1")
        self.assertIsNone(short.paper)

    def test_another_format_is_refused(self):
        for content in ({}, {"sequences": [{}]}, {"sequences": [3]},
                        {"sequences": [{**self.ENTRY, "plays": 3, "masks": None}, 1]}):
            with self.assertRaisesRegex(InputError, "suite.json of make_synthetic"):
                read_suite(content, {}, None)


if __name__ == "__main__":
    unittest.main()
