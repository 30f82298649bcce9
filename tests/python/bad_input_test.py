# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input is an InputError that says what was expected, and changes nothing."""

import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest

import hullslam
from conftest import CAMERA, HEIGHT, ROOT, WIDTH

IMAGE = np.zeros((HEIGHT, WIDTH), np.uint8)
DEPTH = np.ones((HEIGHT, WIDTH), np.float32)


def refuse(expected, function, *arguments, **keywords):
    """Expects an InputError whose message contains `expected`."""
    with pytest.raises(hullslam.InputError) as error:
        function(*arguments, **keywords)
    assert expected in str(error.value), str(error.value)


def test_an_input_error_is_a_value_error():
    assert issubclass(hullslam.InputError, ValueError)
    assert "expected" in hullslam.InputError.__doc__


@pytest.mark.parametrize("image, expected", [
    (IMAGE.astype(np.float32), "the image has the type float32, expected uint8"),
    (IMAGE.astype(np.float64), "the image has the type float64, expected uint8"),
    (IMAGE.astype(bool), "the image has the type bool, expected uint8"),
    (IMAGE.astype(np.uint16), "the image has the type uint16, expected uint8"),
    (IMAGE.astype(object), "the image has the type object, expected uint8"),
    (IMAGE[:, :-1], "the image is 319x240 px, expected"),
    (IMAGE.T, "the image is 240x320 px, expected"),
    (IMAGE.ravel(), "the image has the shape (76800,), expected (height, width)"),
    (np.zeros((HEIGHT, WIDTH, 2), np.uint8), "the image has the shape (240, 320, 2), expected"),
    (np.zeros((3, HEIGHT, WIDTH), np.uint8), "the image has the shape (3, 240, 320), expected"),
    (IMAGE[:0], "the image has the shape (0, 320), expected a height and a width"),
    (np.zeros((1, 1 << 17), np.uint8), "expected a height and a width"),
    (np.lib.stride_tricks.as_strided(IMAGE, (HEIGHT, WIDTH), (0, 1))[:10], "320x10 px, expected"),
    # Before, an image that is no view was copied before its size was looked at: 4 GB.
    (np.broadcast_to(np.zeros(1, np.uint8), (1 << 16, 1 << 16)), "expected a height and a width from 1 to 65535 px"),
    ("image.png", "the image has the type <U9, expected uint8"),
    (None, "the image is None, expected a numpy array; cv2.imread gives None for a file that is not there"),
])
def test_images(slam, wall, image, expected):
    refuse(expected, slam.track, image, DEPTH, timestamp=0.0)
    assert wall.track(slam, 0, 1)[0].state == "tracked"


# Their members were read from memory without any content, and the interpreter crashed.
UNINITIALISED = """
import hullslam
read = 0
for kind in vars(hullslam).values():
    if not isinstance(kind, type) or issubclass(kind, BaseException):
        continue
    made = kind.__new__(kind)
    for name in [n for n in dir(kind) if not n.startswith("_")] + ["__len__", "__repr__"]:
        try:
            value = getattr(made, name)
            value() if name == "__len__" else None
        except (TypeError, AttributeError, RecursionError) as error:
            read += "without __init__" in str(error)
print(read)
"""


def test_objects_without_init_are_refused():
    result = subprocess.run([sys.executable, "-c", UNINITIALISED], capture_output=True, text=True, check=False,
                            timeout=60)
    assert result.returncode == 0, result.stderr
    assert int(result.stdout) > 20


@pytest.mark.parametrize("depth, expected", [
    (DEPTH.astype(np.float64), "the depth image has the type float64, expected uint16 or float32"),
    (DEPTH.astype(np.int32), "the depth image has the type int32, expected uint16 or float32"),
    (DEPTH.astype(">u2"), "the depth image has the type >u2, expected uint16 or float32"),
    (DEPTH[:-1], "the depth image is 320x239 px, expected"),
    (DEPTH[..., None], "the depth image has the shape (240, 320, 1), expected (height, width)"),
    (None, "depth is None, expected a depth image"),
])
def test_depth(slam, depth, expected):
    refuse(expected, slam.track, IMAGE, depth, timestamp=0.0)


def test_a_depth_image_of_a_monocular_camera(settings):
    slam = hullslam.System(settings, "mono")
    refuse("there is a depth image, expected None", slam.track, IMAGE, DEPTH, timestamp=0.0)


def test_the_second_image_is_that_of_the_mode(settings, slam):
    refuse("there is a right image, expected None in the mode 'rgbd'",
           slam.track, IMAGE, DEPTH, right=IMAGE, timestamp=0.0)
    refuse("there are masks of a right image, expected none", slam.track, IMAGE, DEPTH,
           masks_right=hullslam.Masks.from_outlines([[[0, 0], [90, 0], [90, 90]]], ["cup"]),
           timestamp=0.0)
    stereo = hullslam.System(settings, "stereo")
    refuse("right is None, expected the right image", stereo.track, IMAGE, timestamp=0.0)
    refuse("there is a depth image, expected None in the mode 'stereo'",
           stereo.track, IMAGE, DEPTH, right=IMAGE, timestamp=0.0)
    refuse("the right image is 320x239 px", stereo.track, IMAGE, right=IMAGE[:-1], timestamp=0.0)


def test_a_depth_image_without_any_depth_is_waited_out(slam):
    unknown = np.full_like(DEPTH, np.nan)
    assert slam.track(IMAGE, unknown, timestamp=0.0).state == "initialising"


@pytest.mark.parametrize("timestamp, expected", [
    (float("nan"), "timestamp is not finite"),
    (float("inf"), "timestamp is not finite"),
    (0.5, "timestamp is 0.500000 s, expected more than that of the last frame, 0.500000 s"),
    (-1.0, "expected more than that of the last frame"),
    (1305031102175304000, "timestamp is 1.30503e+18, expected seconds, up to 1e+11"),
    (-1e300, "timestamp is -1e+300, expected seconds"),
    (5e9, "after that of the last frame, expected seconds, not nanoseconds"),
])
def test_time_stamps(slam, timestamp, expected):
    slam.track(IMAGE, DEPTH, timestamp=0.5)
    refuse(expected, slam.track, IMAGE, DEPTH, timestamp=timestamp)
    slam.track(IMAGE, DEPTH, timestamp=0.6)


def test_arguments_of_another_type_are_type_errors(slam):
    for keywords in ({"timestamp": "now"}, {"timestamp": None}, {}, {"masks": [1], "timestamp": 1.0}):
        with pytest.raises(TypeError):
            slam.track(IMAGE, DEPTH, **keywords)
    with pytest.raises(TypeError):
        hullslam.System("TUM1.yaml")


def test_type_errors_name_types_and_no_values(slam):
    image = np.full((HEIGHT, WIDTH), 77, np.uint8)
    calls = ((slam.track, (image, DEPTH, image), {"timestamp": 0.0}, "System, numpy.ndarray, numpy.ndarray, "
              "numpy.ndarray, timestamp: float"),
             (slam.track, (image,), {}, "System, numpy.ndarray"),
             (hullslam.System, (image,), {}, "System, numpy.ndarray"),
             (hullslam.Masks.from_outlines, (image, 7), {}, "Called with: numpy.ndarray, int"),
             (hullslam.read_map, (image,), {}, "Called with: numpy.ndarray"))
    for function, arguments, keywords, expected in calls:
        with pytest.raises(TypeError) as error:
            function(*arguments, **keywords)
        message = str(error.value)
        assert expected in message and "incompatible" in message, message
        assert "77" not in message and "Invoked" not in message, message


def test_messages_name_arguments_and_no_options_of_programs(settings, tmp_path):
    refuse("expected Settings(FILE)", hullslam.default_settings, tmp_path)
    refuse("preset: ", hullslam.Settings, Camera=CAMERA, preset="orb_slam9")
    (tmp_path / "a.png").write_bytes(b"")
    for call in (lambda: hullslam.default_settings(tmp_path),
                 lambda: hullslam.Settings(Camera=CAMERA, preset="orb_slam9"),
                 lambda: hullslam.open_images(tmp_path, settings, fps=-1.0)):
        with pytest.raises(hullslam.InputError) as error:
            call()
        assert "--" not in str(error.value), str(error.value)


STACK = np.zeros((2, HEIGHT, WIDTH), bool)


@pytest.mark.parametrize("stack, classes, scores, expected", [
    (STACK.astype(np.float32), ["a", "b"], None, "has the type float32, expected bool or uint8"),
    (STACK.astype(np.int64), ["a", "b"], None, "has the type int64, expected bool or uint8"),
    (STACK[0], ["a"], None, "has the shape (240, 320), expected (objects, height, width)"),
    (STACK, ["a"], None, "classes has 1 entries, expected one for each of the 2 masks"),
    (STACK, ["a", "b"], [0.5], "scores has 1 entries, expected one for each of the 2 masks"),
    (STACK, ["a", "b"], [0.5, 1.5], "the score is 1.5, expected a number from 0 to 1"),
    (STACK, ["a", "b"], [0.5, float("nan")], "the score is nan"),
    (STACK, ["a", ""], None, "the label is empty"),
    (STACK[:, :0], ["a", "b"], None, "expected a height and a width"),
])
def test_stacks_of_masks(stack, classes, scores, expected):
    refuse(expected, hullslam.Masks, stack, classes, scores)


def test_masks_of_another_size_than_the_image(slam):
    stack = np.ones((1, HEIGHT // 2, WIDTH // 2), bool)
    masks = hullslam.Masks(stack, ["cup"])
    refuse("the masks are 160x120 px, expected the size of the image, 320x240 px", slam.track, IMAGE,
           DEPTH, masks, timestamp=0.0)
    far = hullslam.Masks.from_outlines([[[0, 0], [9, 0], [9, 5000]]], ["cup"])
    refuse("expected pixels of the 320x240 image", slam.track, IMAGE, DEPTH, far, timestamp=0.0)


def test_labels_and_outlines():
    labels = np.zeros((HEIGHT, WIDTH), np.uint16)
    labels[10:50, 10:50] = 7
    refuse("the instance 7, which has no class", hullslam.Masks.from_labels, labels, {1: "cup"})
    refuse("has the type float64", hullslam.Masks.from_labels, labels.astype(float), {7: "cup"})
    outlines = hullslam.Masks.from_outlines
    refuse("outline 0 has the shape (2, 2)", outlines, [[[0, 0], [1, 1]]], ["cup"])
    refuse("outline 0 has the shape (3, 3)", outlines, [np.zeros((3, 3))], ["cup"])
    refuse("outline 0 has a value that is not finite", outlines, [np.full((3, 2), np.nan)], ["cup"])
    refuse("classes has 0 entries", outlines, [np.zeros((3, 2))], [])


@pytest.mark.parametrize("keywords, expected", [
    ({"mode": "lidar"}, "mode is 'lidar', expected one of: rgbd, mono, stereo"),
    ({"pipeline": "fast"}, "pipeline is 'fast', expected one of: sequential, threaded, realtime"),
    ({"vocabulary": "none.bow"}, "none.bow"),
    ({"map": "none.map"}, "none.map"),
    ({"localization": True}, "localization needs a map with keyframes"),
])
def test_systems(settings, keywords, expected):
    refuse(expected, hullslam.System, settings, **keywords)


def test_calls_after_finish(slam, wall, tmp_path):
    wall.track(slam, 0, 3)
    slam.finish()
    slam.finish()
    refuse("track() was called after finish()", slam.track, IMAGE, DEPTH, timestamp=9.0)
    assert len(slam.trajectory) == 3
    slam.save_map(tmp_path / "a.map")


def test_maps(slam, wall, settings, tmp_path):
    path = tmp_path / "a.map"
    refuse("there is no map yet", slam.save_map, path)
    with pytest.raises(hullslam.InputError, match="localization needs a map"):
        slam.localization = True
    wall.track(slam, 0, 3)
    refuse("none/a.map", slam.save_map, tmp_path / "none" / "a.map")
    slam.save_map(path)
    content = path.read_bytes()
    path.write_bytes(content[:-100])
    refuse("a.map", hullslam.read_map, path)
    path.write_bytes(content)
    settings.ORBextractor.nLevels = 4
    refuse("a.map", hullslam.System, settings, map=path)
    refuse("none.map", slam.load_map, tmp_path / "none.map")
    assert wall.track(slam, 3, 4)[0].state == "tracked", "the run goes on"


POSE = np.eye(4)


@pytest.mark.parametrize("pose, expected", [
    (np.full((4, 4), np.nan), "world_from_cam has a value that is not finite"),
    (np.eye(3), "world_from_cam has the shape (3, 3), expected (4, 4)"),
    (np.zeros(7), "world_from_cam has the shape (7,), expected 2 dimension(s)"),
    (np.diag([1.0, 1.0, -1.0, 1.0]), "world_from_cam has no rotation"),
    (2.0 * np.eye(4), "world_from_cam has no rotation"),
    (np.eye(4) + [[0], [0], [0], [1]], "world_from_cam has a last row other than 0 0 0 1"),
    (POSE.astype(str), "world_from_cam has the type <U32, expected numbers"),
])
def test_poses(settings, pose, expected):
    mapper = hullslam.KnownPoseMapper(settings)
    masks = hullslam.Masks(STACK, ["a", "b"])
    refuse(expected, mapper.add_view, pose, masks, timestamp=0.0)
    refuse("timestamp is not finite", mapper.add_view, POSE, masks, timestamp=float("nan"))
    refuse("320x239", mapper.add_view, POSE, masks, DEPTH[:-1], timestamp=0.0)
    assert len(mapper.map.keyframes) == 0


@pytest.mark.parametrize("timestamps, poses, expected", [
    ([0.0, 1.0], [POSE], "expected (2, 4, 4)"),
    ([0.0, 0.0], [POSE, POSE], "pose 1 has a time stamp that is not after the one before"),
    ([0.0, np.nan], [POSE, POSE], "timestamps has a value that is not finite"),
    ([0.0, 1.0], [POSE, 0.0 * POSE], "pose 1 has no rotation"),
    ([0.0], POSE, "world_from_cam has the shape (4, 4), expected 3 dimension(s)"),
])
def test_trajectories(timestamps, poses, expected):
    refuse(expected, hullslam.Trajectory, timestamps, poses)


def test_evaluation(tmp_path):
    trajectory = hullslam.Trajectory([0.0, 1.0], [POSE, POSE])
    evaluate = hullslam.evaluate_trajectory
    refuse("align is 'SE3', expected one of: se3, sim3, none", evaluate, trajectory, trajectory,
           align="SE3")
    refuse("pairing is 'x', expected one of: tum, evo", evaluate, trajectory, trajectory, pairing="x")
    refuse("max_difference", evaluate, trajectory, trajectory, max_difference=-1.0)
    refuse("", evaluate, trajectory, hullslam.Trajectory([50.0], [POSE]))
    path = tmp_path / "bad.txt"
    path.write_text("1 0 0 0 0 0 0 1\n2 0 0 a 0 0 0 1\n")
    refuse("bad.txt:2:", evaluate, path, trajectory)
    refuse("none.txt", hullslam.read_trajectory, tmp_path / "none.txt")


def test_sequences(settings, tmp_path):
    refuse("none", hullslam.open_tum, tmp_path / "none", settings)
    refuse("none", hullslam.open_stored_images, tmp_path / "none")
    refuse("", hullslam.open_images, tmp_path, settings)
    refuse("camera.yaml", hullslam.default_settings, tmp_path)


def test_two_threads_take_turns(slam, wall):
    outcomes = []
    start = threading.Barrier(2)

    def track(offset):
        start.wait()
        for i in range(20):
            try:
                slam.track(wall.image(i), wall.depth, timestamp=i + offset)
                outcomes.append("tracked")
            except hullslam.InputError as error:
                assert "expected more than that of the last frame" in str(error)
                outcomes.append("refused")

    threads = [threading.Thread(target=track, args=(offset,)) for offset in (0.0, 0.5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    slam.finish()
    assert len(outcomes) == 40
    assert len(slam.trajectory) == outcomes.count("tracked") > 0


@pytest.mark.parametrize("pipeline", ["sequential", "threaded"])
@pytest.mark.parametrize("call", ["pass", "slam.finish()"])
def test_the_interpreter_exits_while_a_run_is_alive(pipeline, call):
    program = textwrap.dedent(f"""
        import threading
        import hullslam
        from conftest import CAMERA, Wall
        wall = Wall()
        slam = hullslam.System(hullslam.Settings(Camera=CAMERA), pipeline="{pipeline}")
        begun = threading.Event()
        def run():
            for i in range(100000):
                slam.track(wall.image(i), wall.depth, wall.masks(i), timestamp=i / 30)
                if i == 5:
                    begun.set()
                    {call}
        threading.Thread(target=run, daemon=True).start()
        begun.wait()
    """)
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                            cwd=ROOT / "tests" / "python", timeout=60, check=False)
    assert result.returncode == 0, result.stderr
    # After finish() the next track() is refused, which ends the thread with a message. The exit of the
    # interpreter may cut it.
    assert result.stderr == "" or (call != "pass"
                                   and result.stderr.startswith("Exception in thread"))
