#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/plot_run.py: what it draws and prints for made-up reports, the report that it asks
the program `view` for, and broken files."""

import base64
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

from in_process import run_main

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plot_run.py"
sys.path.insert(0, str(SCRIPT.parent))
import plot_run  # noqa: E402

LENGTH = 40  # poses


def numbers(values, kind="f32"):
    data = np.asarray(values, plot_run.TYPES[kind]).tobytes()
    return {kind: base64.b64encode(data).decode()}


def picture(time, outlines=True):
    file = io.BytesIO()
    plot_run.plt.imsave(file, np.zeros((48, 64)), format="jpeg")
    shape = {"object": 0, "class": "cup", "points": [10, 10, 30, 10, 20, 30]}
    return {"time": time, "width": 64, "height": 48, "outlines": [shape] * outlines,
            "ellipses": [shape] * outlines,
            "image": "data:image/jpeg;base64," + base64.b64encode(file.getvalue()).decode()}


def parts(**changes):
    """The parts of the report of a camera that looks around, 10 mm beside the truth, with a mapped
    ellipsoid and a candidate."""
    times = np.arange(LENGTH) / 30.0
    positions = np.stack([np.cos(times), 0 * times, np.sin(times)], axis=1)
    poses = np.hstack([positions, np.tile([0, 0, 0, 1], (LENGTH, 1))])
    item = {"id": 0, "class": "cup", "state": "mapped", "centre": [0, 0, 2], "rotation": [0, 0, 0, 1],
            "half_axes": [1, 2, 3]}
    found = {"run": {"title": "desk", "unit": "m", "notes": []}, "up": [0, -1, 0],
             "trajectory": {"time": numbers(times), "pose": numbers(poses)},
             "keyframes": {"pose": numbers(poses[::10])},
             "landmarks": {"position": numbers([[0, 0, 1], [1, 1, 2]]),
                           "colour": numbers([[255, 0, 0], [0, 0, 255]], "u8")},
             "groundtruth": {"position": numbers(positions)},
             "errors": {"time": numbers(times), "value": numbers(np.full(LENGTH, 0.01))},
             "losses": [], "objects": [item, {**item, "id": 1, "state": "candidate"}],
             "images": [picture(i / 10.0, i != 1) for i in range(9)],
             "summary": {"trajectory": {"frames": 50, "tracked": LENGTH, "alignment": "se3"},
                         "objects": {"count": 1, "siou_mean": 0.8125}}}
    found.update(changes)
    return {name: part for name, part in found.items() if part is not None}


def page_of(data):
    return f'<script type="application/json" id="hullslam-data">{json.dumps({"set": data})}</script>'


class PlotRunTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        self.dir = self.top / "desk"
        self.dir.mkdir()

    def plot(self, *arguments):
        result = run_main(plot_run.main, self.dir, *arguments)
        plot_run.plt.close("all")
        return result

    def plot_report(self, *arguments, **changes):
        (self.dir / "report.html").write_text(page_of(parts(**changes)))
        return self.plot(*arguments)

    def assert_drawn(self, result, path=None):
        self.assertEqual(result.returncode, 0, result.stderr)
        path = path or self.dir / "run.png"
        self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def assert_refused(self, result, *parts_of_error):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for part in parts_of_error:
            self.assertIn(part, result.stderr)
        self.assertFalse((self.dir / "run.png").exists())

    def test_whole_run(self):
        result = self.plot_report("--overlay", "6", "--out", self.top / "a" / "b")
        self.assert_drawn(result, self.top / "a" / "b" / "run.png")
        self.assert_drawn(result, self.top / "a" / "b" / "overlays.png")
        self.assertIn("0.0100 m (SE3, all frames, 40 pairs)", result.stdout)
        self.assertRegex(result.stdout, r"tracked +40\n")
        self.assertRegex(result.stdout, r"SIoU +0.8125\n")
        self.assertEqual(result.stderr, "")

    def test_without_ground_truth(self):
        self.assertNotIn("ATE", self.plot_report("--no-groundtruth").stdout)
        result = self.plot_report(errors=None, groundtruth=None)
        self.assert_drawn(result)
        self.assertNotIn("ATE", result.stdout)

    def test_only_poses(self):
        data = parts()
        (self.dir / "report.html").write_text(page_of(
            {name: data[name] for name in ("run", "trajectory")}))
        result = self.plot("--overlay", "2")
        self.assert_drawn(result)
        self.assertIn("none: no objects", result.stdout)

    def test_up_and_the_first_camera_turn_the_views(self):
        """Both views are right-handed, so they are no mirror images."""
        for up in ([0, -1, 0], [0, -0.6, -0.8], [0, 0.01, 1]):
            run = plot_run.Run(parts(up=up), True)
            (_, _, above), (_, _, behind) = plot_run.views_of(run)
            np.testing.assert_allclose(np.cross(*above) @ up, np.linalg.norm(up), atol=1e-9)
            np.testing.assert_allclose(behind[1] @ up, np.linalg.norm(up), atol=1e-9)
            np.testing.assert_allclose(above @ above.T, np.eye(2), atol=1e-9)
        self.assertGreater(plot_run.views_of(plot_run.Run(parts(), True))[0][2][1] @ [0, 0, 1], 0.9)
        self.assertEqual(plot_run.views_of(plot_run.Run(parts(up=None), True))[0][0],
                         "x and y of the run's world")

    def test_an_ellipsoid_is_seen_along_an_axis(self):
        item = {**parts()["objects"][0], "rotation": [0, 0, 0.5**0.5, 0.5**0.5]}  # x becomes y
        points = plot_run.ellipse_of(item, np.eye(3)[[0, 1]])
        np.testing.assert_allclose(np.abs(points).max(axis=0), [2, 1], rtol=1e-3)

    def test_lost_frames_break_the_path(self):
        run = plot_run.Run(parts(losses=[{"from": 0.34, "to": 0.36}, {"from": 9.0, "to": 9.5}]), True)
        self.assertEqual(run.gaps, [11])
        self.assert_drawn(self.plot_report(losses=[{"from": 0.34, "to": 0.36}]))

    def test_overlays_are_chosen_evenly_among_keyframes_with_objects(self):
        self.assertIn("--overlay: is '-1'", self.plot_report("--overlay", "-1").stderr)
        drawn = []
        with unittest.mock.patch.object(plot_run, "draw_overlay",
                                        lambda plot, shown, _: drawn.append(shown["time"]) or []):
            self.plot_report("--overlay", "3")
        self.assertEqual(drawn, [0.0, 0.5, 0.8])

    def test_outlines_of_masks_are_dotted_and_ellipses_are_not(self):
        _, plot = plot_run.plt.subplots()
        (label, point), = plot_run.draw_overlay(plot, picture(0.0), {"cup": "red"})
        self.assertEqual([patch.get_linestyle() for patch in plot.patches], [":", "-"])
        self.assertEqual((label, point.tolist()), ("cup 0", [20.0, 50.0 / 3.0]))
        plot_run.plt.close("all")

    def test_overlays_need_images(self):
        self.assert_refused(self.plot_report("--overlay", "2", images=None), "--sequence")

    def test_labels_do_not_overlap_and_are_texts(self):
        figure, plot = plot_run.plt.subplots()
        figure.canvas.draw()
        points = np.random.default_rng(1).uniform(-0.1, 1.1, (200, 2))
        labels = [(f"a$b_{{$ \\frac \x00 {i}" + "x" * (i % 90), point) for i, point in enumerate(points)]
        count = plot_run.draw_labels(plot, labels)
        self.assertTrue(5 < count < 200)
        boxes = [text.get_window_extent() for text in plot.texts]
        self.assertEqual(len(boxes), count)
        for i, box in enumerate(boxes):
            self.assertTrue(plot.get_window_extent().contains(box.x0, box.y0))
            self.assertFalse(any(box.overlaps(other) for other in boxes[:i]))

    def test_broken_parts_are_errors_and_other_notes_are_told(self):
        head = parts()["run"]
        for note in ("trajectory left out: a.txt:2: bad", "landmarks left out: map.ply: cut short"):
            self.assert_refused(self.plot_report(run={**head, "notes": [note]}), note)
        result = self.plot_report(run={**head, "notes": ["3 points of map.ply left out: not finite"]})
        self.assert_drawn(result)
        self.assertIn("note: 3 points", result.stderr)

    def test_pages_that_are_no_report(self):
        for text in ("", "<html>", page_of({})[:-40], '<script type="application/json" '
                     'id="hullslam-data">{"view": 1}</script>'):
            (self.dir / "report.html").write_text(text)
            self.assert_refused(self.plot(), "report.html")

    def stand_in(self, body):
        """A program `hullslam` with the given body. "$2" is the run, "$5" the page."""
        programs = self.top / "bin"
        programs.mkdir(exist_ok=True)
        (programs / "hullslam").write_text(f"#!/bin/bash\n{body}\n")
        (programs / "hullslam").chmod(0o755)
        (self.top / "page").write_text(page_of(parts()))
        patch = unittest.mock.patch.object(plot_run, "programs_folder", lambda: programs)
        patch.start()
        self.addCleanup(patch.stop)

    def test_view_makes_a_missing_report(self):
        self.stand_in(f'[ "$1" = view ] && [ "$2" = {self.dir} ] && [ "$3" = --report ] && cp {self.top}/page "$5"')
        self.assert_drawn(self.plot())

    def test_view_gets_the_given_ground_truth_and_sequence(self):
        (self.dir / "summary.json").write_text('{"provenance": {"sequence": "x", "seed": 3}}')
        (self.dir / "groundtruth.txt").write_text("old")
        (self.dir / "map.ply").write_text("points")
        (self.top / "truth").write_text("new")
        self.stand_in(f'cp $2/* {self.top}/bin && cp {self.top}/page "$5"')
        self.assert_drawn(self.plot("--groundtruth", self.top / "truth", "--sequence", self.top))
        given = {path.name: path.read_text() for path in (self.top / "bin").iterdir()}
        self.assertEqual((given["groundtruth.txt"], given["map.ply"]), ("new", "points"))
        self.assertEqual(json.loads(given["summary.json"]),
                         {"provenance": {"sequence": str(self.top.resolve()), "seed": 3}})
        self.assertEqual((self.dir / "groundtruth.txt").read_text(), "old")
        (self.dir / "run.png").unlink()
        self.assert_refused(self.plot("--groundtruth", self.top / "none"), "none: does not exist")

    def test_the_error_of_view_is_shown(self):
        self.stand_in('echo "error: desk/summary.json: not valid" >&2; exit 2')
        self.assert_refused(self.plot(), "error: desk/summary.json: not valid")
        (self.top / "bin" / "hullslam").unlink()
        self.assert_refused(self.plot(), "bin/hullslam: no such program")

    def test_as_a_program(self):
        (self.dir / "report.html").write_text(page_of(parts()))
        result = subprocess.run([SCRIPT, self.dir], capture_output=True, text=True, check=False)
        self.assert_drawn(result)
        self.assertEqual(result.stderr, "")

    def test_another_python_is_told_what_to_do(self):
        """A Python without numpy is stood in for by one that finds no installed packages."""
        result = subprocess.run([sys.executable, "-E", "-S", SCRIPT, self.dir], text=True,
                                capture_output=True, check=False)
        self.assert_refused(result, "has no numpy and no matplotlib", "/usr/bin/python3")


if __name__ == "__main__":
    unittest.main()
