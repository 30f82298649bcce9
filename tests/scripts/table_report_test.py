#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the tables of scripts/reproduce_tables.py for results that are given: statistics, claims,
ranks, and the files for readers."""

import csv
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import fake_slam
from fake_tables import DEFINITIONS, SCRIPT

sys.path.insert(0, str(SCRIPT.parent))
from paper_tables import files, tables  # noqa: E402
from paper_tables.definitions import read_definitions  # noqa: E402
from paper_tables.plan import Request, Tools, make_plan  # noqa: E402
from paper_tables.tables import Report, compare_reports, read_report  # noqa: E402
from paper_tables.sequences import Sequence  # noqa: E402
from paper_tables.text import claims_grid, grids, number, ranking_grid  # noqa: E402
from paper_tables.figures import FIGURES, of_true_objects  # noqa: E402

PAPER = {"source": "a paper & its 100 % _tables_",
         "ate": {"rgbd": {"ORB-SLAM2": {"fr1-desk": 0.0171}, "paper": {"fr1-desk": 0.0161}}}}


class StatisticsTest(unittest.TestCase):
    def test_median_and_spread(self):
        found = tables.spread({0: 3.0, 1: None, 2: 1.0, 3: 2.0})
        self.assertEqual((found["median"], found["min"], found["max"]), (2.0, 1.0, 3.0))
        self.assertIsNone(tables.spread({0: None}))

    def test_differences(self):
        base = {("a", seed): 0.010 for seed in range(6)}
        half = {("a", seed): 0.005 for seed in range(6)}
        found = tables.difference("ate", base, half)
        self.assertAlmostEqual(found["change"], -0.5)
        self.assertAlmostEqual(found["p"], 2 / 64)
        self.assertEqual(tables.verdict("ate", found), "better")
        self.assertEqual(tables.verdict("siou", tables.difference("siou", base, half)), "worse")
        # Less lost frames are better, and a share of 0 has no logarithm.
        zero = {key: 0.0 for key in base}
        self.assertAlmostEqual(tables.difference("lost", base, zero)["change"], -0.010)
        few = {("a", 0): 0.005}
        self.assertEqual(tables.verdict("ate", tables.difference("ate", base, few)), "unclear")
        self.assertIsNone(tables.difference("ate", base, {("b", 0): 1.0}))
        self.assertEqual(tables.verdict("ate", None), "unknown")

    def test_of_several_comparisons_the_least_favourable_decides(self):
        better, worse, unclear = ({"change": change, "p": p} for change, p in
                                  ((-0.1, 0.01), (0.1, 0.01), (-0.1, 0.4)))
        self.assertEqual(tables.answer("ate", {"x": better, "y": better}), "yes")
        self.assertEqual(tables.answer("ate", {"x": better, "y": unclear}), "unclear")
        self.assertEqual(tables.answer("ate", {"x": unclear, "y": worse}), "no")
        self.assertEqual(tables.answer("ate", {"x": better, "y": None}), "unclear")

    def test_true_objects(self):
        found = of_true_objects({"groundtruth": {"visible": 4, "once": 2, "more": 1, "each": [
            {"mapped": [{"center_share": 0.2}, {"center_share": 0.4}]}, {"mapped": []}]}})
        self.assertEqual((found["found"], found["doubles"]), (0.75, 1.0))
        self.assertAlmostEqual(found["centre"], 0.3)
        self.assertEqual(of_true_objects({}), {"found": None, "doubles": None, "centre": None})

    def test_numbers_have_the_digits_of_their_figure(self):
        self.assertEqual(number(0.0123456, FIGURES["ate"]), "12.35")
        self.assertEqual(number(0.8, FIGURES["siou"]), "0.800")
        self.assertEqual(number(None, FIGURES["siou"]), "–")


class ReportTest(unittest.TestCase):
    """Two sequences, three seeds; the row `bad` has twice the error, and one of its runs failed."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        path = self.dir / "tables.yaml"
        path.write_text(DEFINITIONS)
        sequences = [Sequence(name, "tum", paper, f"/data/{name}", f"/data/{name}/masks", frames=20)
                     for name, paper in (("desk", "fr1-desk"), ("my_room", None))]
        self.request = Request(read_definitions(path), sequences, ("I", "II", "VI"),
                               ("rgbd", "mono"), range(3))
        tools = Tools(fake_slam.write_programs(self.dir / "bin"), SCRIPT.parent, self.dir)
        self.plan, self.cells = make_plan(self.request, tools)
        self.results = {name: self.result(name, run) for name, run in self.plan["runs"].items()}
        for name in self.results:
            self.write_run(name)

    def result(self, name, run):
        error = 0.010 + 0.001 * run["seed"] + (0.02 if run["level"] == "100" else 0.0)
        error *= 2 if run["variant"] == "bad" else 1
        failure = "50 % of the frames & more_lost {were}" if name.endswith("rgbd/bad/seed-2") else None
        return {"failure": failure, "git": "abc", "preset": None, "settings_hash": "1", "figures": {
            "ate_se3": error, "ate_sim3": 0.9 * error, "keyframes_ate_sim3": 0.8 * error,
            "lost": 50.0 if failure else 0.0, "siou": 0.8, "mtd": 1e-3, "found": 0.75}}

    def write_run(self, name):
        folder = self.dir / "runs" / name / "out"
        folder.mkdir(parents=True)
        fake_slam.write_truth(folder)
        (folder / "groundtruth.txt").rename(folder.parent / "groundtruth.txt")
        shutil.copy(folder.parent / "groundtruth.txt", folder / "trajectory.txt")

    def report(self):
        return Report(self.request, self.plan, self.cells, self.results, PAPER)

    def test_failed_runs_are_counted_and_not_in_the_median(self):
        block = self.report().blocks[0]
        cell, = [cell for cell in block.sequences["desk"] if cell["row"] == "bad"]
        self.assertEqual(cell["figures"]["ate_se3"]["values"], {0: 0.020, 1: 0.022})
        self.assertEqual(cell["figures"]["lost"]["values"], {0: 0.0, 1: 0.0, 2: 50.0})
        self.assertEqual(list(cell["failures"]), [2])
        self.assertEqual(block.overall["bad"]["failed"], 2)
        change = block.overall["bad"]["difference"]
        self.assertEqual((round(change["change"], 6), change["pairs"]), (1.0, 4))

    def test_claims(self):
        rgbd, mono = self.report().claims
        self.assertEqual((rgbd["mode"], rgbd["than"]["bad"]["pairs"], rgbd["answer"]),
                         ("rgbd", 4, "unclear"))
        self.assertEqual((mono["mode"], mono["than"]["bad"]["pairs"], mono["answer"]),
                         ("mono", 6, "yes"))
        rows = claims_grid(self.report()).rows
        self.assertIn("good: against bad -50.0 % (p 0.031, 6 pairs)", rows[1][3])

    def test_ranks_beside_those_of_the_paper(self):
        report = self.report()
        self.results["desk/rgbd/good/seed-1"]["figures"]["ate_sim3"] = 0.5
        rows = ranking_grid(report.blocks[0]).rows
        self.assertEqual(rows,
                         [["points only", "1.0", "2.0"], ["good", "2.0", "1.0"]])
        self.assertIsNone(ranking_grid(report.blocks[1]), "the paper has no such figures")

    def test_markdown(self):
        text = files.markdown(self.report())
        self.assertIn("|  | desk (fr1-desk) | fr2-desk | office-traj0 | my_room | against good |", text)
        self.assertIn("| bad | 21.00 / 18.90 !1 | – | – | 21.00 / 18.90 !1 | +100.0 % (p 0.12, 4 pairs) "
                      "|", text)
        self.assertIn("| good | **11.00 / 9.90 [16.10]** | – | – | **11.00 / 9.90** | – |", text)
        self.assertIn("* failed: my_room/rgbd/bad/seed-2: 50 % of the frames & more_lost {were}", text)
        self.assertIn("| features | 100 | 31.00 (30.00..32.00) |", text)
        for line in text.splitlines():
            if line.startswith("|"):
                self.assertNotIn("\n", line)

    def test_rows_of_a_table_have_the_same_number_of_cells(self):
        width = None
        for line in files.markdown(self.report()).splitlines():
            count = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else None
            if count and width:
                self.assertEqual(count, width, line)
            width = count

    def test_csv(self):
        rows = list(csv.DictReader(io.StringIO(self.report().csv_text())))
        row, = [row for row in rows if (row["table"], row["mode"], row["sequence"], row["row"],
                                        row["figure"]) == ("I", "rgbd", "desk", "bad", "ATE SE3, mm")]
        self.assertEqual((row["median"], row["min"], row["max"], row["runs"], row["failed"]),
                         ("21.000", "20.000", "22.000", "3", "1"))
        papers = {(row["mode"], row["row"], row["figure"]): row["paper"] for row in rows if row["paper"]}
        self.assertEqual(papers, {("rgbd", "points only", "ATE Sim3, mm"): "17.100",
                                  ("rgbd", "good", "ATE Sim3, mm"): "16.100"})

    def test_latex_compiles(self):
        text = files.latex(self.report())
        self.assertIn(r"50 \% of the frames \& more\_lost \{were\}", text)
        self.assertIn(r"\toprule", text)
        if shutil.which("pdflatex") is None:
            self.skipTest("pdflatex is not installed")
        (self.dir / "tables.tex").write_text(text)
        result = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "tables.tex"],
                                cwd=self.dir, capture_output=True, check=False)
        told = result.stdout.decode(errors="replace")
        self.assertEqual(result.returncode, 0, told[-3000:])
        self.assertNotIn("Overfull", told)
        self.assertTrue((self.dir / "tables.pdf").exists())

    def test_latex_escapes_every_character(self):
        for character in "\\&%$#_{}~^<>|–é":
            text = files.escape_latex(f"a{character}b")
            self.assertTrue(text.isascii())
            self.assertNotEqual(text, f"a{character}b")

    def test_a_scale_has_the_level_of_the_rows_at_its_place(self):
        path = self.dir / "tables.yaml"
        path.write_text(DEFINITIONS.replace("[features, mask_drop]", "[features]").replace(
            "levels: [500, 100]", "levels: [100, 500], unchanged: 300"))
        self.request.definitions = read_definitions(path)
        self.request.tables = ("VI",)
        tools = Tools(self.dir / "bin", SCRIPT.parent, self.dir)
        self.plan, self.cells = make_plan(self.request, tools)
        self.results = {name: self.result(name, run) for name, run in self.plan["runs"].items()}
        report = self.report()
        grid, = grids(report, report.blocks[0])
        self.assertEqual([(row[0], row[1]) for row in grid.rows if len(row) > 1],
                         2 * [("features", "100"), ("features", "300"), ("features", "500")])

    def test_a_report_without_any_result(self):
        self.results = {name: None for name in self.results}
        report = self.report()
        self.assertIn("| – | – | 0, 3 not run |", files.markdown(report))
        files.latex(report)
        self.assertEqual(report.claims, [])

    def test_comparison_with_itself_has_no_difference(self):
        path = self.dir / "tables.json"
        path.write_text(self.report().json_text())
        old = read_report(path)
        found = compare_reports(old, json.loads(self.report().json_text()))
        self.assertEqual((found["only_before"], found["only_after"]), (0, 0))
        for row in found["rows"]:
            for figure in row["figures"].values():
                self.assertEqual((figure["change"], figure["verdict"]), (0.0, "unclear"))
        del old["runs"]["desk/rgbd/good/seed-0"]
        self.assertEqual(compare_reports(old, old)["only_before"], 0)
        self.assertEqual(compare_reports(old, json.loads(self.report().json_text()))["only_after"], 1)

    def test_broken_reports_are_refused(self):
        path = self.dir / "tables.json"
        for text in ("", "[]", "{}", '{"version": 1}', '{"version": 1, "runs": [1]}',
                     '{"version": 1, "runs": {"a": {"sequence": 1}}}', '{"version": 9, "runs": {}}'):
            path.write_text(text)
            with self.subTest(text), self.assertRaisesRegex(Exception, "--compare: .*tables.json"):
                read_report(path)


if __name__ == "__main__":
    unittest.main()
