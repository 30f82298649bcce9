# SPDX-License-Identifier: GPL-3.0-or-later
"""hullslam.open() finds the data set and its camera, and the library checks its input."""

import cv2
import numpy as np
import pytest

import hullslam
from conftest import CAMERA, HEIGHT, WIDTH

BASELINE = 0.12  # m


def stereo_settings():
    return hullslam.Settings(Camera={**CAMERA, "bf": BASELINE * CAMERA["fx"]},
                             ORBextractor={"nFeatures": 400})


def test_a_sequence_of_tum_has_depth_and_settings(desk):
    sequence, settings = hullslam.open(desk)
    assert sequence.mode == "rgbd" and "TUM RGB-D" in sequence.notes[0]
    assert isinstance(settings, hullslam.Settings)
    assert settings.Camera.fx == hullslam.Settings(desk / "camera.yaml").Camera.fx
    assert sequence[0].depth is not None and sequence[0].right is None
    mono, changed = hullslam.open(desk, mode="mono", ORBextractor={"nFeatures": 777})
    assert mono.mode == "mono" and mono[0].depth is None
    assert changed.ORBextractor.nFeatures == 777


def test_pairs_are_opened_with_their_masks(wall, tmp_path):
    for i in range(3):
        for side, image in (("left", wall.image(i)), ("right", wall.right(i, BASELINE))):
            (tmp_path / side).mkdir(exist_ok=True)
            cv2.imwrite(str(tmp_path / side / f"{i:06d}.png"), image)
        (tmp_path / "masks").mkdir(exist_ok=True)
        (tmp_path / "masks" / f"{i:06d}.txt").write_text("62 0.4 0.4 0.6 0.4 0.6 0.6\n")
    stereo_settings().write(tmp_path / "camera.yaml")
    sequence, settings = hullslam.open(tmp_path)
    assert sequence.mode == "stereo"
    slam = hullslam.System(settings, sequence.mode)
    for frame, masks in zip(sequence, hullslam.open_masks(tmp_path / "masks", sequence)):
        assert len(masks) == 1
        result = slam.track(frame.image, right=frame.right, masks=masks, timestamp=frame.timestamp)
        assert result.state == "tracked"


def test_choices_and_faults(wall, tmp_path):
    cv2.imwrite(str(tmp_path / "a.png"), wall.image(0))
    cv2.imwrite(str(tmp_path / "b.png"), wall.image(1))
    sequence, settings = hullslam.open(tmp_path, choices={"fov": 60, "frames_per_second": 4})
    assert sequence.mode == "mono" and settings.image_size == (WIDTH, HEIGHT)
    assert np.allclose(sequence.timestamps, [0.0, 0.25])
    with pytest.raises(hullslam.InputError, match="neither --settings nor --fov"):
        hullslam.open(tmp_path)
    with pytest.raises(hullslam.InputError, match="mode is 'depth'"):
        hullslam.open(tmp_path, mode="depth")


def test_pairs_that_are_none_are_refused(wall):
    slam = hullslam.System(stereo_settings(), "stereo")
    left, right = wall.image(0), wall.right(0, BASELINE)
    with pytest.raises(hullslam.InputError, match="the same image"):
        slam.track(left, right=left.copy(), timestamp=0.0)
    slam.reset()
    with pytest.raises(hullslam.InputError, match="swapped"):
        slam.track(right, right=left, timestamp=0.0)
    slam.reset()
    assert slam.track(left, right=right, timestamp=0.0).state == "tracked"


def test_depth_and_outlines_in_another_unit_are_refused(slam, wall):
    with pytest.raises(hullslam.InputError, match="expected metres"):
        slam.track(wall.image(0), wall.depth * 5000.0, timestamp=0.0)
    shares = np.array([[0.2, 0.2], [0.6, 0.2], [0.4, 0.7]])
    masks = hullslam.Masks.from_outlines([shares], ["cup"], [0.9])
    with pytest.raises(hullslam.InputError, match="expected pixels"):
        slam.track(wall.image(0), wall.depth, masks, timestamp=0.0)
    with pytest.warns(UserWarning, match="DepthMapFactor"):
        slam.track(wall.image(0), np.full((HEIGHT, WIDTH), 60000, np.uint16), timestamp=0.0)


def test_poses_of_another_unit_than_the_depth_are_noticed(settings, wall):
    def warnings_of(scale):
        mapper = hullslam.KnownPoseMapper(settings)
        for i in range(0, 2 * wall.PERIOD, 2):
            pose = np.eye(4)
            pose[:3, 3] = scale * wall.center(i)
            mapper.add_view(pose, wall.masks(i), wall.depth, timestamp=i / 30.0)
        return mapper.warnings
    assert warnings_of(1.0) == []
    assert len(warnings_of(0.2)) == 1 and "monocular" in warnings_of(0.2)[0]
