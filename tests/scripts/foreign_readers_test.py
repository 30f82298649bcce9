#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that the libraries of Foxglove read what --mcap writes, and that the validator of Khronos
accepts the glTF of export. Debian does not have them, so npm installs them beside the programs. The
tests are skipped without npm, or if it cannot reach its registry."""

import base64
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("HULLSLAM_BIN", ROOT / "build" / "release" / "bin"))
MODULES = BIN.parent / "npm" / "node_modules"
PACKAGES = ("@mcap/core@2.2.2", "@mcap/support@1.1.0", "@foxglove/rosmsg@5.0.5",
            "@foxglove/rosmsg2-serialization@3.1.0", "gltf-validator@2.0.0-dev.3.10")
FRAMES = 24


def setUpModule():
    if shutil.which("npm") is None:
        raise unittest.SkipTest("npm is not installed")
    MODULES.parent.mkdir(exist_ok=True)
    try:
        subprocess.run(["npm", "install", "--prefix", MODULES.parent, "--no-save", "--prefer-offline",
                        "--fetch-retries=0", "--no-audit", "--no-fund", *PACKAGES],
                       check=True, capture_output=True, text=True, timeout=60)
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
        raise unittest.SkipTest(f"npm cannot install the packages: {error} {error.stderr}")


def run_with_node(script, file):
    output = subprocess.run(["node", ROOT / "tests" / "support" / script, file, MODULES],
                            check=True, capture_output=True, text=True).stdout
    return json.loads(output)


def read_trajectory(file):
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    return np.array([[float(number) for number in line.split()] for line in lines])


def row_of(stamp, position, rotation):
    return [stamp["sec"] + stamp["nsec" if "nsec" in stamp else "nanosec"] / 1e9,
            *(position[axis] for axis in "xyz"), *(rotation[axis] for axis in "xyzw")]


class ForeignReaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        desk = cls.folder / "desk"
        subprocess.run([BIN / "make_synthetic", desk, "--frames", str(FRAMES), "--quiet"], check=True)
        cls.out = cls.folder / "out"
        subprocess.run([BIN / "rgbd_tum", desk, "--masks", desk / "masks", "--output", cls.out,
                        "--mcap", cls.folder / "run.mcap", "--save-map", cls.folder / "desk.map",
                        "--quiet"], check=True)
        cls.images = sorted((desk / "rgb").iterdir())
        cls.read = run_with_node("read_mcap.cjs", cls.folder / "run.mcap")
        cls.topics = cls.read["topics"]

    def one(self, topic, kind):
        self.assertEqual(self.topics[topic]["type"], kind)
        self.assertEqual(self.topics[topic]["count"], 1)
        return self.topics[topic]["messages"][0]

    def test_the_statistics_are_those_of_the_messages(self):
        self.assertEqual(self.read["profile"], "ros2")
        counts = {topic: found["count"] for topic, found in self.topics.items()}
        self.assertEqual(counts, {
            "/map/path": 1, "/map/points": 1, "/map/objects": 1, "/map/scene": 1, "/tf": FRAMES,
            "/camera/camera_info": FRAMES, "/camera/image/compressed": FRAMES})
        self.assertEqual(self.read["messages"], sum(counts.values()))
        times = [time for found in self.topics.values() for time in found["times"]]
        self.assertEqual((self.read["start"], self.read["end"]), (min(times), max(times)))

    def test_poses_are_those_of_the_trajectory(self):
        expected = read_trajectory(self.out / "trajectory.txt")
        path = self.one("/map/path", "nav_msgs/msg/Path")
        self.assertEqual(path["header"]["frame_id"], "map")
        poses = [row_of(pose["header"]["stamp"], pose["pose"]["position"],
                        pose["pose"]["orientation"]) for pose in path["poses"]]
        transforms = [message["transforms"][0] for message in self.topics["/tf"]["messages"]]
        self.assertEqual(transforms[0]["child_frame_id"], "camera")
        moved = [row_of(each["header"]["stamp"], each["transform"]["translation"],
                        each["transform"]["rotation"]) for each in transforms]
        for rows in (np.array(poses), np.array(moved)):
            rows[:, 4:] *= np.where(rows[:, 7:] < 0, -1, 1)
            np.testing.assert_allclose(rows, expected, atol=2e-6)

    def test_live_poses_have_an_odometry(self):
        subprocess.run([BIN / "rgbd_tum", self.folder / "desk", "--output", self.folder / "live",
                        "--live-poses", "--mcap", self.folder / "live.mcap", "--quiet"], check=True)
        topics = run_with_node("read_mcap.cjs", self.folder / "live.mcap")["topics"]
        self.assertEqual(topics["/odom"]["type"], "nav_msgs/msg/Odometry")
        self.assertEqual(topics["/odom"]["count"], FRAMES)
        for sent, odometry in zip(topics["/tf"]["messages"], topics["/odom"]["messages"]):
            names = [(each["header"]["frame_id"], each["child_frame_id"]) for each in sent["transforms"]]
            self.assertEqual(names, [("map", "odom"), ("odom", "camera")])
            self.assertEqual(odometry["pose"]["pose"]["position"],
                             sent["transforms"][1]["transform"]["translation"])
        covariance = np.reshape(odometry["pose"]["covariance"], (6, 6))
        np.testing.assert_allclose(covariance, covariance.T, rtol=1e-6)
        self.assertGreater(np.linalg.eigvalsh(covariance).min(), 0.0)
        np.testing.assert_array_less(np.sqrt(np.diag(covariance)), 0.05)

    def test_images_are_those_of_the_sequence(self):
        message = self.topics["/camera/image/compressed"]["messages"][0]
        self.assertEqual(message["format"], "jpeg")
        image = cv2.imdecode(np.frombuffer(base64.b64decode(message["data"]), np.uint8),
                             cv2.IMREAD_COLOR)
        original = cv2.imread(str(self.images[0]))
        self.assertLess(np.abs(image.astype(float) - original).mean(), 5.0)
        camera = self.topics["/camera/camera_info"]["messages"][0]
        self.assertEqual((camera["width"], camera["height"]), (640, 480))
        self.assertGreater(camera["k"][0], 100)
        self.assertEqual(camera["p"][0], camera["k"][0])

    def test_points_are_those_of_the_map(self):
        points = self.one("/map/points", "sensor_msgs/msg/PointCloud2")
        data = np.frombuffer(base64.b64decode(points["data"]), np.float32).reshape(-1, 4)
        self.assertEqual([field["name"] for field in points["fields"]], ["x", "y", "z", "rgb"])
        self.assertEqual(len(data), points["width"])
        summary = json.loads((self.out / "summary.json").read_text(encoding="utf-8"))["map"]
        self.assertEqual(len(data), summary["landmarks"] - summary["landmarks_at_infinity"])
        colours = np.ascontiguousarray(data[:, 3]).view(np.uint32)
        self.assertGreater(len(set(colours)), 20)

    def test_objects_are_those_of_the_map(self):
        objects = json.loads((self.out / "objects.json").read_text(encoding="utf-8"))["objects"]
        mapped = [each for each in objects if each["state"] == "mapped"]
        self.assertGreater(len(mapped), 0)
        detections = self.one("/map/objects", "vision_msgs/msg/Detection3DArray")["detections"]
        entities = self.one("/map/scene", "foxglove_msgs/msg/SceneUpdate")["entities"]
        self.assertEqual(len(detections), len(mapped))
        for detection, entity in zip(detections, entities):
            sphere = entity["spheres"][0]
            self.assertEqual(sphere["size"], detection["bbox"]["size"])
            self.assertEqual(sphere["pose"], detection["bbox"]["center"])
            self.assertEqual(entity["texts"][0]["text"], detection["id"])
            self.assertAlmostEqual(sum(each["hypothesis"]["score"] for each in detection["results"]), 1)

    def test_gltf_is_valid(self):
        for source, form in ((self.out, "ellipsoids"), (self.folder / "desk.map", "boxes")):
            file = self.folder / f"{form}.glb"
            subprocess.run([BIN / "hullslam", "export", source, "--to", "gltf", "--output", file,
                            "--objects-as", form], check=True, capture_output=True)
            issues = run_with_node("validate_gltf.cjs", file)
            self.assertEqual((issues["numErrors"], issues["numWarnings"]), (0, 0), issues["messages"])


if __name__ == "__main__":
    unittest.main()
