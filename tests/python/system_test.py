# SPDX-License-Identifier: GPL-3.0-or-later
"""A run through the Python module: results, maps, threads, and the C++ program's bytes."""

import threading

import numpy as np
import pytest

import hullslam
from conftest import Wall, run_program


@pytest.mark.parametrize("mode, extra", [("rgbd", []), ("mono", [])])
def test_the_trajectory_has_the_bytes_of_the_program(desk, tmp_path, mode, extra):
    masks = desk / "masks"
    run_program(f"{mode}_tum", desk, "--masks", masks, "--output", tmp_path / "out", "--quiet",
                "--set", "run.max_lost_share=1", "--set", "run.max_lost_at_end=100", *extra)
    settings = hullslam.Settings(hullslam.default_settings(desk))
    sequence = hullslam.open_tum(desk, settings, depth=mode == "rgbd")
    slam = hullslam.System(settings, mode)
    for frame, found in zip(sequence, hullslam.open_masks(masks, sequence)):
        slam.track(frame.image, frame.depth, found, timestamp=frame.timestamp)
    slam.finish()
    slam.trajectory.write(tmp_path / "trajectory.txt")
    written = (tmp_path / "trajectory.txt").read_bytes()
    assert written == (tmp_path / "out" / "trajectory.txt").read_bytes()
    if mode == "rgbd":
        assert len(slam.trajectory) == 25
        errors = hullslam.evaluate_trajectory(sequence.groundtruth, slam.trajectory)
        assert errors.ate_rmse < 0.01 and errors.pairs == 25 and errors.alignment == "se3"


def test_a_frame_has_pose_matches_and_objects(slam, wall):
    assert len(slam.map.keyframes) == len(slam.map.landmarks) == len(slam.trajectory) == 0
    first = wall.track(slam, 0, 1, masks=True)[0]
    assert first.state == "tracked" and first.reason is None
    assert np.array_equal(first.cam_from_world, np.eye(4))
    wall.track(slam, 1, 10, masks=True)
    known = slam.map.landmarks["id"]
    (result,) = wall.track(slam, 10, 11, masks=True)
    assert result.state == "tracked" and result.frame == 10 and result.timestamp == 10 / 30.0
    assert result.world_from_cam[:3, 3] == pytest.approx(Wall.center(10), abs=0.005)
    assert np.allclose(result.cam_from_world @ result.world_from_cam, np.eye(4))
    assert result.inliers > 50 and len(result.matches) >= result.inliers
    assert result.matches.dtype.names == ("keypoint", "landmark", "pixel")
    assert set(result.matches["landmark"]) <= set(known)
    (seen,) = result.objects
    assert seen.label == "picture" and seen.score == 0.9
    assert seen.hull.shape[1] == 2 and seen.box.shape == (4,)
    assert "tracked" in repr(result)


def test_a_lost_frame_says_why(slam, wall):
    wall.track(slam, 0, 5)
    blank = slam.track(np.zeros_like(wall.image(0)), wall.depth, timestamp=0.2)
    assert blank.state == "lost" and blank.reason == "too few features"
    assert blank.cam_from_world is None and blank.world_from_cam is None
    assert [event.kind for event in blank.events] == ["lost"]
    again = wall.track(slam, 7, 8)[0]
    assert [event.kind for event in again.events] == ["relocalised"]
    assert again.events[0].object is None and again.events[0].scale == 1.0


def test_a_motion_prior_crosses_black_images(slam, wall):
    first, *_, last = wall.track(slam, 0, 5)
    assert first.odometry_step == "begun" and last.odometry_step == "measured"
    np.testing.assert_allclose(last.map_from_odom @ last.odom_from_cam, last.world_from_cam,
                               atol=1e-9)
    assert last.covariance.shape == (6, 6) and 0.0 < last.quality <= 1.0
    assert np.linalg.norm(last.linear_velocity) > 0.0
    step = last.cam_from_world @ np.linalg.inv(first.cam_from_world)
    with pytest.raises(hullslam.InputError, match="together"):
        slam.track(wall.image(5), wall.depth, timestamp=0.2, motion=step)
    with pytest.raises(hullslam.InputError, match="positive definite"):
        slam.track(wall.image(5), wall.depth, timestamp=0.2, motion=step,
                   motion_covariance=np.zeros((6, 6)))
    black = slam.track(np.zeros_like(wall.image(0)), wall.depth, timestamp=0.2, motion=step,
                       motion_covariance=1e-6 * np.eye(6))
    assert (black.state, black.prior) == ("tracked", "alone")
    np.testing.assert_allclose(black.cam_from_world, step @ last.cam_from_world, atol=1e-9)


def test_a_monocular_camera_says_why_it_has_no_map(settings, wall):
    slam = hullslam.System(settings, "mono")
    result = slam.track(wall.image(0), timestamp=0.0)
    assert result.state == "initialising" and result.reason == "too few matches"


def test_a_stereo_camera_measures_the_distance(settings, wall):
    settings["Camera.bf"] = 0.1 * 260.0
    slam = hullslam.System(settings, "stereo")
    for i in range(12):
        result = slam.track(wall.image(i), right=wall.right(i, 0.1), masks=wall.masks(i),
                            masks_right=wall.masks(i, 13), timestamp=i / 30.0)
    assert "mask_not_in_left" not in slam.object_counts["rejections"]
    slam.track(wall.image(12), right=wall.right(12, 0.1), masks=wall.masks(12),
               masks_right=wall.masks(12, 60), timestamp=0.4)
    assert slam.object_counts["rejections"]["mask_not_in_left"] == 1
    assert result.state == "tracked"
    assert result.world_from_cam[:3, 3] == pytest.approx(Wall.center(11), abs=0.01)
    slam.finish()
    assert np.median(slam.map.landmarks["position"][:, 2]) == pytest.approx(2.0, abs=0.05)


def test_the_map_has_landmarks_keyframes_and_observations(slam, wall):
    wall.track(slam, 0, 20, masks=True)
    slam.finish()
    landmarks, keyframes, seen = slam.map.landmarks, slam.map.keyframes, slam.map.observations
    assert landmarks["position"].shape == (len(landmarks), 3)
    assert np.median(landmarks["position"][:, 2]) == pytest.approx(Wall.DISTANCE, abs=0.02)
    assert keyframes["cam_from_world"].shape == (len(keyframes), 4, 4)
    assert np.array_equal(keyframes["cam_from_world"][0], np.eye(4))
    assert len(seen) == landmarks["observations"].sum()
    assert set(seen["keyframe"]) <= set(keyframes["id"])
    first = seen[seen["keyframe"] == 0]
    positions = dict(zip(landmarks["id"], landmarks["position"]))
    points = np.array([positions[landmark] for landmark in first["landmark"]])
    projected = 260.0 * points[:, :2] / points[:, 2:] + [159.5, 119.5]
    assert np.median(np.linalg.norm(projected - first["pixel"], axis=1)) < 1.0
    assert np.allclose(first["depth"], Wall.DISTANCE)
    assert slam.times["track"].shape == (20,) and slam.object_counts["frames_with_masks"] == 20
    assert "keyframes" in repr(slam.map)


def test_objects_of_a_sequence(desk):
    settings = hullslam.Settings(desk / "camera.yaml")
    sequence = hullslam.open_tum(desk, settings)
    slam = hullslam.System(settings)
    masks = hullslam.open_masks(desk / "masks", sequence)
    for frame, found in zip(sequence, masks):
        slam.track(frame.image, frame.depth, found, timestamp=frame.timestamp)
    slam.finish()
    objects = slam.map.objects
    assert len(objects) >= 2
    for thing in objects:
        assert thing.is_mapped and thing.label in thing.votes
        pose, axes, quadric = thing.world_from_object, thing.half_axes, thing.dual_quadric
        expected = pose @ np.diag([*axes**2, -1.0]) @ pose.T
        assert np.allclose(quadric, expected)
        assert set(thing.keyframes) <= set(slam.map.keyframes["id"])
        # The largest angle between the rays from the cameras to the centre.
        poses = dict(zip(slam.map.keyframes["id"], slam.map.keyframes["cam_from_world"]))
        rays = [pose[:3, 3] + np.linalg.inv(poses[k])[:3, 3] * -1.0 for k in thing.keyframes]
        rays = np.array([ray / np.linalg.norm(ray) for ray in rays])
        angle = np.degrees(np.arccos(np.clip(rays @ rays.T, -1.0, 1.0).min()))
        assert thing.parallax == pytest.approx(angle, abs=1e-6)
        assert 0.5 < thing.siou <= 1.0
        assert thing.quality == pytest.approx(
            thing.siou * min(1.0, thing.parallax / 20.0) * min(1.0, len(thing.keyframes) / 10.0))
    for thing in slam.map.candidates:
        assert np.isfinite(thing.half_axes).all() or (thing.parallax, thing.siou, thing.quality) == (None, None, 0.0)


def test_a_snapshot_never_changes(slam, wall):
    wall.track(slam, 0, 3)
    snapshot = slam.map
    before = snapshot.keyframes
    wall.track(slam, 3, 40)
    assert np.array_equal(snapshot.keyframes, before)
    assert len(slam.map.keyframes) > len(before)


def test_arrays_belong_to_the_caller(slam, wall):
    result = wall.track(slam, 0, 1)[0]
    result.cam_from_world[:] = 7.0
    slam.map.landmarks["position"][:] = 7.0
    assert np.array_equal(result.cam_from_world, np.eye(4))
    assert slam.map.landmarks["position"].max() < 7.0


def test_layouts_that_need_a_copy_give_the_same_poses(settings, wall):
    def poses(layout):
        slam = hullslam.System(settings)
        for i in range(4):
            slam.track(layout(wall.image(i)), layout(wall.depth), timestamp=float(i))
        return slam.trajectory.format()

    plain = poses(lambda pixels: pixels)

    def padded(pixels):  # rows are farther apart than they are long; needs no copy
        wide = np.zeros((pixels.shape[0], pixels.shape[1] + 6), pixels.dtype)
        wide[:, 3:-3] = pixels
        return wide[:, 3:-3]

    assert poses(padded) == plain
    assert poses(np.asfortranarray) == plain
    assert poses(lambda pixels: np.ascontiguousarray(pixels[::-1, ::-1])[::-1, ::-1]) == plain

    def read_only(pixels):
        copy = pixels.copy()
        copy.flags.writeable = False
        return copy

    assert poses(read_only) == plain


def test_colours_are_blue_first_unless_the_settings_say_otherwise(settings, wall):
    def poses(settings, channels):
        slam = hullslam.System(settings)
        image = np.zeros((*wall.image(0).shape, 3), np.uint8)
        for i in range(4):
            image[:, :, channels] = wall.image(i)[:, :, None]
            slam.track(image, wall.depth, timestamp=float(i))
        return slam.trajectory.format()

    blue_first = poses(settings, [0, 1])
    settings.Camera.RGB = True
    assert poses(settings, [2, 1]) == blue_first


def test_reset_gives_the_bits_of_a_new_system(slam, wall):
    wall.track(slam, 0, 15)
    slam.finish()
    first = slam.trajectory.format()
    slam.reset()
    assert len(slam.map.keyframes) == 0
    wall.track(slam, 0, 15)
    slam.finish()
    assert slam.trajectory.format() == first


def test_a_map_is_saved_loaded_and_localised_in(settings, slam, wall, tmp_path):
    path = tmp_path / "wall.map"
    wall.track(slam, 0, 30)
    slam.finish()
    slam.save_map(path)
    assert np.array_equal(hullslam.read_map(path).landmarks, slam.map.landmarks)

    later = hullslam.System(settings, map=path, session="second", localization=True)
    keyframes = later.map.keyframes
    results = wall.track(later, 100, 110)
    assert [result.state for result in results] == ["tracked"] * 10
    assert np.array_equal(later.map.keyframes, keyframes) and later.localization
    later.localization = False
    wall.track(later, 110, 160)
    assert len(later.map.keyframes) > len(keyframes)
    assert later.map.sessions[-1] == "second"
    later.localization = True
    keyframes = later.map.keyframes
    wall.track(later, 160, 200)
    assert np.array_equal(later.map.keyframes["id"], keyframes["id"])
    later.finish()
    assert len(later.trajectory) > 0

    slam.load_map(path, session="third")
    assert wall.track(slam, 0, 1)[0].state == "tracked"


def test_masks_may_come_after_their_frame(slam, wall):
    square = hullslam.Masks.from_outlines([[(100, 80), (200, 80), (200, 160), (100, 160)]], ["cup"])
    assert slam.add_masks(0, square) is False
    slam.await_masks(True)
    first = slam.track(wall.images[0], wall.depth, timestamp=0.0)
    slam.track(wall.images[1], wall.depth, timestamp=0.1)
    assert slam.add_masks(first.frame, square) is True
    assert slam.add_masks(first.frame, square) is False
    assert slam.add_masks(-1, square) is False
    assert slam.object_counts["frames_with_masks"] == 1
    wrong = hullslam.Masks(np.zeros((1, 10, 10), bool), ["cup"])
    with pytest.raises(hullslam.InputError, match="10x10"):
        slam.add_masks(first.frame, wrong)


def test_objects_have_names_locks_and_sizes(settings, slam, wall, tmp_path):
    square = hullslam.Masks.from_outlines([[(100, 80), (200, 80), (200, 160), (100, 160)]], ["cup"])
    slam.track(wall.images[0], wall.depth, square, timestamp=0.0)
    [thing] = slam.map.candidates
    assert (thing.name, thing.is_locked) == ("", False)
    slam.name_object(thing.id, "Großmutters")
    slam.lock_object(thing.id)
    slam.set_object_size(thing.id, 0.465)
    for wrong in (-1, 77, 2**40):
        with pytest.raises(hullslam.InputError, match=f"no object {wrong}"):
            slam.delete_object(wrong)
    with pytest.raises(hullslam.InputError, match="100"):
        slam.name_object(thing.id, "ß" * 51)
    for wrong in (-1.0, 100.5, float("nan")):
        with pytest.raises(hullslam.InputError, match="0.001 to 100 m"):
            slam.set_object_size(thing.id, longest_side=wrong)
    slam.save_map(tmp_path / "named.map")

    later = hullslam.System(settings, map=tmp_path / "named.map", localization=True)
    [thing] = later.map.candidates
    assert (thing.name, thing.is_locked, thing.known_size) == ("Großmutters", True, 0.465)
    later.lock_object(thing.id, locked=False)
    later.name_object(thing.id, "")
    later.set_object_size(thing.id, 0)
    [thing] = later.map.candidates
    assert (thing.name, thing.is_locked, thing.known_size) == ("", False, 0)
    later.delete_object(thing.id)
    assert later.map.candidates == []
    later.finish()
    with pytest.raises(hullslam.InputError, match="finish"):
        later.name_object(thing.id, "a")


@pytest.mark.parametrize("kind", [bool, np.uint8])
def test_one_mask_for_all_images_hides_its_pixels(settings, wall, kind):
    used = np.ones((240, 320), kind)
    used[:, 160:] = 0
    slam = hullslam.System(settings, "rgbd", mask_all=used)
    used[:] = 0  # the array belongs to the caller
    first, *others = wall.track(slam, 0, 3)
    assert first.state == "tracked" and len(others) == 2
    for result in others:
        assert result.state == "tracked"
        assert result.matches["pixel"][:, 0].max() < 160
    with pytest.raises(hullslam.InputError, match="mask_all is 160x240 px, expected Camera.width"):
        hullslam.System(settings, "rgbd", mask_all=np.ones((240, 160), bool))
    with pytest.raises(hullslam.InputError, match="0 everywhere"):
        hullslam.System(settings, "rgbd", mask_all=used)
    with pytest.raises(hullslam.InputError, match="mask_all"):
        hullslam.System(settings, "rgbd", mask_all=np.ones((240, 320), np.float32))
    with pytest.raises(hullslam.InputError, match="stereo camera"):
        hullslam.System(settings, "rgbd", mask_all_right=np.ones((240, 320), bool))


def test_a_new_map_begins_at_a_given_pose(settings, wall):
    start = np.eye(4)
    start[:3, 3] = 1, 2, 3
    first, second = wall.track(hullslam.System(settings, start_pose=start), 0, 2)
    assert np.allclose(first.world_from_cam, start)
    (_, expected) = wall.track(hullslam.System(settings), 0, 2)
    assert np.allclose(second.world_from_cam, start @ expected.world_from_cam, atol=1e-6)
    with pytest.raises(hullslam.InputError, match="start_pose"):
        hullslam.System(settings, start_pose=2 * start)


def test_the_threaded_pipelines_work(settings, wall):
    for pipeline in ("threaded", "realtime"):
        slam = hullslam.System(settings, pipeline=pipeline)
        results = wall.track(slam, 0, 20, masks=True)
        slam.finish()
        assert results[-1].state == "tracked" and len(slam.trajectory) == 20


def test_two_systems_in_two_threads_do_not_disturb_each_other(settings, wall):
    def run(results):
        slam = hullslam.System(settings)
        wall.track(slam, 0, 20, masks=True)
        slam.finish()
        results.append(slam.trajectory.format())

    alone, together = [], []
    run(alone)
    threads = [threading.Thread(target=run, args=(together,)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert together == alone * 2


def test_the_lock_of_the_interpreter_is_released(slam, wall):
    done = threading.Event()
    counted = 0

    def track():
        wall.track(slam, 0, 40, masks=True)
        done.set()

    thread = threading.Thread(target=track)
    thread.start()
    while not done.wait(0.0005):
        counted += 1
    thread.join()
    assert counted > 40, "this thread ran while the other one tracked"
