#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/plot_run.py: alignment and pairing, small complete runs, and broken files."""

import contextlib
import copy
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plot_run.py"
sys.path.insert(0, str(SCRIPT.parent))
import plot_labels  # noqa: E402
import plot_run  # noqa: E402
import run_alignment  # noqa: E402
import run_files  # noqa: E402
import run_images  # noqa: E402
import run_objects  # noqa: E402

PLY_HEADER = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
              "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
              "property uchar blue\nelement face 0\nproperty list uchar int vertex_indices\n"
              "end_header\n")
TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])  # 90 degrees around z


def trajectory_text(stamps, positions):
    return "# comment\n\n" + "".join(
        f"{stamp:.6f} {x:.9f} {y:.9f} {z:.9f} 0 0 0 1\n"
        for stamp, (x, y, z) in zip(stamps, positions))


def quaternion(turn):
    """qx, qy, qz, qw of a rotation matrix: the eigenvector of Bar-Itzhack's matrix."""
    m = turn
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
                  [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
                  [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)]]) / 3.0
    return np.linalg.eigh(k)[1][:, -1]


def ply_bytes(points, colour=(10, 20, 30)):
    body = b"".join(np.array(p, "<f4").tobytes() + bytes(colour) for p in points)
    return PLY_HEADER.format(len(points)).encode() + body


def objects_file(stamps, image_size=(64, 48)):
    """objects.json with a mapped sphere and a candidate.

    The sphere has a radius of 0.2 m and is 2 m in front of the cameras, which are at the origin.
    """
    width, height = image_size
    view = {"keyframe": 0, "cam_from_world": [0, 0, 0, 0, 0, 0, 1], "class": "cup", "score": 0.9,
            "cut": False, "box": False, "hull": [[20, 10], [40, 10], [40, 30]], "contour": [],
            "lines": []}
    views = [dict(view, keyframe=i, timestamp=stamp) for i, stamp in enumerate(stamps)]
    sphere = {"id": 0, "class": "cup", "votes": {"cup": 1.0}, "state": "mapped",
              "world_from_object": [0, 0, 2, 0, 0, 0, 1], "half_axes": [0.2, 0.2, 0.2],
              "observations": views}
    camera = {"fx": 50.0, "fy": 50.0, "cx": 32.0, "cy": 24.0, "width": width, "height": height}
    return {"version": 1, "camera": camera, "candidates": 1,
            "objects": [sphere, dict(sphere, id=1, state="candidate", observations=[])]}


class ObjectTest(unittest.TestCase):
    def setUp(self):
        content = objects_file([1.0])
        self.camera, self.sphere = content["camera"], run_objects.Object(content["objects"][0])

    def test_a_sphere_ahead_projects_to_the_circle_of_its_tangent_cone(self):
        ellipse = self.sphere.seen_from(self.camera, np.array([0, 0, 0, 0, 0, 0, 1.0]))
        radius = 50 * 0.2 / np.sqrt(2.0**2 - 0.2**2)
        distances = np.linalg.norm(ellipse - [32, 24], axis=1)
        np.testing.assert_allclose(distances, radius, rtol=1e-9)

    def test_no_ellipse_of_an_object_that_is_not_in_front(self):
        for z in (-2.0, -4.0):
            self.assertIsNone(self.sphere.seen_from(self.camera, np.array([0, 0, z, 0, 0, 0, 1.0])))

    def test_moves_with_the_world(self):
        self.sphere.shape = np.diag([1.0, 4.0, 9.0])
        self.sphere.move(3.0, TURN, np.array([1.0, 2.0, 3.0]))
        np.testing.assert_allclose(self.sphere.centre, [1, 2, 9])
        ellipse = self.sphere.seen_along([0, 1]) - [1, 2]
        np.testing.assert_allclose(np.abs(ellipse).max(axis=0), [6, 3], atol=1e-9)

    def test_distortion_is_browns(self):
        camera = dict(self.camera, k1=0.1, k2=0.0, p1=0.01, p2=0.0, k3=0.0)
        # x = 1, y = 0, r2 = 1: u = 1 + 0.1, v = 0.01.
        np.testing.assert_allclose(run_objects.distort(np.array([[82.0, 24.0]]), camera),
                                   [[32 + 50 * 1.1, 24 + 50 * 0.01]])

    def test_frames_are_chosen_evenly(self):
        self.assertEqual(run_objects.choose_evenly({3, 1, 2, 5, 4}, 3), [1, 3, 5])
        self.assertEqual(run_objects.choose_evenly({1, 2}, 6), [1, 2])
        self.assertEqual(run_objects.choose_evenly(set(), 6), [])


class LabelTest(unittest.TestCase):
    def test_every_class_has_a_colour_of_its_own(self):
        names = [f"class {i}" for i in range(80)]
        colours = plot_labels.class_colours(names * 2)
        self.assertEqual(len(set(colours.values())), 80)
        few = np.array(list(plot_labels.class_colours(names[:20]).values()))
        distances = np.linalg.norm(few[:, None] - few, axis=2) + 9 * np.eye(20)
        self.assertGreater(distances.min(), 0.15)

    def test_text_is_drawn_as_it_is(self):
        for text in ("a$b$", "$\\frac{1}{", "\\$x$", "line\nbreak", "\ud800", "x" * 500):
            with self.subTest(text):
                figure, plot = plot_run.plt.subplots()
                plot.text(0.5, 0.5, plot_labels.plain(text))
                figure.canvas.draw()
                plot_run.plt.close(figure)
        self.assertLess(len(plot_labels.plain("x" * 500)), 50)

    def test_labels_do_not_overlap(self):
        figure, plot = plot_run.plt.subplots()
        self.addCleanup(plot_run.plt.close, figure)
        figure.canvas.draw()
        labels = [plot_labels.Label(f"keyboard {i}", (0.5, 0.5)) for i in range(20)]
        labels += [plot_labels.Label("outside", (1.5, 0.5)), plot_labels.Label("nan", (np.nan, 0))]
        self.assertEqual(plot_labels.draw_labels(plot, labels), 20)
        boxes = [text.get_window_extent() for text in plot.texts]
        self.assertEqual(len(boxes), 20)
        for i, box in enumerate(boxes):
            self.assertTrue(plot.get_window_extent().containsx(box.x0))
            for other in boxes[:i]:
                self.assertFalse(box.overlaps(other))

    def test_labels_without_room_are_left_out(self):
        figure, plot = plot_run.plt.subplots(figsize=(2, 2))
        self.addCleanup(plot_run.plt.close, figure)
        figure.canvas.draw()
        labels = [plot_labels.Label(f"keyboard {i}", (0.5, 0.5)) for i in range(200)]
        count = plot_labels.draw_labels(plot, labels)
        self.assertLess(count, 200)
        self.assertEqual(len(plot.texts), count)


class StageTest(unittest.TestCase):
    def test_every_stage_of_the_library_has_a_plain_name(self):
        stages = set()
        for source in (SCRIPT.parents[1] / "src").rglob("*.cc"):
            text = source.read_text(encoding="utf-8")
            stages.update(re.findall(r'ScopedTimer \w+\([^"\n]*"(\w+)"\)', text))
        self.assertGreater(len(stages), 10)
        self.assertEqual(sorted(stages - set(plot_run.STAGES)), [])


class AlignTest(unittest.TestCase):
    def test_recovers_a_motion(self):
        points = np.random.default_rng(1).normal(size=(20, 3))
        scale, rotation, translation = run_alignment.align(points, points @ TURN.T + [1, 2, 3])
        self.assertEqual(scale, 1.0)
        np.testing.assert_allclose(rotation, TURN, atol=1e-12)
        np.testing.assert_allclose(translation, [1, 2, 3], atol=1e-12)

    def test_recovers_a_scale_if_asked_for(self):
        points = np.random.default_rng(1).normal(size=(20, 3))
        moved = 2.5 * points @ TURN.T + [1, 2, 3]
        scale, rotation, translation = run_alignment.align(points, moved, True)
        self.assertAlmostEqual(scale, 2.5)
        np.testing.assert_allclose(rotation, TURN, atol=1e-12)
        np.testing.assert_allclose(translation, [1, 2, 3], atol=1e-12)
        self.assertEqual(run_alignment.align(points, moved)[0], 1.0)

    def test_never_mirrors(self):
        points = np.random.default_rng(1).normal(size=(20, 3))
        _, rotation, _ = run_alignment.align(points, points * [1, 1, -1])
        self.assertAlmostEqual(np.linalg.det(rotation), 1.0)


class PairTest(unittest.TestCase):
    def test_one_to_one_and_smallest_first(self):
        pairs = run_alignment.pair(np.array([1.0, 1.012, 5.0]), np.array([0.5, 1.010, 5.03]))
        self.assertEqual(pairs.tolist(), [[1, 1]])

    def test_none(self):
        self.assertEqual(len(run_alignment.pair(np.array([1.0]), np.array([2.0]))), 0)


class PlotRunTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.truth = self.dir / "groundtruth.txt"
        stamps = 1000 + np.arange(40) / 30
        positions = np.stack([np.cos(stamps), np.sin(stamps), 0.1 * np.cos(3 * stamps)], axis=1)
        self.write("trajectory.txt", trajectory_text(stamps, positions))
        # Shifts of 10 mm, alternately up and down, leave an error that no alignment removes.
        shift = np.where(np.arange(40) % 2, 0.01, -0.01)[:, None] * [0, 0, 1]
        self.write("groundtruth.txt", trajectory_text(stamps + 0.005, positions @ TURN.T + shift))

    def write(self, name, data):
        data = data if isinstance(data, bytes) else data.encode()
        (self.dir / name).write_bytes(data)

    def plot(self, *arguments):
        """Runs the script in this process, which is faster than starting a new one."""
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            code = plot_run.main([str(word) for word in (self.dir, *arguments)])
        plot_run.plt.close("all")
        return subprocess.CompletedProcess(arguments, code, out.getvalue(), errors.getvalue())

    def assert_drawn(self, result, path):
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def assert_refused(self, result, *parts):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)

    def test_whole_run(self):
        self.write("keyframes.txt", trajectory_text([1000.0], [[1, 0, 0]]))
        self.write("map.ply", ply_bytes([[1, 2, 3], [4, 5, 6]]))
        self.write("summary.json", '{"trajectory": {"frames": 40, "tracked": 40, "lost": 0},'
                   '"timing": {"track_ms": {"median": 9.5, "p95": 12}, "frames_per_second": 31}}')
        result = self.plot("--groundtruth", self.truth, "--out", self.dir / "a" / "b")
        self.assert_drawn(result, self.dir / "a" / "b" / "run.png")
        self.assertIn("0.0100 m (SE3, all frames, 40 pairs)", result.stdout)
        self.assertIn("9.5 ms median", result.stdout)

    def test_the_scale_of_a_monocular_run_is_aligned(self):
        stamps = 1000 + np.arange(40) / 30
        positions = np.stack([np.cos(stamps), np.sin(stamps), 0.1 * np.cos(3 * stamps)], axis=1)
        self.write("trajectory.txt", trajectory_text(stamps, 0.2 * positions))
        self.write("summary.json", '{"trajectory": {"alignment": "sim3"}}')
        result = self.plot("--groundtruth", self.truth)
        self.assert_drawn(result, self.dir / "run.png")
        self.assertIn("0.0100 m (Sim3, all frames, 40 pairs)", result.stdout)

    def test_as_a_program(self):
        result = subprocess.run([SCRIPT, self.dir / "none"], capture_output=True, text=True,
                                check=False, timeout=60)
        self.assert_refused(result, "trajectory.txt")
        result = subprocess.run([SCRIPT, self.dir], capture_output=True, text=True, check=False,
                                timeout=60)
        self.assert_drawn(result, self.dir / "run.png")
        self.assertEqual(result.stderr, "")

    def test_trajectory_alone(self):
        result = self.plot()
        self.assert_drawn(result, self.dir / "run.png")
        self.assertNotIn("ATE", result.stdout)

    def test_summary_with_unknown_values(self):
        self.write("summary.json", '{"trajectory": {"ate_rmse_m": null}, "timing": {"track_ms":'
                   '{"median": null, "p95": null}, "stages_ms": null}}')
        self.assert_drawn(self.plot(), self.dir / "run.png")

    def test_output_of_map_objects(self):
        """Nothing is tracked, so all times are 0. They are not shown, and there is no warning."""
        zeros = {"median": 0.0, "mean": 0.0, "p95": 0.0, "max": 0.0}
        self.write("summary.json", json.dumps(
            {"trajectory": {"frames": 300, "tracked": 300, "lost": 0},
             "timing": {"track_ms": zeros, "stages_ms": {}, "frames_per_second": 0.0},
             "provenance": {"pipeline": "objects"}}))
        result = subprocess.run([SCRIPT, self.dir], capture_output=True, text=True, check=False,
                                timeout=60)
        self.assert_drawn(result, self.dir / "run.png")
        self.assertEqual(result.stderr, "")
        self.assertIn("frames           300, tracked 300, lost 0", result.stdout)
        self.assertNotIn("0.0", result.stdout)

    def views(self, path=None):
        run = plot_run.Run(self.dir)
        if path:
            run.align_to(path)
        return plot_run.views_of(run)

    def write_held(self, up, count=40):
        """Cameras that look around and are held with their tops to `up`, which is an axis."""
        up = np.array(up, dtype=float)
        lines, stamps = [], 1000 + np.arange(count) / 30
        for i, stamp in enumerate(stamps):
            side = np.roll(up, 1)
            angle = 0.05 * i
            forward = np.cos(angle) * side + np.sin(angle) * np.cross(up, side)
            turn = np.stack([np.cross(-up, forward), -up, forward], axis=1)
            x, y, z = forward + 0.1 * i * side + 0.05 * np.sin(i) * up
            lines.append(f"{stamp:.6f} {x} {y} {z} " + " ".join(map(str, quaternion(turn))) + "\n")
        self.write("trajectory.txt", "".join(lines))
        self.write("groundtruth.txt", "".join(lines))

    def test_up_is_the_axis_along_which_cameras_are_held(self):
        """The horizontal axes of the view and up are right-handed, so it is no mirror image."""
        for axis in range(3):
            for sign in (1, -1):
                with self.subTest(axis=axis, sign=sign):
                    self.write_held(sign * np.eye(3)[axis])
                    above, side = self.views(self.truth)
                    self.assertEqual([above.title, side.title], ["from above", "from the side"])
                    right, ahead = np.eye(3)[above.axes]
                    ahead = -ahead if above.is_flipped else ahead
                    np.testing.assert_array_equal(np.cross(right, ahead), sign * np.eye(3)[axis])
                    self.assertEqual((side.axes[1], side.is_flipped), (axis, sign < 0))

    def test_a_run_without_ground_truth_is_drawn_upright(self):
        self.write_held([0, -1, 0])
        run = plot_run.Run(self.dir)
        above, behind = plot_run.views_of(run)
        self.assertEqual([above.title, behind.title], ["from above", "from behind"])
        self.assertEqual((behind.names[1], behind.is_flipped), ("up, as the camera was held", False))
        np.testing.assert_allclose(-run.turns[:, :, 1].mean(axis=0), [0, 0, 1], atol=1e-9)
        np.testing.assert_allclose(run.turns[0][:, 2], [0, 1, 0], atol=1e-9)
        np.testing.assert_allclose(run.positions[0], 0, atol=1e-9)

    def test_the_axes_are_named_if_up_is_not_known(self):
        """The camera rolls all around."""
        angles = np.linspace(0, 2 * np.pi, 40)
        self.write("trajectory.txt", "".join(
            f"{1000 + i / 30:.6f} {i} {i % 3} 0 0 0 {np.sin(a / 2)} {np.cos(a / 2)}\n"
            for i, a in enumerate(angles)))
        self.assertEqual([view.title for view in self.views()],
                         ["x and y of the run's world", "x and z of the run's world"])

    def test_points_decide_if_the_camera_looks_down_at_45_degrees(self):
        up = np.array([0.0, 0.7, 0.71])
        desk = np.random.default_rng(2).uniform(-1, 1, (1000, 3))
        for axis in (1, 2):
            flat = desk.copy()
            flat[:900, axis] = 0.3
            self.assertEqual(plot_run.nearest_axis(up, flat), axis)
        self.assertEqual(plot_run.nearest_axis(up, desk[:10]), 2)

    def test_the_unit_is_the_metre_only_if_it_is_known(self):
        run = plot_run.Run(self.dir)
        self.assertEqual(run.unit(), "m")
        for sizes, unit in ((None, "unknown unit"), (0, "unknown unit"), (2, "m")):
            self.write("summary.json", json.dumps(
                {"trajectory": {"alignment": "sim3"}, "map": {"known_sizes": sizes}}))
            run = plot_run.Run(self.dir)
            self.assertEqual(run.unit(), unit)
        self.write("summary.json", '{"trajectory": {"alignment": "sim3"}}')
        run = plot_run.Run(self.dir)
        run.align_to(self.truth)
        self.assertEqual(run.unit(), "m")

    def texts(self, run):
        figure, plots = plot_run.plt.subplots(1, 3)
        self.addCleanup(plot_run.plt.close, figure)
        plot_run.draw_view(plots[0], run, plot_run.View([0, 1], "x"))
        plot_run.draw_over_time(plots[1], run)
        plot_run.draw_times(plots[2], run)
        return plots

    def test_lost_frames_are_shown(self):
        stamps = np.concatenate([1000 + np.arange(20) / 30, 1003 + np.arange(20) / 30])
        positions = np.stack([stamps - 1000, np.sin(stamps), np.cos(stamps)], axis=1)
        self.write("trajectory.txt", trajectory_text(stamps, positions))
        self.write("summary.json", '{"trajectory": {"frames": 110, "lost": 70}}')
        run = plot_run.Run(self.dir)
        self.assertEqual(run.gaps(), [19])
        self.assertEqual(plot_run.describe_poses(run), "40 of 110 frames have a pose")
        view, over_time, _ = self.texts(run)
        dotted = [line for line in view.lines if line.get_linestyle() == ":"]
        np.testing.assert_allclose(dotted[0].get_xydata(), positions[19:21, :2])
        self.assertEqual(over_time.get_legend_handles_labels()[1], ["no pose"])
        self.assertIn("distance", over_time.get_ylabel(), "no empty panel without ground truth")
        self.assertTrue(np.isnan(over_time.lines[0].get_ydata()).any(), "no line over the gap")

    def test_a_run_without_a_gap_has_none(self):
        self.assertEqual(plot_run.Run(self.dir).gaps(), [])

    def test_stages_have_names_that_users_know(self):
        self.write("summary.json", json.dumps(
            {"timing": {"stages_ms": {"map_insert": {"median": 1, "p95": 2}}}}))
        times = self.texts(plot_run.Run(self.dir))[2]
        self.assertEqual([tick.get_text() for tick in times.get_yticklabels()], ["new keyframe"])

    def test_the_legend_hides_no_peak(self):
        run = plot_run.Run(self.dir)
        run.align_to(self.truth)
        over_time = self.texts(run)[1]
        over_time.figure.canvas.draw()
        legend = over_time.get_legend().get_window_extent()
        self.assertGreaterEqual(legend.y0, over_time.get_window_extent().y1 - 1)

    def test_views_are_not_mirrored(self):
        self.write_held([0, -1, 0])
        run = plot_run.Run(self.dir)
        for view in plot_run.views_of(run):
            figure, plot = plot_run.plt.subplots()
            self.addCleanup(plot_run.plt.close, figure)
            plot_run.draw_view(plot, run, view)
            turns = plot.transData.transform(np.eye(2)) - plot.transData.transform([[0, 0], [0, 0]])
            self.assertGreater(np.linalg.det(turns), 0)

    def write_summary(self, sequence):
        self.write("summary.json", json.dumps({"provenance": {"sequence": str(sequence)}}))

    def test_finds_the_ground_truth_of_the_sequence(self):
        self.write("rgb.txt", "")
        self.write_summary(self.dir)
        result = self.plot()
        self.assertIn("0.0100 m (SE3", result.stdout)
        self.assertNotIn("ATE", self.plot("--no-groundtruth").stdout)
        self.write_summary("elsewhere")
        self.assertNotIn("ATE", self.plot().stdout)
        self.assertIn("0.0100 m (SE3", self.plot("--sequence", self.dir).stdout)

    def test_takes_the_ground_truth_that_the_run_has_converted(self):
        self.write("summary.json", json.dumps({"files": ["groundtruth.txt", "trajectory.txt"]}))
        self.assertIn("0.0100 m (SE3", self.plot().stdout)
        for files in ("groundtruth.txt", [1]):
            self.write("summary.json", json.dumps({"files": files}))
            self.assert_refused(self.plot(), "summary.json: files: expected a list of texts")

    def test_unsuitable_ground_truth_of_the_sequence_is_not_used(self):
        self.write("rgb.txt", "")
        self.write_summary(self.dir)
        for text in ("1 2 3\n", trajectory_text([1.0, 2.0], [[0, 0, 0], [1, 0, 0]])):
            self.write("groundtruth.txt", text)
            result = self.plot()
            self.assert_drawn(result, self.dir / "run.png")
            self.assertIn("note: drawn without ground truth", result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)

    def test_relative_path_of_the_sequence(self):
        sequence = self.dir.parent / f"{self.dir.name}-data"
        sequence.mkdir()
        self.addCleanup(sequence.rmdir)
        (sequence / "rgb.txt").write_text("")
        self.addCleanup((sequence / "rgb.txt").unlink)
        found = run_files.find_sequence_at(sequence.name, self.dir / "out")
        self.assertEqual(found.resolve(), sequence.resolve())
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(sequence.parent)
        found = run_files.find_sequence_at(sequence.name, pathlib.Path("/nowhere"))
        self.assertEqual(found.resolve(), sequence.resolve())
        self.assertIsNone(run_files.find_sequence_at("none", self.dir))
        self.assertIsNone(run_files.find_sequence_at("x" * 5000, self.dir))

    def test_dollars_and_other_characters_in_names(self):
        content = objects_file([1000.0])
        content["objects"][0]["class"] = "a$b_{$ \\frac \u0000 \ud800"
        self.write_objects([1000.0])
        self.write("objects.json", json.dumps(content))
        self.write("summary.json", json.dumps(
            {"timing": {"stages_ms": {"a$b$_{": {"median": 1, "p95": 2}}}}))
        result = self.plot("--overlay", "1", "--sequence", self.dir / "sequence")
        self.assert_drawn(result, self.dir / "run.png")
        self.assertEqual(result.stderr, "")

    def test_empty_map(self):
        self.write("map.ply", ply_bytes([]))
        self.assert_drawn(self.plot(), self.dir / "run.png")

    def test_reads_points_and_colours(self):
        self.write("map.ply", ply_bytes([[1, 2, 3], [4, 5, 6]]))
        points, colours, dropped = run_files.read_map(self.dir / "map.ply", 100)
        np.testing.assert_array_equal(points, [[1, 2, 3], [4, 5, 6]])
        np.testing.assert_allclose(colours[1], np.array([10, 20, 30]) / 255)
        self.assertEqual(dropped, 0)

    def test_points_that_cannot_be_drawn_are_left_out(self):
        points = [[1, 2, 3], [np.nan, 0, 0], [0, np.inf, 0], [0, 0, -5.9e6], [4, 5, 6]]
        self.write("map.ply", ply_bytes(points))
        drawn, colours, dropped = run_files.read_map(self.dir / "map.ply", 2)
        np.testing.assert_array_equal(drawn, [[1, 2, 3], [4, 5, 6]])
        self.assertEqual((len(colours), dropped), (2, 3))
        result = self.plot()
        self.assert_drawn(result, self.dir / "run.png")
        self.assertIn("note: 3 points of", result.stderr)

    def write_objects(self, stamps=(1000.0, 1000.5), images=True):
        self.write("objects.json", json.dumps(objects_file(stamps)))
        (self.dir / "sequence" / "rgb").mkdir(parents=True)
        for i in range(len(stamps) if images else 0):
            plot_run.plt.imsave(self.dir / "sequence" / "rgb" / f"{i}.png", np.zeros((48, 64)))
        self.write("sequence/rgb.txt", "# stamp file\n" + "".join(
            f"{stamp:.6f} rgb/{i}.png\n" for i, stamp in enumerate(stamps)))

    def test_objects(self):
        self.write_objects()
        self.write("summary.json", json.dumps(
            {"objects": {"count": 1, "siou_mean": 0.8125, "mtd_mean_m2": None},
             "provenance": {"sequence": str(self.dir / "sequence")}}))
        result = self.plot("--groundtruth", self.truth, "--overlay", "6")
        self.assert_drawn(result, self.dir / "run.png")
        self.assert_drawn(result, self.dir / "overlays.png")
        self.assertIn("objects          1, SIoU 0.812", result.stdout)

    def test_sequence_may_be_given(self):
        self.write_objects()
        self.assert_refused(self.plot("--overlay", "2"), "--sequence")
        result = self.plot("--overlay", "2", "--sequence", self.dir / "sequence")
        self.assert_drawn(result, self.dir / "overlays.png")

    def test_overlays_without_objects(self):
        result = self.plot("--overlay", "2", "--sequence", self.dir / "sequence")
        self.assert_drawn(result, self.dir / "run.png")
        self.assertIn("none: no objects", result.stdout)

    def test_overlays_of_another_sequence(self):
        self.write_objects()
        overlay = ["--overlay", "2", "--sequence"]
        self.assert_refused(self.plot(*overlay, self.dir / "none"), "rgb.txt", "--sequence")
        self.write("sequence/rgb.txt", "5.0 rgb/0.png\n")
        self.assert_refused(self.plot(*overlay, self.dir / "sequence"), "no image of 1000.000000")
        self.write("sequence/rgb.txt", "one two\n")
        self.assert_refused(self.plot(*overlay, self.dir / "sequence"), "rgb.txt")
        self.write("sequence/rgb.txt", "\n")
        self.assert_refused(self.plot(*overlay, self.dir / "sequence"), "lists no images")
        self.assert_refused(self.plot("--overlay", "-1"), "--overlay")

    def test_broken_images(self):
        self.write_objects(images=False)
        overlay = ["--overlay", "2", "--sequence", self.dir / "sequence"]
        self.assert_refused(self.plot(*overlay), "0.png")
        self.write("sequence/rgb/0.png", b"\x89PNG\r\n\x1a\n")
        self.assert_refused(self.plot(*overlay), "0.png")

    def test_broken_objects(self):
        good = objects_file([1.0])
        flat = json.loads(json.dumps(good))
        flat["objects"][0]["half_axes"] = [0, 1, 1]
        short = json.loads(json.dumps(good))
        del short["objects"][0]["half_axes"]
        for content in ("{", "[]", "{}", json.dumps(flat), json.dumps(short)):
            with self.subTest(content):
                self.write("objects.json", content)
                self.assert_refused(self.plot(), "objects.json")

    def test_no_run(self):
        (self.dir / "trajectory.txt").unlink()
        self.assert_refused(self.plot(), "trajectory.txt")

    def test_malformed_trajectories(self):
        for line in ("1 2 3", "1 0 0 0 0 0 0 x", "1 nan 0 0 0 0 0 1", "1 0 0 0 0 0 0 1 9"):
            with self.subTest(line):
                self.write("trajectory.txt", f"# stamp\n{line}\n")
                self.assert_refused(self.plot(), "trajectory.txt:2", "8 numbers")
        self.write("trajectory.txt", "# nothing\n")
        self.assert_refused(self.plot(), "no poses")

    def test_ground_truth_of_something_else(self):
        self.write("groundtruth.txt", trajectory_text([1.0, 2.0], [[0, 0, 0], [1, 0, 0]]))
        self.assert_refused(self.plot("--groundtruth", self.truth), "groundtruth.txt", "0 poses")

    def test_broken_maps(self):
        good = ply_bytes([[1, 2, 3], [4, 5, 6]])
        for data, part in ((good[:-1], "cut short"), (b"", "not a PLY"), (b"\xff\xd8\xff", "PLY"),
                           (good.replace(b"binary_little_endian", b"ascii"), "binary"),
                           (good.replace(b"float y", b"list y z"), "unknown type")):
            with self.subTest(part):
                self.write("map.ply", data)
                self.assert_refused(self.plot(), "map.ply", part)

    def test_broken_summary(self):
        texts = ["{", "[]", "[" * 100000, "\xff", '{"timing": 1}', '{"timing": {"stages_ms": []}}',
                 '{"timing": {"stages_ms": {"a": 5}}}', '{"timing": {"track_ms": "fast"}}',
                 '{"timing": {"track_ms": {"median": "9", "p95": 1}}}',
                 '{"timing": {"track_ms": {"median": 1, "p95": NaN}}}',
                 '{"timing": {"frames_per_second": [1]}}', '{"trajectory": {"frames": "many"}}',
                 '{"trajectory": {"frames": 1e400}}', '{"objects": {"count": {}}}',
                 '{"provenance": "x"}', '{"provenance": {"sequence": 7}}',
                 '{"provenance": {"sequence": "a\\u0000b"}}']
        for text in texts:
            with self.subTest(text[:50]):
                self.write("summary.json", text)
                self.assert_refused(self.plot(), "summary.json")

    def test_values_that_objects_cannot_have(self):
        good = objects_file([1000.0])
        changes = [(["camera"], None), (["camera", "fx"], 0), (["camera", "cy"], "24"),
                   (["camera", "k1"], 1e200), (["objects"], {}), (["objects", 0], 5),
                   (["objects", 0, "id"], "x"), (["objects", 0, "class"], None),
                   (["objects", 0, "state"], 3), (["objects", 0, "half_axes"], [1, 1]),
                   (["objects", 0, "half_axes"], [1, -1, 1]),
                   (["objects", 0, "half_axes"], [1, float("inf"), 1]),
                   (["objects", 0, "half_axes"], [1e-200, 1, 1]),
                   (["objects", 0, "half_axes", 0], 10**400),
                   (["objects", 0, "world_from_object"], [0] * 7),
                   (["objects", 0, "world_from_object", 0], float("nan")),
                   (["objects", 0, "world_from_object", 6], 1e300),
                   (["objects", 0, "world_from_object"], "0000000"),
                   (["objects", 0, "observations"], 3), (["objects", 0, "observations", 0], []),
                   (["objects", 0, "observations", 0, "timestamp"], "now"),
                   (["objects", 0, "observations", 0, "timestamp"], float("nan")),
                   (["objects", 0, "observations", 0, "hull"], 1),
                   (["objects", 0, "observations", 0, "hull"], []),
                   (["objects", 0, "observations", 0, "hull", 1], [1]),
                   (["objects", 0, "observations", 0, "hull", 1, 1], 1e300),
                   (["objects", 0, "observations", 0, "cam_from_world"], [0, 0, 0, 1]),
                   (["objects", 0, "observations", 0, "cam_from_world", 0], True)]
        for keys, value in changes:
            with self.subTest(keys=keys, value=str(value)[:20]):
                content = copy.deepcopy(good)
                parent = content
                for key in keys[:-1]:
                    parent = parent[key]
                parent[keys[-1]] = value
                self.write("objects.json", json.dumps(content))
                self.assert_refused(self.plot(), "objects.json")
        self.write("objects.json", "[" * 100000)
        self.assert_refused(self.plot(), "objects.json", "nested too deeply")

    def test_maps_that_are_not_possible(self):
        good = ply_bytes([[1, 2, 3], [4, 5, 6]])
        header = good[:good.index(b"end_header")]
        broken = [header, header + b"x\n" * 100000, good.replace(b"vertex 2", b"vertex " + b"9" * 18),
                  good.replace(b"vertex 2", b"vertex " + b"9" * 9000),
                  good.replace(b"float y", b"float x"), good.replace(b"float y", b"float w"),
                  good.replace(b"element vertex", b"element face 1\nelement vertex"),
                  good.replace(b"uchar red", b"float red")]
        for i, data in enumerate(broken):
            with self.subTest(i):
                self.write("map.ply", data)
                self.assert_refused(self.plot(), "map.ply")

    def test_folders_and_other_bytes_instead_of_files(self):
        for name in ("map.ply", "keyframes.txt", "summary.json", "objects.json"):
            with self.subTest(name):
                (self.dir / name).mkdir()
                self.assert_refused(self.plot(), name)
                (self.dir / name).rmdir()
                self.write(name, b"\x00\xff\xfe" * 100)
                self.assert_refused(self.plot(), name)
                (self.dir / name).unlink()
        for line in ("1 1e155 0 0 0 0 0 1", "1e300 0 0 0 0 0 0 1"):
            self.write("trajectory.txt", line + "\n")
            self.assert_refused(self.plot(), "trajectory.txt:1", "too large")

    def overlay(self, sequence, *arguments):
        self.write("objects.json", json.dumps(objects_file((2.0, 2.1))))
        return self.plot("--overlay", "2", "--sequence", self.dir / sequence, *arguments)

    def test_overlays_of_images_without_a_list(self):
        names = {"numbers/rgb/f20.png": "10", "stamps/rgb/2.0.png": None, "plain/a.png": "10"}
        for name in [*names, "numbers/rgb/f21.png", "stamps/rgb/2.1.png", "plain/b.png"]:
            (self.dir / name).parent.mkdir(parents=True, exist_ok=True)
            plot_run.plt.imsave(self.dir / name, np.zeros((48, 64)))
        for sequence, offset in (("numbers", "0"), ("stamps", "0"), ("plain", "2")):
            with self.subTest(sequence):
                result = self.overlay(sequence, "--fps", "10", "--stamp-offset", offset)
                self.assert_drawn(result, self.dir / "overlays.png")
        self.assert_refused(self.overlay("plain"), "no image of 2.000000", "--stamp-offset")

    def test_overlays_of_a_video(self):
        import cv2
        path = self.dir / "desk.avi"
        video = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*"MJPG"), 10.0,
                                (64, 48))
        for i in range(4):
            video.write(np.full((48, 64, 3), 40 * i, np.uint8))
        video.release()
        images = run_images.open_images(path, None, 1.9)
        self.assertAlmostEqual(float(images.at(2.0).mean()), 40, delta=3)
        self.assertAlmostEqual(float(images.at(2.1).mean()), 80, delta=3)
        self.assert_drawn(self.overlay("desk.avi", "--stamp-offset", "1.9"),
                          self.dir / "overlays.png")
        self.assert_refused(self.overlay("desk.avi"), "no image of 2.000000")
        self.write("broken.avi", b"no video")
        self.assert_refused(self.overlay("broken.avi"), "broken.avi")

    def test_another_python_is_told_what_to_do(self):
        """A Python without numpy is stood in for by one that finds no installed packages."""
        result = subprocess.run([sys.executable, "-E", "-S", SCRIPT, self.dir], text=True,
                                capture_output=True, check=False, timeout=60)
        self.assert_refused(result, "has no numpy and no matplotlib", "/usr/bin/python3")

    def test_images_of_other_kinds(self):
        self.write_objects()
        self.write("sequence/rgb/0.png", (self.dir / "sequence/rgb/1.png").read_bytes()[:-30])
        overlay = ["--overlay", "2", "--sequence", self.dir / "sequence"]
        self.assert_refused(self.plot(*overlay), "0.png")
        self.write("sequence/rgb.txt", "nan rgb/0.png\n")
        self.assert_refused(self.plot(*overlay), "rgb.txt")


if __name__ == "__main__":
    unittest.main()
