#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/plot_run.py: alignment and pairing, small complete runs, and broken files."""

import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plot_run.py"
sys.path.insert(0, str(SCRIPT.parent))
import plot_run  # noqa: E402
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
        self.sphere.move(TURN, np.array([1.0, 2.0, 3.0]))
        np.testing.assert_allclose(self.sphere.centre, [1, 2, 5])
        ellipse = self.sphere.seen_along([0, 1]) - [1, 2]
        np.testing.assert_allclose(np.abs(ellipse).max(axis=0), [2, 1], atol=1e-9)

    def test_distortion_is_browns(self):
        camera = dict(self.camera, k1=0.1, k2=0.0, p1=0.01, p2=0.0, k3=0.0)
        # x = 1, y = 0, r2 = 1: u = 1 + 0.1, v = 0.01.
        np.testing.assert_allclose(run_objects.distort(np.array([[82.0, 24.0]]), camera),
                                   [[32 + 50 * 1.1, 24 + 50 * 0.01]])

    def test_frames_are_chosen_evenly(self):
        self.assertEqual(run_objects.choose_evenly({3, 1, 2, 5, 4}, 3), [1, 3, 5])
        self.assertEqual(run_objects.choose_evenly({1, 2}, 6), [1, 2])
        self.assertEqual(run_objects.choose_evenly(set(), 6), [])

    def test_a_class_has_one_colour(self):
        self.assertEqual(run_objects.colour_of("cup"), run_objects.colour_of("cup"))
        self.assertNotEqual(run_objects.colour_of("cup"), run_objects.colour_of("keyboard"))


class AlignTest(unittest.TestCase):
    def test_recovers_a_motion(self):
        points = np.random.default_rng(1).normal(size=(20, 3))
        rotation, translation = plot_run.align(points, points @ TURN.T + [1, 2, 3])
        np.testing.assert_allclose(rotation, TURN, atol=1e-12)
        np.testing.assert_allclose(translation, [1, 2, 3], atol=1e-12)

    def test_never_mirrors(self):
        points = np.random.default_rng(1).normal(size=(20, 3))
        rotation, _ = plot_run.align(points, points * [1, 1, -1])
        self.assertAlmostEqual(np.linalg.det(rotation), 1.0)


class PairTest(unittest.TestCase):
    def test_one_to_one_and_smallest_first(self):
        pairs = plot_run.pair(np.array([1.0, 1.012, 5.0]), np.array([0.5, 1.010, 5.03]))
        self.assertEqual(pairs.tolist(), [[1, 1]])

    def test_none(self):
        self.assertEqual(len(plot_run.pair(np.array([1.0]), np.array([2.0]))), 0)


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

    def test_as_a_program(self):
        result = subprocess.run([SCRIPT, self.dir / "none"], capture_output=True, text=True,
                                check=False, timeout=60)
        self.assert_refused(result, "trajectory.txt")
        result = subprocess.run([SCRIPT, self.dir], capture_output=True, text=True, check=False,
                                timeout=60)
        self.assert_drawn(result, self.dir / "run.png")

    def test_trajectory_alone(self):
        result = self.plot()
        self.assert_drawn(result, self.dir / "run.png")
        self.assertNotIn("ATE", result.stdout)

    def test_summary_with_unknown_values(self):
        self.write("summary.json", '{"trajectory": {"ate_rmse_m": null}, "timing": {"track_ms":'
                   '{"median": null, "p95": null}, "stages_ms": null}}')
        self.assert_drawn(self.plot(), self.dir / "run.png")

    def test_empty_map(self):
        self.write("map.ply", ply_bytes([]))
        self.assert_drawn(self.plot(), self.dir / "run.png")

    def test_reads_points_and_colours(self):
        self.write("map.ply", ply_bytes([[1, 2, 3], [4, 5, 6]]))
        points, colours = plot_run.read_map(self.dir / "map.ply")
        np.testing.assert_array_equal(points, [[1, 2, 3], [4, 5, 6]])
        np.testing.assert_allclose(colours[1], np.array([10, 20, 30]) / 255)

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
        for text in ("{", "[]"):
            with self.subTest(text):
                self.write("summary.json", text)
                self.assert_refused(self.plot(), "summary.json")


if __name__ == "__main__":
    unittest.main()
