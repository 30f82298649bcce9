# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks that a network makes."""

import numpy as np
import pytest

import hullslam

red_network = pytest.importorskip("red_network")


@pytest.fixture(name="network")
def make_network(tmp_path):
    red_network.write_red_network(tmp_path / "red.onnx")
    return tmp_path / "red.onnx"


def test_the_masks_of_an_image_are_found(network):
    segmenter = hullslam.Segmenter(network)
    assert segmenter.class_names == ["red"]
    image = np.full((96, 128, 3), 128, np.uint8)
    image[36:60, 36:60] = (0, 0, 255)
    masks = segmenter.segment(image)
    assert masks.classes == ["red"] and masks.scores[0] > 0.9
    ((outline,),) = masks.outlines
    assert outline.min(axis=0) == pytest.approx([35.5, 35.5])
    assert outline.max(axis=0) == pytest.approx([59.5, 59.5])
    assert len(segmenter.segment(image[:, :, 0])) == 0  # grey


@pytest.mark.parametrize("wait", [True, False])
def test_keyframes_of_a_system_get_masks(network, slam, wall, wait):
    hullslam.Segmenter(network).attach(slam, wait=wait)
    image = np.repeat(wall.images[0][:, :, np.newaxis], 3, axis=2)
    image[80:160, 120:200] = (0, 0, 255)
    slam.track(image, wall.depth, timestamp=0.0)
    slam.finish()
    assert slam.object_counts["frames_with_masks"] == 1
    assert slam.object_counts["detections"] == 1


def test_bad_networks_are_refused(network, tmp_path):
    with pytest.raises(hullslam.InputError, match="is a text"):
        hullslam.Segmenter(__file__)
    with pytest.raises(hullslam.InputError, match="min_score"):
        hullslam.Segmenter(network, min_score=2.0)
    with pytest.raises(hullslam.InputError, match="did you mean 'red'"):
        hullslam.Segmenter(network, classes=["rad"])
    with pytest.raises(hullslam.InputError, match="none.onnx"):
        hullslam.Segmenter(tmp_path / "none.onnx")
