#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the live view in a browser: the page during a run, in two browsers at once, after one was
killed, and at the end. Skipped without Chromium or Selenium."""

import pathlib
import tempfile
import unittest

import browser
from live_run import LiveRun, program

FRAMES = 80


@unittest.skipIf(browser.missing(), browser.missing())
class LivePageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.desk = cls.folder / "desk"
        program("make_synthetic", cls.desk, "--scene", "desk", "--frames", FRAMES, "--quiet")

    def start(self):
        run = LiveRun("rgbd_tum", "--view", "0", self.desk, "--masks", self.desk / "masks",
                      "--output", self.folder / "run", "--realtime", "--threaded")
        self.addCleanup(run.kill)
        # The run waits for the browsers.
        self.assertEqual(run.control("pause")[0], 200)
        return run

    def open(self, url):
        page = browser.Browser(1200, 900)
        self.addCleanup(page.close)
        page.open_url(url)
        return page

    def expect_map(self, page, frame):
        """Waits until the page has drawn a map and a picture of at least this frame."""
        page.wait("return (window.hullslam.store.get('live') || {}).frame >= "
                  f"{frame} && window.hullslam.store.get('landmarks') !== null "
                  "&& window.hullslam.view.bounds !== undefined")
        page.wait("return document.querySelectorAll('#moment img').length === 1")
        self.assertGreater(browser.count_colours(page.canvas()), 20)

    def click(self, page, title):
        page.run("[...document.querySelectorAll('#live button')]"
                 ".find((e) => e.textContent === arguments[0]).click()", title)

    def step_to(self, page, frame):
        """Steps through the run by the button of the page."""
        while (page.run("return (window.hullslam.store.get('live') || {}).frame") or 0) < frame:
            before = page.run("return (window.hullslam.store.get('live') || {}).frame") or 0
            self.click(page, "Step")
            page.wait("return ((window.hullslam.store.get('live') || {}).frame || 0) > "
                      f"{before}")

    def test_two_browsers_watch_a_run_and_one_comes_back_after_it_was_killed(self):
        run = self.start()
        first, second = self.open(run.url), self.open(run.url)
        self.step_to(first, 15)
        self.expect_map(first, 15)
        self.expect_map(second, 15)
        self.assertEqual(first.errors() + second.errors(), [])
        second.kill()
        self.step_to(first, 18)
        again = self.open(run.url)
        self.step_to(first, 20)
        self.expect_map(again, 19)
        self.click(again, "Resume")
        for page in (first, again):
            page.wait("return window.hullslam.store.get('run', {}).live === false")
            self.assertIn("ended", page.text("#live"))
            self.assertGreater(browser.count_colours(page.canvas()), 20)
        self.assertEqual(run.wait()[0], 0)
        self.assertIn("ATE", first.text("#tiles"))
        self.assertEqual(first.errors() + again.errors(), [])

    def test_without_the_token_the_page_only_watches(self):
        run = self.start()
        page = self.open(run.url.split("?")[0])
        page.wait("return (window.hullslam.store.get('live') || {}).phase === 'paused'")
        self.assertTrue(page.run("return document.querySelector('#live .controls').hidden"))

    def test_on_a_phone_the_page_is_not_wider_than_the_screen(self):
        run = self.start()
        page = self.open(run.url)
        self.step_to(page, 12)
        page.size(400, 800)
        self.expect_map(page, 12)
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth"), 400)


if __name__ == "__main__":
    unittest.main()
