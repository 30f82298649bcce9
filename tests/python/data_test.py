# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks, trajectories, sequences and the mapper of objects with known poses."""

import numpy as np
import pytest

import hullslam
from conftest import HEIGHT, WIDTH, run_program


def square(value=True, kind=bool):
    stack = np.zeros((1, HEIGHT, WIDTH), kind)
    stack[0, 10:20, 30:50] = value
    return stack


def test_a_stack_gives_outlines_halfway_between_pixels():
    masks = hullslam.Masks(square(), ["cup"], [0.75])
    assert len(masks) == 1 and masks.classes == ["cup"] and masks.scores == [0.75]
    ((outline,),) = masks.outlines
    # Corners are cut, so the outline is within half a pixel of the centres of the last pixels.
    assert outline.min(axis=0) == pytest.approx([29.5, 9.5])
    assert outline.max(axis=0) == pytest.approx([49.5, 19.5])


def test_all_forms_of_a_stack_give_the_same_masks():
    expected = hullslam.Masks(square(), ["cup"]).outlines[0][0]
    fortran = np.asfortranarray(square())
    strided = np.zeros((1, 2 * HEIGHT, 2 * WIDTH), bool)[:, ::2, ::2]
    strided[:] = square()
    for stack in (square(255, np.uint8), fortran, strided, square()[:, ::-1][:, ::-1]):
        assert np.array_equal(hullslam.Masks(stack, ["cup"]).outlines[0][0], expected)
    labels = np.where(square()[0], 7, 0).astype(np.int32)
    from_labels = hullslam.Masks.from_labels(labels, {7: "cup"}, {7: 0.5})
    assert np.array_equal(from_labels.outlines[0][0], expected) and from_labels.scores == [0.5]
    from_outlines = hullslam.Masks.from_outlines([expected], ["cup"])
    assert np.array_equal(from_outlines.outlines[0][0], expected) and from_outlines.scores == [1.0]


def test_masks_without_an_area_are_left_out():
    stack = np.concatenate([np.zeros_like(square()), square()])
    assert hullslam.Masks(stack, ["nothing", "cup"]).classes == ["cup"]
    assert len(hullslam.Masks(stack[:0], [])) == 0


def test_a_trajectory_keeps_its_numbers(tmp_path):
    angle = 0.3
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    pose[:3, 3] = [1.0, 2.0, 3.0]
    trajectory = hullslam.Trajectory(np.array([1.5, 2]), [np.eye(4), pose])
    assert np.array_equal(trajectory.timestamps, [1.5, 2.0])
    assert np.allclose(trajectory.world_from_cam, [np.eye(4), pose], atol=1e-15)
    assert np.array_equal(trajectory.positions, [[0, 0, 0], [1, 2, 3]])
    assert np.allclose(trajectory.interpolate(1.75, 1.0)[:3, 3], [0.5, 1.0, 1.5])
    assert trajectory.interpolate(1.75, 0.1) is None and trajectory.interpolate(2.1, 1.0) is None
    assert trajectory.format().splitlines()[2] == (
        "2.000000 1.000000000 2.000000000 3.000000000 0.000000000 0.000000000 0.149438132 "
        "0.988771078")
    trajectory.write(tmp_path / "a.txt")
    assert (tmp_path / "a.txt").read_text() == trajectory.format()
    assert hullslam.read_trajectory(tmp_path / "a.txt").format() == trajectory.format()
    assert repr(trajectory) == "<hullslam.Trajectory of 2 poses>"
    with pytest.raises(hullslam.InputError, match="none/a.txt"):
        trajectory.write(tmp_path / "none" / "a.txt")


def test_errors_of_a_trajectory_of_another_scale():
    stamps = np.arange(50) / 10.0
    truth = np.tile(np.eye(4), (50, 1, 1))
    truth[:, 0, 3], truth[:, 1, 3] = np.sin(stamps), stamps
    estimate = truth.copy()
    estimate[:, :3, 3] = 0.5 * truth[:, :3, 3] + [3.0, 0.0, 0.0]
    truth, estimate = (hullslam.Trajectory(stamps, poses) for poses in (truth, estimate))
    errors = hullslam.evaluate_trajectory(truth, estimate, align="sim3")
    assert errors.ate_rmse < 1e-12 and errors.scale == pytest.approx(2.0)
    assert errors.pairs == 50 and errors.coverage == 1.0 and errors.rpe_rotation_rmse < 1e-5
    assert errors.groundtruth_from_estimate[:3, 3] == pytest.approx([-6.0, 0.0, 0.0])
    assert hullslam.evaluate_trajectory(truth, estimate).ate_rmse > 0.1
    unaligned = hullslam.evaluate_trajectory(truth, estimate, align="none", pairing="evo")
    assert unaligned.ate_max > 0.5 and unaligned.ate_mean <= unaligned.ate_rmse


def test_errors_are_those_of_the_program(desk, tmp_path):
    run_program("rgbd_tum", desk, "--output", tmp_path / "out", "--quiet")
    printed = run_program("hullslam evaluate", "trajectory", desk / "groundtruth.txt",
                          tmp_path / "out" / "trajectory.txt", "--json")
    errors = hullslam.evaluate_trajectory(desk / "groundtruth.txt",
                                          tmp_path / "out" / "trajectory.txt")
    import json
    assert errors.ate_rmse == json.loads(printed)["ate_m"]["rmse"]


def test_a_sequence_is_read_frame_by_frame(desk, tmp_path):
    settings = hullslam.Settings(desk / "camera.yaml")
    sequence = hullslam.open_tum(desk, settings)
    assert len(sequence) == 25 and len(list(sequence)) == 25
    frame = sequence[-1]
    assert frame.timestamp == sequence.timestamps[24] and frame.timestamp > sequence[0].timestamp
    width, height = settings.image_size
    assert frame.image.shape == frame.depth.shape == (height, width)
    assert frame.image.dtype == np.uint8 and frame.depth.dtype == np.uint16
    assert sequence.colour(-1).shape == (height, width, 3)
    assert len(sequence.groundtruth) >= 25
    with pytest.raises(IndexError):
        _ = sequence[25]
    assert hullslam.open_tum(desk, settings, depth=False)[0].depth is None
    masks = hullslam.open_masks(desk / "masks", sequence)
    assert len(masks) == 25 and masks.format == "yolo-seg" and len(masks[0]) > 0
    assert masks[-1].classes == list(masks)[24].classes
    images = hullslam.open_images(desk / "rgb", settings, fps=10)
    assert np.array_equal(images[1].image, sequence[1].image) and images[1].timestamp == 0.1
    stored = hullslam.open_stored_images(desk)
    assert stored.names[0] == stored.files[0].stem == sequence[0].name and len(stored) == 25
    colour = stored.colour(-1)
    assert colour.shape == (height, width, 3) and colour.dtype == np.uint8
    assert abs(colour.astype(float) @ [0.114, 0.587, 0.299] - frame.image).max() < 1.1  # libpng cuts off
    settings.Camera.width = 100
    with pytest.raises(hullslam.InputError, match="expected Camera.width"):
        _ = hullslam.open_tum(desk, settings)[0]


def test_objects_are_mapped_from_known_poses(desk):
    settings = hullslam.Settings(desk / "camera.yaml", objects={"start": {"min_views": 3}})
    sequence = hullslam.open_tum(desk, settings)
    masks = hullslam.open_masks(desk / "masks", sequence)
    truth = sequence.groundtruth
    mapper = hullslam.KnownPoseMapper(settings)
    empty = mapper.map
    for frame, found in zip(sequence, masks):
        nearest = np.abs(truth.timestamps - frame.timestamp).argmin()
        mapper.add_view(truth.world_from_cam[nearest], found, frame.depth,
                        timestamp=frame.timestamp)
    assert len(mapper.map.keyframes) == 25 and len(empty.keyframes) == 0
    assert len(mapper.map.objects) + len(mapper.map.candidates) >= 2
    for thing in mapper.map.candidates:
        assert np.isnan(thing.half_axes).all() or (thing.half_axes > 0.0).all()
