#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/ablation.py with a small program instead of rgbd_tum."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "ablation.py"
sys.path.insert(0, str(SCRIPT.parent))
import ablation  # noqa: E402

# Its ATE is 0.01 + 0.001 * seed, or twice that with objects.residual=bad. It logs its calls.
PROGRAM = """#!/usr/bin/python3
import json, pathlib, sys
arguments = sys.argv[1:]
value = lambda name: arguments[arguments.index(name) + 1]
here = pathlib.Path(__file__).parent
with (here / "calls").open("a") as calls:
    calls.write(" ".join(arguments) + "\\n")
if "mode=refuse" in arguments:
    print("error: mode is 'refuse'", file=sys.stderr)
    sys.exit(2)
if "mode=crash" in arguments and not (here / "mended").exists():
    sys.exit(1)
out = pathlib.Path(value("--output"))
out.mkdir(parents=True, exist_ok=True)
ate = (0.01 + 0.001 * int(value("--seed"))) * (2 if "objects.residual=bad" in arguments else 1)
objects = None if "--no-masks" in arguments else {"count": 6, "siou_mean": 0.8, "mtd_mean_m2": 1e-3}
(out / "summary.json").write_text(json.dumps({
    "trajectory": {"ate_rmse_m": ate, "tracked": 798, "frames": 800}, "objects": objects,
    "timing": {"track_ms": {"median": 9.5}}}))
"""


class VariantTest(unittest.TestCase):
    def test_settings_become_arguments(self):
        self.assertEqual(ablation.parse_variant("a:x.y=1,z=b"),
                         ("a", ["--set", "x.y=1", "--set", "z=b"]))
        self.assertEqual(ablation.parse_variant("none:"), ("none", []))
        self.assertEqual(ablation.parse_variant("p:--preset=paper,x=1"),
                         ("p", ["--preset=paper", "--set", "x=1"]))
        self.assertEqual(ablation.parse_variant("c:list=a\\,b"), ("c", ["--set", "list=a,b"]))

    def test_malformed_variants_are_refused(self):
        for text in ("a", ":x=1", "a/b:x=1", "a:x", "a:=1", "a:x=", "..:x=1", ".:", ".a:x=1"):
            with self.subTest(text), self.assertRaises(ablation.InputError):
                ablation.parse_variant(text)


def result(sequence, variant, ate):
    return {"sequence": sequence, "variant": variant, "runs": 1, "failed": 0,
            "ates": {f"{sequence} 0": ate},
            "figures": ablation.collect([{"trajectory": {"ate_rmse_m": ate}}])}


class FiguresTest(unittest.TestCase):
    def test_mean_and_deviation_of_known_values(self):
        runs = [{"trajectory": {"ate_rmse_m": ate}, "objects": None} for ate in (1.0, 3.0, None)]
        row = ablation.collect(runs)
        self.assertEqual(row["ATE m"]["mean"], 2.0)
        self.assertAlmostEqual(row["ATE m"]["sd"], 2.0**0.5)
        self.assertEqual(row["ATE m"]["values"], [1.0, 3.0])
        self.assertIsNone(row["SIoU"]["mean"])
        self.assertIsNone(ablation.collect([])["ATE m"]["mean"])

    def test_change_is_against_the_first_of_the_same_sequence(self):
        text = ablation.table([result("a", "off", 0.02), result("a", "on", 0.01),
                               result("b", "off", 0.1), result("b", "on", 0.11)])
        changes = [line.split("|")[-4].strip() for line in text.splitlines()[2:]]
        self.assertEqual(changes[:4], ["-", "-50.0 %", "-", "+10.0 %"])

    def test_mean_over_the_sequences(self):
        text = ablation.table([result("a", "off", 0.02), result("a", "on", 0.01),
                               result("b", "off", 0.1), result("b", "on", 0.11)])
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()]
        self.assertEqual(rows[-2][:4], ["mean", "off", "2", "0.06000"])
        # The geometric mean of 0.5 and 1.1. Two pairs of which one rises and one falls prove nothing.
        self.assertEqual(rows[-1][:4] + rows[-1][-3:],
                         ["mean", "on", "2", "0.06000", "-25.8 %", "1", "2"])
        one = ablation.table([result("a", "off", 0.02), result("a", "on", 0.01)])
        self.assertNotIn("mean", one)
        incomplete = ablation.table([result("a", "off", 0.02), result("b", "off", 0.01),
                                     result("a", "on", 0.01)])
        self.assertIn("| mean | off |", incomplete)
        self.assertNotIn("| mean | on |", incomplete)

    def test_lost_frames_are_a_share(self):
        row = ablation.collect([{"trajectory": {"frames": 200, "tracked": 150}},
                                {"trajectory": {"frames": 200, "tracked": 200}}])
        self.assertEqual(row["lost %"]["mean"], 12.5)
        self.assertIsNone(ablation.collect([{"trajectory": {"tracked": 5}}])["lost %"]["mean"])


class AblationTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.program = self.dir / "fake_slam"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        (self.dir / "desk").mkdir()

    def run_script(self, *arguments):
        return subprocess.run([SCRIPT, "--program", self.program, "--out", self.dir / "out",
                               "--sequence", self.dir / "desk", *arguments],
                              capture_output=True, text=True, check=False, timeout=60)

    def calls(self):
        path = self.dir / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def assert_refused(self, result, part):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn(part, result.stderr)

    def test_every_variant_and_seed_is_run_and_in_the_table(self):
        result = self.run_script("--seeds", "3", "--common", "--masks 'a b'", "--variant", "good:",
                                 "--variant", "bad:objects.residual=bad")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.calls()), 6)
        self.assertIn("--masks a b --set objects.residual=bad --seed 2 --quiet", self.calls()[5])
        table = (self.dir / "out" / "ablation.md").read_text()
        self.assertTrue(result.stdout.endswith(table))
        self.assertIn("| desk | good | 3 | 0.01100 ± 0.00100 | 798 | 0.2 | 6.0 | 0.800 | - | 1.00e-03 |",
                      table)
        self.assertIn("| 9.5 | +100.0 % | 0.25 | 3 |", table)
        results = json.loads((self.dir / "out" / "ablation.json").read_text())
        self.assertEqual(results[1]["arguments"], ["--set", "objects.residual=bad"])
        self.assertEqual(len(results[1]["figures"]["ATE m"]["values"]), 3)

    def test_seed_and_sequence_are_replaced(self):
        result = self.run_script("--sequence", self.dir / "room-{seed}", "--seeds", "2", "--common",
                                 "--masks {sequence}/masks --first {seed}", "--variant", "v:")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{self.dir}/desk --masks {self.dir}/desk/masks --first 1 --seed 1",
                      self.calls()[1])
        self.assertIn(f"{self.dir}/room-1 --masks {self.dir}/room-1/masks --first 1 --seed 1",
                      self.calls()[3])
        self.assertIn("| room | v | 2 |", result.stdout)
        self.assertTrue((self.dir / "out" / "room" / "v" / "seed-1" / "summary.json").exists())

    def test_two_sequences_of_one_name_are_refused(self):
        """Their runs would share a folder, and the table would compare one with the other."""
        for other in ("other/desk", "desk-{seed}", "desk"):
            with self.subTest(other):
                result = self.run_script("--sequence", self.dir / other, "--variant", "v:")
                self.assert_refused(result, "have the same name 'desk'")
        self.assertEqual(self.calls(), [])

    def test_runs_without_masks(self):
        result = self.run_script("--seeds", "1", "--variant", "none:--no-masks")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("| desk | none | 1 | 0.01000 | 798 | 0.2 | - | - |", result.stdout)

    def test_finished_runs_are_not_repeated(self):
        once = ["--seeds", "2", "--variant", "v:"]
        first = self.run_script(*once)
        self.assertEqual(len(self.calls()), 2)
        again = self.run_script(*once)
        self.assertEqual(len(self.calls()), 2)
        self.assertEqual(again.stdout, first.stdout)
        self.run_script("--seeds", "3", "--variant", "v:")  # one more
        self.assertEqual(len(self.calls()), 3)
        self.run_script("--seeds", "1", "--variant", "v:x=1")  # other settings
        self.assertEqual(len(self.calls()), 4)
        self.program.write_text(PROGRAM + "\n# another build\n")
        self.run_script("--seeds", "1", "--variant", "v:x=1")
        self.assertEqual(len(self.calls()), 5)

    def test_runs_with_broken_results_are_repeated(self):
        self.run_script("--seeds", "1", "--variant", "v:")
        (self.dir / "out" / "desk" / "v" / "seed-0" / "summary.json").write_text("{")
        self.assertEqual(self.run_script("--seeds", "1", "--variant", "v:").returncode, 0)
        self.assertEqual(len(self.calls()), 2)

    def test_failed_runs_are_reported_and_repeated(self):
        arguments = ["--seeds", "2", "--variant", "good:", "--variant", "crash:mode=crash"]
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 1)
        self.assertIn("seed 0: exit code 1", result.stderr)
        self.assertIn("| desk | crash | 0 (2 failed) | - |", result.stdout)
        (self.dir / "mended").touch()
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.calls()), 6)

    def test_bad_input_ends_the_script_at_once(self):
        self.assert_refused(self.run_script("--variant", "v:mode=refuse"), "mode is 'refuse'")
        self.assertEqual(len(self.calls()), 1)

    def test_variants_of_a_file(self):
        path = self.dir / "variants.txt"
        path.write_text("# first\ngood:\n\nbad:objects.residual=bad\n")
        result = self.run_script("--seeds", "1", "--variants", path, "--variant", "last:x=1")
        self.assertEqual(result.returncode, 0, result.stderr)
        names = [line.split("|")[2].strip() for line in result.stdout.splitlines() if "|" in line]
        self.assertEqual(names[2:], ["good", "bad", "last"])
        path.write_text("# nothing\n")
        self.assert_refused(self.run_script("--variants", path), "has no variant")
        self.assert_refused(self.run_script("--variants", self.dir / "none"), "cannot read")
        self.assert_refused(self.run_script(), "--variant")

    def test_a_sequence_may_have_another_program(self):
        other = self.dir / "mono_tum"
        other.write_text(PROGRAM.replace('"calls"', '"mono_calls"'))
        other.chmod(0o755)
        result = self.run_script("--seeds", "1", "--sequence", f"mono_tum={self.dir}/desk",
                                 "--variant", "v:")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.calls()), 1)
        self.assertEqual(len((self.dir / "mono_calls").read_text().splitlines()), 1)
        self.assertIn("| desk-mono_tum | v | 1 |", result.stdout)
        self.assertIn("| mean | v | 2 |", result.stdout)
        self.assert_refused(self.run_script("--sequence", f"rgbd_icl={self.dir}/desk", "--variant",
                                            "v:"), "rgbd_icl: no such program")

    def test_several_runs_at_once_give_the_same_table(self):
        arguments = ["--seeds", "3", "--variant", "good:", "--variant", "bad:objects.residual=bad"]
        one = self.run_script(*arguments)
        table = (self.dir / "out" / "ablation.md").read_text()
        (self.dir / "out").rename(self.dir / "one")
        several = self.run_script(*arguments, "--jobs", "4")
        self.assertEqual(several.returncode, 0, several.stderr)
        self.assertEqual((self.dir / "out" / "ablation.md").read_text(), table)
        self.assertEqual(len(self.calls()), 12)
        self.assertTrue(one.stdout.endswith(table))

    def test_several_runs_are_made_at_once(self):
        """Each waits for the other one, so one after the other would never end."""
        self.program.write_text(PROGRAM.replace("out = pathlib", """import time
(here / f"began-{value('--seed')}").touch()
while len(list(here.glob("began-*"))) < 2:
    time.sleep(0.01)
out = pathlib"""))
        result = self.run_script("--seeds", "2", "--variant", "v:", "--jobs", "2", "--timeout", "20")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_bad_usage(self):
        self.assert_refused(self.run_script("--variant", "v"), "NAME:KEY=VALUE")
        self.assert_refused(self.run_script("--variant", "v:", "--variant", "v:x=1"), "same name")
        self.assert_refused(self.run_script("--seeds", "0", "--variant", "v:"), "--seeds")
        for common in ("--masks 'a", '"', "a\\"):
            with self.subTest(common):
                self.assert_refused(self.run_script(f"--common={common}", "--variant", "v:"),
                                    "--common")
        self.assert_refused(self.run_script("--variant", "..:"), "does not begin with a dot")
        for timeout in ("0", "-1", "nan"):
            self.assert_refused(self.run_script("--variant", "v:", f"--timeout={timeout}"),
                                "--timeout")
        self.program.unlink()
        self.assert_refused(self.run_script("--variant", "v:"), "no such program")
        self.assertEqual(self.calls(), [])


if __name__ == "__main__":
    unittest.main()
