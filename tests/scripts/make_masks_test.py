#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/make_masks.py: outlines of known masks, and the whole script with a small package
in the place of ultralytics."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import cv2
import numpy as np
import PIL.Image
import PIL.ImageOps

import fake_slam

TOP = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = TOP / "scripts" / "make_masks.py"
MODULE = pathlib.Path(os.environ.get("HULLSLAM_BIN", TOP / "build" / "release" / "bin")).parent / "python"
sys.path += [str(MODULE)]
sys.path.insert(0, str(SCRIPT.parent))
import make_masks  # noqa: E402

# YOLO finds a cup and a faint person in images of 60 x 40 pixels, and nothing in every third image.
# SAM makes the mask of a box smaller by a pixel on each side. Both log their calls.
ULTRALYTICS = """
import pathlib
import numpy as np

HERE = pathlib.Path(__file__).parent


class Tensor:
    \"\"\"Like those of torch, it becomes an array by cpu().numpy() only.\"\"\"
    def __init__(self, array):
        self.array = np.asarray(array)

    def __len__(self):
        return len(self.array)

    def __getitem__(self, key):
        return Tensor(self.array[key])

    def cpu(self):
        return self

    def numpy(self):
        return self.array


class Part:
    def __init__(self, **parts):
        self.__dict__.update(parts)

    def __len__(self):
        return len(self.xyxy)


def log(text):
    with (HERE / "calls").open("a") as file:
        file.write(text + "\\n")


class YOLO:
    names = {0: "person", 41: "cup", **{i: f"c{i}" for i in range(1, 41)}}

    def __init__(self, model):
        self.model = model
        log(f"load {model}")

    def __call__(self, image, conf, retina_masks, verbose, **options):
        index = len([line for line in (HERE / "calls").read_text().splitlines() if line.startswith("yolo ")])
        size = (40, 60) if isinstance(image, str) else image.shape[:2]
        name = pathlib.Path(image).name if isinstance(image, str) else f"{size[1]}x{size[0]}"
        log(f"yolo {name} {conf} {sorted(options.items())}")
        if (HERE / "interrupt").exists() and index == 2:
            raise KeyboardInterrupt
        boxes = np.array([[10, 10, 30, 20], [40, 5, 55, 35]], dtype=float)
        scores, classes = np.array([0.9, 0.4]), np.array([41.0, 0.0])
        if index % 3 == 2:
            boxes, scores, classes = boxes[:0], scores[:0], classes[:0]
        masks = np.zeros((len(boxes), *size), dtype=np.float32)
        for mask, (x0, y0, x1, y1) in zip(masks, boxes.astype(int)):
            mask[y0:y1, x0:x1] = 1.0
        with_masks = Part(data=Tensor(masks), xyxy=boxes) if "-seg" in self.model else None
        return [Part(boxes=Part(xyxy=Tensor(boxes), cls=Tensor(classes), conf=Tensor(scores)),
                     masks=with_masks, orig_img=np.zeros((*size, 3), dtype=np.uint8))]


class SAM:
    def __init__(self, model):
        log(f"load {model}")

    def __call__(self, image, bboxes, verbose, **options):
        boxes = bboxes.cpu().numpy().astype(int)
        log(f"sam {len(boxes)}")
        if (HERE / "unsure").exists():  # of the tall box it is not sure
            boxes = np.array([box for box in boxes if box[3] - box[1] < 20], dtype=int).reshape(-1, 4)
        masks = np.zeros((len(boxes), *image.shape[:2]), dtype=bool)
        for mask, (x0, y0, x1, y1) in zip(masks, boxes):
            mask[y0 + 1:y1 - 1, x0 + 1:x1 - 1] = True
        return [Part(masks=Part(data=Tensor(masks), xyxy=boxes) if len(boxes) else None)]
"""


def polygon(line, width=60, height=40):
    """Class, outline in pixels and confidence of a line."""
    words = line.split()
    points = np.array(words[1:-1], dtype=float).reshape(-1, 2) * [width, height]
    return int(words[0]), points, float(words[-1])


@unittest.skipUnless((MODULE / "hullslam").is_dir(), "needs HullSLAM's Python module")
class OutlineTest(unittest.TestCase):
    def outline_of(self, mask):
        number, points, score = polygon(make_masks.yolo_text([(3, 0.5, mask)]), *mask.shape[::-1])
        self.assertEqual((number, score), (3, 0.5))
        return points

    def test_the_outline_of_a_rectangle_is_halfway_between_pixels(self):
        mask = np.zeros((40, 60), bool)
        mask[10:20, 15:30] = True
        outline = self.outline_of(mask)
        np.testing.assert_allclose(outline.min(axis=0), [14.5, 9.5], atol=1e-4)
        np.testing.assert_allclose(outline.max(axis=0), [29.5, 19.5], atol=1e-4)
        # The corners are cut: a triangle of an eighth of a pixel is missing at each.
        self.assertAlmostEqual(make_masks.area_of(outline), 15 * 10 - 4 / 8, delta=1e-2)
        self.assertEqual(len(outline), 8)

    def test_a_circle_keeps_its_area(self):
        y, x = np.mgrid[0:200, 0:300]
        outline = self.outline_of((x - 140.3) ** 2 + (y - 95.8) ** 2 < 60.0**2)
        self.assertAlmostEqual(make_masks.area_of(outline) / (np.pi * 60.0**2), 1.0, delta=2e-3)

    def test_the_largest_part_is_taken(self):
        mask = np.zeros((40, 60), bool)
        mask[2:6, 2:6] = mask[10:30, 10:30] = True
        mask[15:18, 15:18] = False  # a hole
        np.testing.assert_allclose(self.outline_of(mask).min(axis=0), [9.5, 9.5], atol=1e-4)

    def test_masks_at_the_border_and_empty_masks(self):
        points = self.outline_of(np.ones((40, 60), bool))
        self.assertTrue((points >= 0).all() and (points <= [60, 40]).all())
        small = np.zeros((40, 60), bool)
        small[1:4, 1:4] = True
        self.assertEqual(make_masks.yolo_text([(1, 0.9, np.zeros((40, 60), bool)), (2, 0.9, small)]), "")
        self.assertEqual(make_masks.yolo_text([]), "")


class TurnTest(unittest.TestCase):
    def test_images_are_turned_as_by_pillow(self):
        pixels = np.arange(24, dtype=np.uint8).reshape(4, 6)
        for orientation in range(1, 9):
            image = PIL.Image.fromarray(pixels)
            image.getexif()[0x0112] = orientation
            upright = make_masks.turn(pixels, orientation)
            np.testing.assert_array_equal(upright, np.array(PIL.ImageOps.exif_transpose(image)))
            np.testing.assert_array_equal(make_masks.turn_back(upright, orientation), pixels)


@unittest.skipUnless((MODULE / "hullslam").is_dir(), "needs HullSLAM's Python module")
class MakeMasksTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.package = self.dir / "packages" / "ultralytics"
        self.package.mkdir(parents=True)
        (self.package / "__init__.py").write_text(ULTRALYTICS)
        self.sequence = fake_slam.write_tum(self.dir / "desk", count=6)
        shutil.rmtree(self.sequence / "masks")

    def run_script(self, *arguments, sequence=None, has_package=True):
        path = os.pathsep.join([str(MODULE), *([str(self.dir / "packages")] if has_package else [])])
        return subprocess.run(["/usr/bin/python3", "-B", SCRIPT, sequence or self.sequence,
                               *map(str, arguments)], capture_output=True, text=True, check=False,
                              env={**os.environ, "PYTHONPATH": path}, timeout=60)

    def calls(self):
        path = self.package / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def assert_refused(self, result, message):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn(message, result.stderr)
        self.assertNotIn("Traceback", result.stderr)

    def test_boxes_of_yolo_are_refined_by_sam(self):
        result = self.run_script()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("masks of 6 images, 6 of them new", result.stdout)
        self.assertIn("6/6 images", result.stderr)
        masks = self.sequence / "masks"
        lines = (masks / "1.000000.txt").read_text().splitlines()
        number, points, score = polygon(lines[0])
        self.assertEqual((number, score), (41, 0.9))
        np.testing.assert_allclose(points.min(axis=0), [10.5, 10.5], atol=1e-3)
        np.testing.assert_allclose(points.max(axis=0), [28.5, 18.5], atol=1e-3)
        self.assertEqual(polygon(lines[1])[0], 0)
        self.assertEqual((masks / "1.200000.txt").read_text(), "", "nothing was found there")
        self.assertEqual(len(list(masks.glob("1.*.txt"))), 6)
        self.assertEqual((masks / "classes.txt").read_text().splitlines()[41], "cup")
        self.assertEqual(self.calls()[:4], ["load yolov8x-seg.pt", "load sam_b.pt",
                                            "yolo 1.000000.png 0.25 []", "sam 2"])

    def test_masks_of_yolo_alone(self):
        result = self.run_script("--refine", "none", "--confidence", 0.5, "--device", "cpu", "--out",
                                 self.dir / "out", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        _, points, _ = polygon((self.dir / "out" / "1.000000.txt").read_text().splitlines()[0])
        np.testing.assert_allclose(points.min(axis=0), [9.5, 9.5], atol=1e-3)
        self.assertIn("yolo 1.000000.png 0.5 [('device', 'cpu')]", self.calls())
        self.assertFalse((self.sequence / "masks").exists())

    def test_a_box_of_which_sam_is_not_sure_has_no_mask(self):
        (self.package / "unsure").touch()
        self.assertEqual(self.run_script().returncode, 0)
        lines = (self.sequence / "masks" / "1.000000.txt").read_text().splitlines()
        self.assertEqual([polygon(line)[0] for line in lines], [41])

    def test_an_interrupted_call_goes_on(self):
        (self.package / "interrupt").touch()
        result = self.run_script()
        self.assertEqual(result.returncode, 1)
        self.assertIn("start again to go on", result.stderr)
        self.assertEqual(len(list((self.sequence / "masks").glob("1.*.txt"))), 2)
        (self.package / "interrupt").unlink()
        self.assertIn("4 of them new", self.run_script().stdout)
        count = len(self.calls())
        self.assertIn("0 of them new", self.run_script().stdout)
        self.assertEqual(len(self.calls()), count, "the networks are not even loaded")

    def test_a_sequence_of_icl_nuim(self):
        icl = fake_slam.write_icl(self.dir / "icl", count=3)
        shutil.rmtree(icl / "masks")
        self.assertEqual(self.run_script(sequence=icl).returncode, 0)
        self.assertEqual({path.name for path in (icl / "masks").glob("?.txt")},
                         {"0.txt", "1.txt", "2.txt"})

    def test_a_folder_without_lists(self):
        (self.sequence / "rgb.txt").unlink()
        result = self.run_script()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(list((self.sequence / "masks").glob("1.*.txt"))), 6)

    def test_a_folder_of_photos(self):
        photos = self.dir / "photos"
        shutil.copytree(self.sequence / "rgb", photos)
        result = self.run_script(sequence=photos)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(list((photos / "masks").glob("1.*.txt"))), 6)
        self.assertIn("0 of them new", self.run_script(sequence=photos).stdout)

    def test_the_left_images_of_a_stereo_camera(self):
        for name in ("left", "right"):
            shutil.copytree(self.sequence / "rgb", self.dir / "stereo" / name)
        result = self.run_script(sequence=self.dir / "stereo")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(list((self.dir / "stereo" / "masks").glob("1.*.txt"))), 6)
        (self.dir / "walk.bag").touch()
        self.assert_refused(self.run_script(sequence=self.dir / "walk.bag"), "walk.bag")

    def test_photos_that_are_turned_have_masks_of_their_stored_pixels(self):
        photos = self.dir / "photos"
        photos.mkdir()
        exif = PIL.Image.Exif()
        exif[0x0112] = 6
        PIL.Image.new("RGB", (60, 40)).save(photos / "a.jpg", exif=exif)
        result = self.run_script("--refine", "none", sequence=photos)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("yolo 40x60 0.25 []", self.calls(), "the network sees it upright")
        _, points, _ = polygon((photos / "masks" / "a.txt").read_text().splitlines()[0])
        # Upright, the box is from (10, 10) to (29, 19). The stored pixel is (y, 39 - x).
        np.testing.assert_allclose(points.min(axis=0), [9.5, 9.5], atol=1e-3)
        np.testing.assert_allclose(points.max(axis=0), [19.5, 29.5], atol=1e-3)

    def test_a_video(self):
        video = self.dir / "walk.avi"
        writer = cv2.VideoWriter(str(video), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*"MJPG"), 25.0,
                                 (60, 40))
        for grey in (0, 50, 100, 150):
            writer.write(np.full((40, 60, 3), grey, np.uint8))
        writer.release()
        result = self.run_script(sequence=video)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("masks of 4 images, 4 of them new", result.stdout)
        self.assertEqual(sorted(path.name for path in (self.dir / "walk_masks").glob("0*.txt")),
                         [f"00000{number}.txt" for number in range(4)])
        self.assert_refused(self.run_script(sequence=self.package / "__init__.py"), "video")

    def test_bad_input(self):
        self.assert_refused(self.run_script(has_package=False), "has no package ultralytics")
        shutil.rmtree(self.sequence / "masks", ignore_errors=True)
        self.assert_refused(self.run_script("--model", "yolov8n.pt", "--refine", "none"),
                            "'yolov8n.pt': it gives boxes but no masks")
        self.assert_refused(self.run_script(), "has masks that were made with")
        self.assert_refused(self.run_script(sequence=self.dir / "none"), "none: no such file or folder")
        self.assert_refused(self.run_script("--confidence", 2), "expected a number from 0 to 1")
        (self.dir / "other").mkdir()
        (self.dir / "other" / "notes").touch()
        self.assert_refused(self.run_script("--out", self.dir / "other"), "none of this script")
        (self.sequence / "rgb" / "1.300000.png").unlink()
        self.assert_refused(self.run_script("--out", self.dir / "new"),
                            "1.300000.png")
        (self.sequence / "rgb.txt").write_text("# list\n1.0\n")
        self.assert_refused(self.run_script("--out", self.dir / "new"), "rgb.txt:2: ")


if __name__ == "__main__":
    unittest.main()
