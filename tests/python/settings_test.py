# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings as objects, which come from the library's registry of settings."""

import math

import numpy as np
import pytest

import hullslam
from conftest import CAMERA, ROOT
from hullslam import _core

TUM1 = ROOT / "config" / "TUM1.yaml"


def test_a_file_and_keyword_arguments():
    settings = hullslam.Settings(TUM1, objects={"start": {"min_views": 4}, "detection.min_score": 0.5},
                                 DepthMapFactor=1000, ORBextractor={"nFeatures": 1500})
    assert settings.Camera.fx == 517.306408
    assert settings.objects.start.min_views == 4 and settings["objects.detection.min_score"] == 0.5
    assert settings.DepthMapFactor == 1000.0 and settings.ORBextractor.nFeatures == 1500
    assert settings.image_size == (640, 480)


def test_settings_are_set_one_by_one_and_by_group():
    settings = hullslam.Settings(Camera=CAMERA)
    settings.objects.detection.min_score = np.float32(0.25)
    settings["tracking.min_inliers"] = 31
    settings.objects.enabled = False
    settings.ORBextractor = {"nFeatures": np.int64(900), "nLevels": 5}
    settings.objects.sizes = {"cup": 0.1, "tv": 0.6}
    assert settings.objects.detection.min_score == 0.25
    assert settings.tracking.min_inliers == 31
    assert settings.objects.enabled is False
    assert (settings.ORBextractor.nFeatures, settings.ORBextractor.nLevels) == (900, 5)
    assert settings.objects.sizes == {"cup": 0.1, "tv": 0.6}


def test_every_setting_can_be_read_and_written_back():
    settings = hullslam.Settings(Camera=CAMERA)
    before = settings.format()
    for key, *_ in settings.entries():
        value = settings[key]
        assert isinstance(value, (bool, int, float, str, dict)), key
        settings[key] = value
        assert settings.describe(key).startswith(key)
    assert settings.format() == before


def test_no_setting_has_the_name_of_a_method():
    names = {key.split(".")[0] for key, *_ in _core.SettingsTable.defaults()}
    assert not names & set(dir(hullslam.Settings))
    keys = {key for key, *_ in _core.SettingsTable.defaults()}
    assert not [key for key in keys if any(other.startswith(key + ".") for other in keys)]


def test_summary_repr_and_hash():
    settings = hullslam.Settings(TUM1)
    first = settings.hash
    settings.tracking.min_inliers = 31
    assert settings.hash != first
    assert "tracking.min_inliers: 31  (default 30)" in settings.summary()
    changed = settings.summary(changed_only=True).splitlines()
    assert "tracking.min_inliers: 31  (default 30)" in changed
    assert len(changed) < len(settings.summary().splitlines())
    assert repr(settings) == (f"<hullslam.Settings: 640x480 px, {len(changed)} settings are not the "
                              "default>")
    assert "tracking.min_inliers: 31  (default 30)" in repr(settings.tracking)
    assert "min_inliers" in dir(settings.tracking) and "tracking" in dir(settings)


def test_a_written_file_gives_the_same_settings(tmp_path):
    settings = hullslam.Settings(TUM1, objects={"start": {"min_views": 4}})
    settings.write(tmp_path / "camera.yaml")
    assert hullslam.Settings(tmp_path / "camera.yaml").hash == settings.hash


def test_presets():
    assert "orb_slam2" in hullslam.preset_names()
    plain, preset = hullslam.Settings(TUM1), hullslam.Settings(TUM1, preset="orb_slam2")
    assert plain.hash != preset.hash
    with pytest.raises(hullslam.InputError, match="orb_slam2"):
        hullslam.Settings(TUM1, preset="orb_slam9")


def test_default_settings_of_a_sequence(tmp_path):
    assert hullslam.default_settings(tmp_path / "rgbd_dataset_freiburg1_xyz").name == "TUM1.yaml"


def test_what_the_reader_has_to_say_is_a_warning():
    with pytest.warns(UserWarning, match="nLevels is 8"):
        hullslam.Settings(Camera={**CAMERA, "width": 200, "height": 150, "cx": 100, "cy": 75},
                          ORBextractor={"nLevels": 8})


@pytest.mark.parametrize("keywords, expected", [
    ({"objects": {"start": {"min_view": 4}}}, "Settings: unknown key 'objects.start.min_view'; did you mean"),
    ({"objects": {"start": {"min_views": -4}}}, "Settings: objects.start.min_views is '-4', expected an integer"),
    ({"objects": {"start": {"min_views": 4.5}}}, "Settings: objects.start.min_views is '4.5', expected an integer"),
    ({"objects": {"enabled": "maybe"}}, "Settings: objects.enabled is 'maybe', expected true or"),
    ({"DepthMapFactor": math.nan}, "Settings: DepthMapFactor is 'nan', expected a number from 0.001"),
    ({"DepthMapFactor": [1]}, "Settings: DepthMapFactor is a list, expected a number"),
    ({"DepthMapFactor": None}, "Settings: DepthMapFactor is a NoneType, expected a number"),
    ({"objects": 3}, "Settings: unknown key 'objects'"),
])
def test_bad_values(keywords, expected):
    with pytest.raises(hullslam.InputError) as error:
        hullslam.Settings(TUM1, **keywords)
    assert expected in str(error.value), str(error.value)


def test_bad_values_that_are_set_later_change_nothing():
    settings = hullslam.Settings(TUM1)
    before = settings.hash
    with pytest.raises(hullslam.InputError, match="expected an integer"):
        settings.objects.start.min_views = "many"
    with pytest.raises(hullslam.InputError, match="did you mean"):
        settings.objects.start.min_view = 3
    with pytest.raises(AttributeError, match="objects.start.min_view"):
        _ = settings.objects.start.min_view
    for read in (settings.__getitem__, settings.describe):
        with pytest.raises(KeyError, match="unknown key 'objects.start.min_view'; did you mean "
                           "'objects.start.min_views'"):
            read("objects.start.min_view")
    assert settings.hash == before


def test_a_camera_is_needed(tmp_path):
    with pytest.raises(hullslam.InputError, match="Settings: Camera.fx is '0'"):
        hullslam.Settings(Camera={"fy": 500, "cx": 320, "cy": 240})
    (tmp_path / "bad.yaml").write_text("%YAML:1.0\nCamera.fx: a\n")
    with pytest.raises(hullslam.InputError, match="bad.yaml:2"):
        hullslam.Settings(tmp_path / "bad.yaml")
    with pytest.raises(hullslam.InputError, match="none.yaml"):
        hullslam.Settings(tmp_path / "none.yaml")


def test_settings_that_do_not_fit_together_are_refused_when_they_are_used():
    settings = hullslam.Settings(TUM1)
    settings.Camera.width = 60
    with pytest.raises(hullslam.InputError):
        hullslam.System(settings)
