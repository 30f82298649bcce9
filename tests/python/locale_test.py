# SPDX-License-Identifier: GPL-3.0-or-later
"""A program with a decimal comma reads and writes the same as one without."""

import os
import subprocess
import sys

import pytest

from conftest import run_program

LOCALE = """comment_char %
escape_char /
LC_NUMERIC
decimal_point ","
thousands_sep "."
grouping 3;3
END LC_NUMERIC
"""

# Does with a run what users do, and prints what it found.
PROGRAM = """
import locale, pathlib, sys
import hullslam
desk, run, out = map(pathlib.Path, sys.argv[1:4])
if len(sys.argv) > 4:
    locale.setlocale(locale.LC_NUMERIC, sys.argv[4])
    assert locale.str(1.5) == "1,5"
settings = hullslam.Settings(desk / "camera.yaml")
print(settings["Camera.fx"], settings["Camera.fps"])
print(hullslam.evaluate_trajectory(desk / "groundtruth.txt", run / "trajectory.txt"))
print(hullslam.scene(run))
for form in ("colmap", "nerfstudio", "gltf", "kitti"):
    hullslam.export(run, form, out / form, text=form == "colmap")
hullslam.report(run, out / "report.html")
slam = hullslam.System(settings)
sequence = hullslam.open_tum(desk, settings)
masks = hullslam.open_masks(desk / "masks", sequence)
for i in range(3):
    frame = sequence[i]
    print(slam.track(frame.image, frame.depth, masks[i], timestamp=frame.timestamp))
"""


@pytest.fixture(name="comma")
def fixture_comma(tmp_path):
    """The environment of a program that may set the locale "comma"."""
    (tmp_path / "source").write_text(LOCALE)
    subprocess.run(["localedef", "-c", "-f", "UTF-8", "-i", tmp_path / "source", tmp_path / "comma"],
                   check=False, capture_output=True)
    assert (tmp_path / "comma" / "LC_NUMERIC").exists(), "the package locales is missing"
    return {**os.environ, "LOCPATH": str(tmp_path)}


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def test_a_decimal_comma_changes_nothing(desk, comma, tmp_path):
    run = tmp_path / "run"
    run_program("rgbd_tum", desk, "--masks", desk / "masks", "--output", run, "--quiet", "--save-map",
                tmp_path / "desk.map")

    def use(name, *arguments):
        (tmp_path / name).mkdir()
        result = subprocess.run([sys.executable, "-c", PROGRAM, desk, run, tmp_path / name, *arguments],
                                env=comma, capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stderr
        return result.stdout, files_of(tmp_path / name)

    assert use("with_comma", "comma") == use("with_point")
