# SPDX-License-Identifier: GPL-3.0-or-later
"""A headless Chromium that draws without a graphics card, for tests of the page."""

import base64
import io
import os
import pathlib
import re
import signal
import time

import numpy as np

try:
    import matplotlib.image
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

DRIVER = pathlib.Path("/usr/bin/chromedriver")
PATIENCE = 120  # s; other tests run at the same time


def missing():
    """What a machine lacks to run the browser; None if nothing is missing."""
    if webdriver is None:
        return "python3-selenium is not installed"
    return None if DRIVER.exists() else "chromium-driver is not installed"


class Browser:
    def __init__(self, width=1400, height=900):
        options = Options()
        for argument in ("--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                         "--enable-unsafe-swiftshader", "--disable-dev-shm-usage",
                         "--hide-scrollbars", f"--window-size={width},{height}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service(str(DRIVER)))
        self.driver.set_script_timeout(PATIENCE)
        self.size(width, height)

    def prefer(self, scheme):
        """The colours that the user prefers: "dark" or "light"."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
            {"name": "prefers-color-scheme", "value": scheme}]})

    def close(self):
        self.driver.quit()

    def kill(self):
        """Ends the browser at once, as a crash would, and then its driver."""
        # The browser is no child of its driver, so it is found by its folder, which only it has.
        mark = f"--user-data-dir={self.driver.capabilities['chrome']['userDataDir']}".encode()
        for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                if mark in path.read_bytes().split(b"\0"):
                    os.kill(int(path.parent.name), signal.SIGKILL)
            except OSError:  # it has ended meanwhile
                pass
        self.driver.service.process.kill()
        self.driver.service.process.wait()

    def size(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})

    def open(self, path):
        self.open_url(pathlib.Path(path).resolve().as_uri())

    def open_url(self, url):
        self.driver.get(url)
        self.wait("return window.hullslam !== undefined && document.readyState === 'complete'")
        self.draw()

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, script):
        """Waits until the script returns a value that counts as true, and returns it."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            value = self.run(script)
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"still not true after {PATIENCE} s: {script}")

    def draw(self):
        """Waits until the view has drawn what was asked for."""
        self.wait("return !window.hullslam.view || !window.hullslam.view.isDue")

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {
                "type": kind, "x": x, "y": y, "button": "left", "clickCount": 1})
        self.draw()

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0]).innerText", selector)

    def canvas(self):
        """The drawn view as an array of rows, columns, and red, green, blue from 0 to 1.

        It is drawn once more, because WebGL keeps the pixels only until a script ends. A screenshot
        would need the whole page to be drawn within 10 s, which a busy machine cannot do.
        """
        self.draw()
        url, background = self.run("""
          const { renderer, scene, camera } = window.hullslam.view;
          renderer.render(scene, camera);
          return [renderer.domElement.toDataURL(),
                  getComputedStyle(document.getElementById('canvas')).backgroundColor];""")
        image = matplotlib.image.imread(io.BytesIO(base64.b64decode(url.split(",")[1])))
        colour = np.array([float(part) for part in re.findall(r"[\d.]+", background)[:3]]) / 255
        alpha = image[:, :, 3:]
        return image[:, :, :3] * alpha + colour * (1 - alpha)

    def errors(self):
        """The messages of the console since the last call, but for those about speed."""
        return [entry["message"] for entry in self.driver.get_log("browser")
                if "GPU stall" not in entry["message"]]


def count_colours(image):
    """How many clearly different colours an image has."""
    return len(np.unique((image.reshape(-1, 3) * 15).astype(int), axis=0))
