# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of the library in Python print what those in C++ print."""

import subprocess
import sys

import pytest

from conftest import ROOT, run_program

LIBRARY = ROOT / "Examples" / "library"
EXAMPLES = sorted(LIBRARY.glob("*.py"))


def run_example(name, *arguments):
    command = [sys.executable, LIBRARY / f"{name}.py", *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    return result.stdout


def assert_same(name, *arguments):
    printed = run_example(name, *arguments)
    assert printed and printed == run_program(name, *arguments)


def test_all_examples_are_short_and_have_a_twin():
    names = [path.stem for path in EXAMPLES]
    assert [name[:3] for name in names] == ["01_", "02_", "03_", "04_", "05_", "06_", "07_"]
    assert names == sorted(path.stem for path in LIBRARY.glob("*.cc"))
    for path in LIBRARY.iterdir():
        assert len(path.read_text(encoding="utf-8").splitlines()) < 80, path


def test_minimal():
    assert_same("01_minimal")


def test_objects_with_depth_and_masks(desk, tmp_path):
    files = [tmp_path / "python.txt", tmp_path / "program.txt"]
    printed = run_example("02_rgbd_with_masks", desk, desk / "masks", files[0])
    assert printed == run_program("02_rgbd_with_masks", desk, desk / "masks", files[1])
    assert "25 of 25 frames have a pose" in printed and "error 0.00" in printed
    assert files[0].read_bytes() == files[1].read_bytes()


def test_stereo(tmp_path):
    run_program("make_synthetic", tmp_path / "pairs", "--frames", 12, "--stereo", 0.1, "--quiet")
    assert_same("03_stereo", tmp_path / "pairs")


def test_late_masks(desk, tmp_path):
    """How many masks come in time depends on the machine."""
    red_network = pytest.importorskip("red_network")
    red_network.write_red_network(tmp_path / "red.onnx")
    printed = run_example("04_late_masks", desk, tmp_path / "red.onnx")
    assert "25 of 25 frames have a pose" in printed and "detections of objects" in printed


def test_known_poses(desk):
    assert_same("05_known_poses", desk, desk / "masks")


def test_localisation(desk, tmp_path):
    assert_same("06_localisation", desk, tmp_path / "desk.map")


def test_robot(desk, tmp_path):
    assert_same("07_robot", desk, desk / "groundtruth.txt", tmp_path / "desk.map")


@pytest.mark.parametrize("example", EXAMPLES[1:], ids=lambda path: path.stem)
def test_bad_usage_is_refused(example):
    result = subprocess.run([sys.executable, example], capture_output=True, text=True, check=False)
    assert result.returncode == 1 and result.stderr.startswith(f"usage: {example.name} ")
