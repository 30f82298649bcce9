# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished runs: their files, reports, scenes and exports; and the readers of ICL-NUIM and EuRoC."""

import json
import shutil

import numpy as np
import pytest

import hullslam
from conftest import run_program


@pytest.fixture(scope="module")
def run_folder(desk, tmp_path_factory):
    """The output folder of a run on the rendered sequence."""
    folder = tmp_path_factory.mktemp("run") / "out"
    run_program("rgbd_tum", desk, "--masks", desk / "masks", "--output", folder, "--save-map",
                folder.parent / "desk.map", "--quiet")
    return folder


def assert_close(scene, expected, where="scene"):
    """Equal up to the rounding of numbers in the files from which a scene is made again."""
    if isinstance(expected, (dict, list)):
        assert type(scene) is type(expected) and len(scene) == len(expected), where
        for key in expected if isinstance(expected, dict) else range(len(expected)):
            assert_close(scene[key], expected[key], f"{where}/{key}")
    else:
        assert scene == (pytest.approx(expected, rel=1e-5, abs=1e-8)
                         if isinstance(expected, float) else expected), where


def test_a_run_has_what_its_files_say(run_folder):
    run = hullslam.open_run(run_folder)
    summary = json.loads((run_folder / "summary.json").read_text())
    assert run.folder == run_folder and run.summary == summary
    poses = hullslam.read_trajectory(run_folder / "trajectory.txt")
    assert np.array_equal(run.trajectory.timestamps, poses.timestamps)
    assert len(run.keyframes.timestamps) == summary["map"]["keyframes"]
    positions, colours = run.points
    assert positions.shape == colours.shape
    assert 0 < len(positions) <= summary["map"]["landmarks"]
    assert np.isfinite(positions).all() and colours.dtype == np.uint8
    assert run.objects == json.loads((run_folder / "objects.json").read_text())


def test_a_folder_without_a_run_is_refused(tmp_path):
    for function in (hullslam.open_run, hullslam.scene, hullslam.report):
        with pytest.raises(hullslam.InputError, match=str(tmp_path)):
            function(tmp_path)
    with pytest.raises(hullslam.InputError, match="does not exist"):
        hullslam.report(tmp_path / "none")


def test_the_scene_of_a_run_is_its_file_and_a_map_has_one_too(run_folder):
    scene = hullslam.scene(run_folder)
    assert_close(scene, json.loads((run_folder / "scene.json").read_text()))
    of_map = hullslam.scene(run_folder.parent / "desk.map")
    assert [thing["class"] for thing in of_map["objects"]] == \
        [thing["class"] for thing in scene["objects"]]


def test_reports_are_written(run_folder, tmp_path):
    path = hullslam.report(run_folder)
    assert path == run_folder / "report.html"
    other = hullslam.report(run_folder.parent / "desk.map", tmp_path / "map.html")
    for file in (path, other):
        assert file.read_text().lstrip().lower().startswith("<!doctype html>")


def test_exports_are_those_of_the_program(run_folder, tmp_path):
    told = hullslam.export(run_folder, "kitti", tmp_path / "poses.txt")
    assert isinstance(told, str)
    run_program("hullslam export", run_folder, "--to", "kitti", "--output", tmp_path / "same.txt")
    assert (tmp_path / "poses.txt").read_bytes() == (tmp_path / "same.txt").read_bytes()
    with pytest.raises(hullslam.InputError, match="poses.txt"):
        hullslam.export(run_folder, "kitti", tmp_path / "poses.txt")
    hullslam.export(run_folder, "kitti", tmp_path / "poses.txt", force=True)
    with pytest.raises(hullslam.InputError, match="'zebra', expected one of: .*colmap"):
        hullslam.export(run_folder, "zebra", tmp_path / "new")
    with pytest.raises(hullslam.InputError, match="objects_as is 'balls'"):
        hullslam.export(run_folder, "gltf", tmp_path / "new.glb", objects_as="balls")


def test_icl_is_read(desk, tmp_path):
    for name in ("rgb", "depth"):
        (tmp_path / name).mkdir()
    lines = []
    for i, (image, depth) in enumerate(zip(*(sorted((desk / name).iterdir())
                                             for name in ("rgb", "depth")))):
        shutil.copy(image, tmp_path / f"rgb/{i}.png")
        shutil.copy(depth, tmp_path / f"depth/{i}.png")
        lines.append(f"{i} depth/{i}.png {i} rgb/{i}.png\n")
    (tmp_path / "associations.txt").write_text("".join(lines))
    settings = hullslam.Settings(desk / "camera.yaml")
    sequence = hullslam.open_icl(tmp_path, settings)
    tum = hullslam.open_tum(desk, settings)
    assert len(sequence) == len(tum)
    assert np.allclose(sequence.timestamps, np.arange(len(tum)) / 30.0)
    assert np.array_equal(sequence[3].image, tum[3].image)
    assert np.array_equal(sequence[3].depth, tum[3].depth)
    assert hullslam.open_icl(tmp_path, settings, depth=False)[3].depth is None


def test_euroc_is_read(desk, tmp_path):
    camera = tmp_path / "mav0" / "cam0"
    (camera / "data").mkdir(parents=True)
    rows = ["#timestamp [ns],filename\n"]
    for i, image in enumerate(sorted((desk / "rgb").iterdir())):
        shutil.copy(image, camera / "data" / f"{i}.png")
        rows.append(f"{10**9 + i * 50_000_000},{i}.png\n")
    (camera / "data.csv").write_text("".join(rows))
    (camera / "sensor.yaml").write_text(
        "camera_model: pinhole\nintrinsics: [500, 500, 320, 240]\nresolution: [640, 480]\n"
        "rate_hz: 20\ndistortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n"
        "T_BS: {data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n")
    sequence = hullslam.open_euroc(tmp_path, hullslam.Settings(camera / "sensor.yaml"))
    assert np.allclose(sequence.timestamps, 1.0 + 0.05 * np.arange(len(rows) - 1))
    assert sequence[0].depth is None and sequence[0].image.shape == (480, 640)
