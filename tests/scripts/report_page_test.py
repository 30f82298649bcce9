#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of report.html in a browser: reports of one rendered sequence, by several programs. The
programs are in $HULLSLAM_BIN. Skipped without Chromium or Selenium."""

import colorsys
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import browser

BIN = pathlib.Path(os.environ.get("HULLSLAM_BIN", "build/release/bin"))
SOURCE = pathlib.Path(__file__).resolve().parents[2]
CONFIG = SOURCE / "config"
FRAMES = 60
NASTY = "<img src=x onerror=alert(1)>\"'&\u2028\U0001F600</script>"


def find_data(name):
    """A recorded sequence in $HULLSLAM_DATA or in shared/data near the source tree, if it is there."""
    folders = [pathlib.Path(os.environ["HULLSLAM_DATA"])] if "HULLSLAM_DATA" in os.environ else [
        parent / "shared" / "data" for parent in SOURCE.parents]
    return next((folder / name for folder in folders if (folder / name).is_dir()), None)


def program(name, *arguments):
    result = subprocess.run([str(BIN / name.split()[0]), *name.split()[1:], *map(str, arguments)], capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        raise AssertionError(f"{name}: {result.stderr}")
    return result.stdout


def hue_of_class(label):
    """The hue of a class in objects.ply, in degrees: FNV-1a of its name."""
    value = 2166136261
    for byte in label.encode():
        value = (value ^ byte) * 16777619 % 2**32
    return (value >> 16) % 360


@unittest.skipIf(browser.missing(), browser.missing())
class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.desk = cls.folder / "desk"
        program("make_synthetic", cls.desk, "--scene", "desk", "--frames", FRAMES, "--quiet")
        cls.run_folder = cls.folder / "run"
        program("rgbd_tum", cls.desk, "--masks", cls.desk / "masks", "--output", cls.run_folder,
                "--save-map", cls.folder / "desk.map", "--report", "--quiet")
        cls.page = browser.Browser()
        cls.addClassCleanup(cls.page.close)
        cls.objects = {entry["id"]: entry for entry in json.loads(
            (cls.run_folder / "objects.json").read_text(encoding="utf-8"))["objects"]}

    def open(self, path, scheme="dark"):
        self.page.size(1100, 900)
        self.page.prefer(scheme)
        self.page.open(path)
        return self.page

    def expect_good(self, page):
        self.assertEqual(page.errors(), [])
        self.assertGreater(browser.count_colours(page.canvas()), 20)

    def test_the_report_of_a_run_draws_in_both_colours_and_sizes(self):
        report = self.run_folder / "report.html"
        self.assertLess(report.stat().st_size, 20e6)
        for scheme in ("dark", "light"):
            page = self.open(report, scheme)
            brightness = page.canvas()[2, 2].mean()
            self.assertTrue(brightness > 0.8 if scheme == "light" else brightness < 0.2, brightness)
            for width in (1400, 400):
                page.size(width, 900)
                self.expect_good(page)
                self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), width)

    def click_an_object(self, page):
        """Clicks the first mapped object that is in the view alone; returns its id."""
        for number in self.objects:
            at = page.run("return window.hullslam.view.screenOf(arguments[0])", number)
            if at is None or self.objects[number]["state"] != "mapped":
                continue
            page.click(*at)
            if page.run("return document.getElementById('card').dataset.object") == str(number):
                return number
        raise AssertionError("no object could be clicked")

    def test_a_clicked_object_shows_what_objects_json_says(self):
        page = self.open(self.run_folder / "report.html")
        number = self.click_an_object(page)
        truth = self.objects[number]
        card = page.text("#card")
        self.assertIn(f"{truth['class']} {number}", card)
        facts = dict(zip(page.run("return [...document.querySelectorAll('#card dt')]"
                                  ".map((e) => e.innerText)"),
                         page.run("return [...document.querySelectorAll('#card dd')]"
                                  ".map((e) => e.innerText)")))
        self.assertEqual(facts["Views"], str(truth["observations"]))
        self.assertEqual(facts["Quality"], f"{truth['quality']:.2f}")
        self.assertEqual(facts["Misfit"], f"{truth['misfit_px']:.1f} px")
        sizes = [float(size) for size in facts["Size"].replace("\u00a0cm", "").split(" × ")]
        expected = sorted((200 * axis for axis in truth["half_axes"]), reverse=True)
        np.testing.assert_allclose(sizes, expected, atol=0.051)
        self.assertIn(max(truth["votes"], key=truth["votes"].get), card)
        self.assertGreater(page.run("return document.querySelectorAll('#card .cutouts img').length"), 0)
        self.assertEqual(page.errors(), [])

    def test_the_slider_moves_the_camera_and_the_view_follows(self):
        page = self.open(self.run_folder / "report.html")
        def slide(to):
            page.run("const s = document.getElementById('slider'); s.value = arguments[0];"
                     "s.dispatchEvent(new Event('input'))", to)
            page.draw()
            return page.canvas()
        first, last = slide(0), slide(FRAMES - 1)
        self.assertGreater(np.abs(first - last).max(), 0.2)
        self.assertIn(f"{FRAMES}/{FRAMES}", page.text("#clock"))
        position = "return window.hullslam.view.camera.position.toArray()"
        before = page.run(position)
        page.run("document.getElementById('follow').click()")
        slide(0)
        self.assertGreater(np.linalg.norm(np.subtract(before, page.run(position))), 0.01)
        self.assertEqual(page.errors(), [])

    def test_layers_can_be_switched_off(self):
        page = self.open(self.run_folder / "report.html")
        before = page.canvas()
        names = page.run("return [...document.querySelectorAll('[data-layer]')]"
                         ".map((e) => e.dataset.layer)")
        self.assertLessEqual({"objects", "landmarks", "trajectory", "groundtruth", "keyframes"},
                             set(names))
        page.run("document.querySelectorAll('[data-layer]:checked').forEach((e) => e.click())")
        after = page.canvas()
        self.assertLess(browser.count_colours(after), browser.count_colours(before) / 2)

    def test_a_mesh_of_the_run_is_a_layer(self):
        mesh, report = self.run_folder / "mesh.ply", self.folder / "surface.html"
        program("hullslam mesh", self.run_folder, "--output", mesh, "--voxel", 0.03, "--quiet")
        program("hullslam view", self.run_folder, "--report", "--output", report, "--quiet")
        mesh.unlink()
        page = self.open(report)
        self.expect_good(page)
        before = page.canvas()
        page.run("document.querySelector('[data-layer=surface]').click()")
        page.draw()
        changed = np.abs(page.canvas() - before).max(axis=2) > 0.05
        self.assertGreater(changed.mean(), 0.05)
        self.assertIn("age", page.run("return Object.keys(window.hullslam.store.parts.landmarks)"))

    def test_the_row_of_layers_is_whole_and_a_colouring_has_a_legend(self):
        page = self.open(self.run_folder / "report.html")
        for width in (1400, 390):
            page.size(width, 900)
            cut = page.run("const l = document.getElementById('layers');"
                           "const right = l.getBoundingClientRect().right;"
                           "return [...l.children].filter((e) =>"
                           " e.getBoundingClientRect().right > right).length")
            self.assertEqual(cut, 0, f"{width} px")
        page.run("const s = document.querySelector('#layers select'); s.value = 'age';"
                 "s.dispatchEvent(new Event('change'))")
        self.assertIn(" s", page.text("#layers .legend"))
        self.assertEqual(page.errors(), [])

    def test_a_class_has_the_colour_of_its_name(self):
        page = self.open(self.run_folder / "report.html")
        shown = page.run("return [...document.querySelectorAll('#sections .swatch')].map((e) =>"
                         " [e.nextSibling.textContent.replace(/ [0-9]+$/, ''),"
                         " getComputedStyle(e).backgroundColor.match(/[0-9]+/g).map(Number)])")
        self.assertGreater(len(shown), 3)
        for label, colour in shown:
            hue = 360 * colorsys.rgb_to_hsv(*[channel / 255 for channel in colour])[0]
            away = (hue - hue_of_class(label) + 180) % 360 - 180
            self.assertLess(abs(away), 2, label)
        self.assertEqual(page.errors(), [])

    def test_stages_are_ordered_by_time_and_images_have_outlines(self):
        page = self.open(self.run_folder / "report.html")
        times = page.run("return [...document.querySelectorAll('#sections section')].find((s) =>"
                         " s.innerText.toUpperCase().startsWith('TIME')).querySelectorAll('b')"
                         ".length && [...[...document.querySelectorAll('#sections section')]"
                         ".find((s) => s.innerText.toUpperCase().startsWith('TIME'))"
                         ".querySelectorAll('b')].map((b) => parseFloat(b.innerText))")
        self.assertEqual(times, sorted(times, reverse=True))
        without = page.run("return [...document.querySelectorAll('.strip figure')].filter((f) =>"
                           " !f.querySelector('.outline')).length")
        self.assertEqual(without, 0)

    def test_a_map_shows_its_landmarks_in_tiles_of_usual_size(self):
        program("hullslam view", self.folder / "desk.map", "--report", "--quiet")
        page = self.open(self.folder / "desk.html")
        page.size(1400, 900)
        self.assertIn("landmarks", page.text("#tiles"))
        widest = page.run("return Math.max(...[...document.querySelectorAll('.tile')].map((e) =>"
                          " e.offsetWidth))")
        self.assertLessEqual(widest, 240)

    def test_a_near_path_is_a_few_pixels_thick(self):
        page = self.open(self.run_folder / "report.html")
        # Only the path, seen from so near that its tube would fill a tenth of the view.
        page.run("const v = window.hullslam.view;"
                 "Object.keys(v.shown).forEach((name) => v.show(name, name === 'trajectory'));"
                 "v.replace('now', null);"
                 "const t = window.hullslam.store.get('trajectory');"
                 "const at = t.pose.subarray(7 * 20, 7 * 20 + 3);"
                 "v.controls.target.set(...at);"
                 "v.camera.position.set(...at).add(new THREE.Vector3(0, 0, -15 * v.look.thickness));"
                 "v.camera.near = v.look.thickness; v.camera.updateProjectionMatrix();"
                 "v.controls.update(); v.draw()")
        page.draw()
        picture = page.canvas()
        path = np.abs(picture - np.median(picture, axis=(0, 1))).max(axis=2) > 0.2
        self.assertGreater(path.sum(), 50)
        self.assertLess(path.mean(), 0.02)

    def test_a_click_on_the_curve_shows_the_image_of_that_moment(self):
        page = self.open(self.run_folder / "report.html")
        box = page.run("const b = document.querySelector('#curve svg').getBoundingClientRect();"
                       "return [b.left, b.top, b.width, b.height]")
        page.click(box[0] + 0.8 * box[2], box[1] + 0.5 * box[3])
        late = page.run("return window.hullslam.time")
        page.click(box[0] + 0.1 * box[2], box[1] + 0.5 * box[3])
        self.assertGreater(late, page.run("return window.hullslam.time"))
        self.assertIn("Image of", page.text("#moment"))

    def test_reports_of_other_runs_draw(self):
        mono, objects = self.folder / "mono", self.folder / "objects"
        program("mono_tum", self.desk, "--output", mono, "--report", "--quiet")
        program("hullslam map-objects", self.desk, "--poses", self.desk / "groundtruth.txt", "--masks",
                self.desk / "masks", "--output", objects, "--report", "--quiet")
        program("hullslam view", self.folder / "desk.map", "--report", "--quiet")
        for report in (mono / "report.html", objects / "report.html", self.folder / "desk.html"):
            with self.subTest(report=report.name):
                self.expect_good(self.open(report))

    def test_reports_of_a_room_and_of_a_recorded_sequence_draw(self):
        room, run = self.folder / "room", self.folder / "room_run"
        program("make_synthetic", room, "--scene", "room", "--frames", 12, "--quiet")
        program("hullslam map-objects", room, "--poses", room / "groundtruth.txt", "--masks", room / "masks",
                "--output", run, "--report", "--quiet")
        self.expect_good(self.open(run / "report.html"))
        recorded = find_data("fr1_xyz")
        if recorded is None:
            self.skipTest("fr1_xyz is not on this machine")
        run = self.folder / "fr1_xyz"
        program("rgbd_tum", recorded, "--settings", CONFIG / "TUM1.yaml", "--masks",
                recorded / "masks-yolo8n-seg", "--last", 60, "--output", run, "--report", "--quiet")
        page = self.open(run / "report.html")
        self.expect_good(page)
        self.assertGreater(page.run("return document.querySelectorAll('#moment img').length"), 0)

    def test_a_label_is_only_text_and_messages_can_be_added(self):
        page = self.open(self.run_folder / "report.html")
        page.run("""
          const old = window.hullslam.store.get('objects')[0];
          window.hullslam.apply({ view: 1, add: { objects: [{ ...old, id: 99999, state: 'mapped',
            class: arguments[0], votes: { [arguments[0]]: 1 } }] } });
          window.hullslam.choose(99999);""", NASTY)
        page.draw()
        self.assertIn("<img src=x onerror=alert(1)>", page.text("#card h2"))
        self.assertEqual(page.run("return document.querySelectorAll('[onerror]').length"), 0)
        count = page.run("""
          const before = window.hullslam.store.get('trajectory').time.length;
          window.hullslam.apply({ view: 1, add: { trajectory: { time: { f32: 'AAAAQg==' },
            pose: { f32: 'AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAACAPw==' } } } });
          return window.hullslam.store.get('trajectory').time.length - before;""")
        self.assertEqual(count, 1)
        self.assertEqual(page.errors(), [])

    def test_without_webgl_the_other_parts_are_shown(self):
        page = self.open(self.run_folder / "report.html")
        script = page.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "HTMLCanvasElement.prototype.getContext = () => null"})
        self.addCleanup(page.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument",
                        script)
        page.open(self.run_folder / "report.html")
        self.assertIn("cannot draw in 3D", page.text("#canvas"))
        self.assertIn("objects", page.text("#card"))


if __name__ == "__main__":
    unittest.main()
