# SPDX-License-Identifier: GPL-3.0-or-later
import os
import pathlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt


__version__: str

_Path = str | os.PathLike[str]
_Image = npt.NDArray[np.uint8]
_Depth = npt.NDArray[np.uint16] | npt.NDArray[np.float32]
_Doubles = npt.NDArray[np.float64]
_Rows = npt.NDArray[np.void]  # a structured array

class InputError(ValueError):
    """A file, a setting or an argument is wrong.

    The message names the file and line, or the argument and its value, and says what was expected.
    """

class SettingsTable:
    """The registry of settings. hullslam.Settings is derived from it."""
    @overload
    def __init__(self, file: _Path | None = None, preset: str | None = None,
                 overrides: Sequence[str] = ...) -> None:
        """Overloaded function.

        1. __init__(self: hullslam._core.SettingsTable, file: Optional[os.PathLike] = None, preset: Optional[str] = None, overrides: List[str] = []) -> None

        2. __init__(self: hullslam._core.SettingsTable, other: hullslam._core.SettingsTable) -> None

        A copy.
        """
    @overload
    def __init__(self, other: SettingsTable) -> None:
        """Overloaded function.

        1. __init__(self: hullslam._core.SettingsTable, file: Optional[os.PathLike] = None, preset: Optional[str] = None, overrides: List[str] = []) -> None

        2. __init__(self: hullslam._core.SettingsTable, other: hullslam._core.SettingsTable) -> None

        A copy.
        """
    @property
    def warnings(self) -> list[str]:
        """What the reader has to say about the settings: list of str."""
    @property
    def hash(self) -> str:
        """16 hexadecimal digits that change with every setting; `summary.json` has them too."""
    @property
    def image_size(self) -> tuple[int, int]:
        """Width and height of the images, px."""
    def entries(self) -> list[tuple[str, str, str, str, str, bool]]:
        """Key, value, default, expected value, meaning and is_shared of all settings."""
    @staticmethod
    def defaults() -> list[tuple[str, str, str, str, str, bool]]:
        """entries() with all values at their default."""
    def set_text(self, key: str, text: str) -> None:
        """Sets one setting from text, as a settings file has it."""
    def format(self) -> str:
        """All settings as the text of a settings file."""

class Trajectory:
    """Poses of a camera in order of time."""
    def __init__(self, timestamps: npt.ArrayLike, world_from_cam: npt.ArrayLike) -> None:
        """timestamps: (N,), s, increasing. world_from_cam: (N, 4, 4) homogeneous matrices."""
    def __len__(self) -> int: ...
    @property
    def timestamps(self) -> _Doubles:
        """(N,) float64, s."""
    @property
    def world_from_cam(self) -> _Doubles:
        """(N, 4, 4) float64: maps points of the camera frame (x right, y down,
        z forward, m) to the world frame.
        """
    @property
    def positions(self) -> _Doubles:
        """(N, 3) float64: centres of the camera in the world frame, m."""
    def interpolate(self, timestamp: float, max_gap: float) -> _Doubles | None:
        """The (4, 4) pose at a time stamp (s), between its two neighbours. None before the first
        pose, after the last one, and in a gap longer than `max_gap` (s).
        """
    def format(self) -> str:
        """The text of a file in TUM's format: timestamp tx ty tz qx qy qz qw."""
    def write(self, path: _Path) -> None:
        """Writes a file in TUM's format. It is complete or not there at all."""

class TrajectoryErrors:
    """The errors of a trajectory after alignment to the true one
    (Sturm et al. 2012). Made by evaluate_trajectory().
    """
    @property
    def ate_rmse(self) -> float:
        """Root mean square of the distances of paired positions, m."""
    @property
    def ate_mean(self) -> float:
        """Mean distance, m."""
    @property
    def ate_median(self) -> float:
        """Median distance, m."""
    @property
    def ate_max(self) -> float:
        """Largest distance, m."""
    @property
    def rpe_translation_rmse(self) -> float | None:
        """Error of motions of one second, m; None if no two poses are one second apart."""
    @property
    def rpe_rotation_rmse(self) -> float | None:
        """The same for their rotation, degrees."""
    @property
    def pairs(self) -> int:
        """Number of paired poses."""
    @property
    def coverage(self) -> float:
        """Share of the estimated poses that are paired, 0 to 1."""
    @property
    def alignment(self) -> Literal["se3", "sim3", "none"]:
        """'se3', 'sim3' or 'none'."""
    @property
    def scale(self) -> float:
        """Metres per unit of length of the estimate; 1 without 'sim3'."""
    @property
    def groundtruth_from_estimate(self) -> _Doubles:
        """(4, 4) rigid motion of the estimate after its positions were multiplied by `scale`."""

class Masks:
    """The masks of the objects in one image, in its raw pixels. They are kept as
    outlines; masks without an area of 1 px^2 are left out.
    """
    def __init__(self, stack: npt.NDArray[np.bool_] | npt.NDArray[np.uint8],
                 classes: Sequence[str], scores: Sequence[float] | _Doubles | None = None) -> None:
        """stack: (N, height, width) bool or uint8, not 0 at the pixels of object i.
        classes: N names. scores: N numbers from 0 to 1, or None for 1.
        Raises InputError for another type, shape or number of entries.
        """
    @staticmethod
    def from_labels(labels: npt.NDArray[np.uint8] | npt.NDArray[np.uint16] | npt.NDArray[np.int32],
                    classes: Mapping[int, str], scores: Mapping[int, float] = ...) -> Masks:
        """labels: (height, width) uint8, uint16 or int32: the number of the instance that
        a pixel shows, or 0. classes: the name of each number. scores: its score.
        """
    @staticmethod
    def from_outlines(outlines: Sequence[npt.ArrayLike], classes: Sequence[str],
                      scores: Sequence[float] | _Doubles | None = None) -> Masks:
        """outlines: N arrays (points, 2) of raw pixels x, y; the centre of the first
        pixel is (0, 0).
        """
    def __len__(self) -> int: ...
    @property
    def classes(self) -> list[str]:
        """N names."""
    @property
    def scores(self) -> list[float]:
        """N numbers from 0 to 1."""
    @property
    def outlines(self) -> list[list[_Doubles]]:
        """For each mask the outlines of its parts, the largest first: arrays
        (points, 2) of raw pixels.
        """

class Segmenter:
    """A network for instance segmentation (YOLOv8-seg, YOLO11-seg, YOLOv5-seg in ONNX)
    that makes the masks of images. docs/segmentation.md tells how to get one.
    """
    def __init__(self, network: _Path, *, min_score: float = 0.25, classes: Sequence[str] = ...,
                 names: _Path | None = None, size: int = 0, threads: int = 0,
                 boxes: bool = False) -> None:
        """min_score: least score of an instance. classes: only these; empty for all.
        names: a file with the name of one class per line, or None for those in the file
        of the network. size: longer side of the image that the network sees, px; 0 for
        the one of its input. threads: of OpenCV; 0 leaves them as they are. boxes: accept a
        network that finds no masks. Raises InputError for a file that is no such network.
        """
    def segment(self, image: _Image) -> Masks:
        """The masks of an image, best score first. image: uint8, (height, width) or
        (height, width, 3 or 4) with blue first.
        """
    def attach(self, system: System, *, wait: bool = True) -> None:
        """From now on, makes the masks of the keyframes that this System tracks without masks,
        until it is reset. wait: track() waits for them; False: a thread makes them, and they
        are added when they are ready. An image that the network fails on gets none.
        """
    @property
    def class_names(self) -> list[str]:
        """The names of the classes by their numbers."""

class SequenceFrame:
    """One decoded frame of a sequence."""
    @property
    def timestamp(self) -> float:
        """Time stamp, s."""
    @property
    def name(self) -> str:
        """The name of the colour image without folder and extension."""
    @property
    def image(self) -> _Image:
        """(height, width) uint8, grey."""
    @property
    def depth(self) -> _Depth | None:
        """(height, width) uint16 in units of 1 / DepthMapFactor metres, or float32 in metres;
        None without depth.
        """
    @property
    def right(self) -> _Image | None:
        """(height, width) uint8, the right image of a stereo camera, rectified as `image`; None
        without one.
        """

class ImageSequence:
    """The frames of a data set, which are decoded one by one."""
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> SequenceFrame: ...
    def __iter__(self) -> Iterator[SequenceFrame]: ...
    def colour(self, index: int) -> _Image:
        """Decodes the image of a frame in colour: (height, width, 3) uint8, blue first."""
    @property
    def names(self) -> list[str]:
        """The name of each image without folder and extension, as SequenceFrame.name: list of str."""
    @property
    def files(self) -> list[pathlib.Path]:
        """The file of each image: list of pathlib.Path. Images of a video or a recording have
        none, only a name.
        """
    @property
    def timestamps(self) -> _Doubles:
        """(N,) float64, s."""
    @property
    def mode(self) -> Literal["rgbd", "mono", "stereo"]:
        """'rgbd', 'mono' or 'stereo': the mode of a System for these frames, as open() has
        found it.
        """
    @property
    def notes(self) -> list[str]:
        """What open() has found: list of str; empty without it."""
    @property
    def warnings(self) -> list[str]:
        """Faults in the files that do not end a run: list of str."""
    def check(self, settings: SettingsTable, masks: MaskFiles | None = None) -> list[str]:
        """What can be used but is probably not what was meant: list of str. Depth that is not
        registered to the colour images, masks (MaskFiles) of other images, classes in the
        settings that no mask has. Decodes a few frames. Raises InputError for masks of
        rectified images.
        """
    @property
    def groundtruth(self) -> Trajectory | None:
        """The true Trajectory; None if the data set has none."""

class MaskFiles:
    """The mask files of a sequence, read one by one."""
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> Masks: ...
    def __iter__(self) -> Iterator[Masks]: ...
    @property
    def format(self) -> str:
        """The name of the format, such as 'yolo-seg'."""

class Run:
    """The results of a finished run (docs/outputs.md)."""
    @property
    def folder(self) -> pathlib.Path:
        """The output folder."""
    @property
    def summary(self) -> dict[str, Any]:
        """The content of summary.json: dict."""
    @property
    def trajectory(self) -> Trajectory:
        """The Trajectory of all tracked frames."""
    @property
    def keyframes(self) -> Trajectory:
        """The Trajectory of the keyframes."""
    @property
    def points(self) -> tuple[np.ndarray, np.ndarray] | None:
        """The landmarks: positions (N, 3) float32, world frame, and colours
        (N, 3) uint8; None if the run has not written them.
        """
    @property
    def objects(self) -> dict[str, Any] | None:
        """The content of objects.json: dict; None for a run without masks."""

class MapObject:
    """An object of the map: an ellipsoid with a class. Lengths are in metres, in
    monocular runs in units of the map.
    """
    @property
    def id(self) -> int:
        """The number of the object, as in SeenObject.object."""
    @property
    def label(self) -> str:
        """The class with most votes."""
    @property
    def name(self) -> str:
        """The name by System.name_object(), '' if there is none."""
    @property
    def is_locked(self) -> bool:
        """Whether System.lock_object() has locked it."""
    @property
    def known_size(self) -> float:
        """The longest side by System.set_object_size(), m; 0 if there is none."""
    @property
    def votes(self) -> dict[str, float]:
        """The sum of the scores of each class."""
    @property
    def is_mapped(self) -> bool:
        """Whether the shape fits all its views. If not, the object is a candidate."""
    @property
    def world_from_object(self) -> _Doubles:
        """(4, 4) pose: the origin is the centre and the axes are the ellipsoid's. NaN if
        the shape is not known.
        """
    @property
    def half_axes(self) -> _Doubles:
        """(3,) half axes of the ellipsoid, m; NaN if the shape is not known."""
    @property
    def dual_quadric(self) -> _Doubles:
        """(4, 4) dual quadric Q* in the world frame: tangent planes satisfy pi^T Q* pi = 0. NaN
        if the shape is not known.
        """
    @property
    def keyframes(self) -> list[int]:
        """The ids of the keyframes that observe it."""
    @property
    def misfit(self) -> float:
        """RMS distance of its lines from its projected ellipses, px."""
    @property
    def parallax(self) -> float | None:
        """The largest angle between the rays from the cameras of its keyframes
        to its centre, degrees; None if the shape is not known.
        """
    @property
    def siou(self) -> float | None:
        """Mean intersection over union of its projected ellipses with the hulls
        of its masks, 0 to 1; None if no keyframe has a value.
        """
    @property
    def quality(self) -> float:
        """Reliability of the shape, 0 to 1, as in objects.json: siou times
        min(1, parallax / 20 degrees) times min(1, keyframes / 10); 0 if the
        shape is not known.
        """

class Map:
    """A snapshot of the map, which never changes. Each property makes an array or
    a list of its own. Lengths are in metres, in monocular runs in units of the
    map.
    """
    @property
    def landmarks(self) -> _Rows:
        """Structured array (N,) of the points: id, in no order; position (3,), world frame;
        viewing_direction (3,), mean unit vector from the cameras; keyframe, the id of the one
        that made it; observations, their number.
        """
    @property
    def keyframes(self) -> _Rows:
        """Structured array (N,) of the keyframes: id; frame; timestamp, s;
        cam_from_world (4, 4); parent in the spanning tree, or -1; island.
        """
    @property
    def observations(self) -> _Rows:
        """Structured array (N,) of the observations of points by keyframes:
        landmark and keyframe, their ids; pixel (2,), undistorted; depth along
        the optical axis, m, 0 if it is not known.
        """
    @property
    def objects(self) -> list[MapObject]:
        """The mapped objects: list of MapObject."""
    @property
    def candidates(self) -> list[MapObject]:
        """Objects whose shape is not known or does not fit yet: list of MapObject."""
    @property
    def sessions(self) -> list[str]:
        """The names of the runs that added keyframes."""

class SeenObject:
    """An object that a mask shows in one frame."""
    @property
    def label(self) -> str:
        """The class of the mask."""
    @property
    def score(self) -> float:
        """The score of the mask, 0 to 1."""
    @property
    def object(self) -> int | None:
        """The id of the mapped object that it shows (MapObject.id), or None."""
    @property
    def hull(self) -> _Doubles:
        """(points, 2) convex hull of the mask, undistorted pixels."""
    @property
    def box(self) -> _Doubles:
        """(4,) least x and y and largest x and y of the hull, undistorted px."""

class MapEvent:
    """What happened to the camera or to the map."""
    @property
    def kind(self) -> str:
        """'lost', 'relocalised', 'island_begun', 'island_joined', 'loop_closed', 'rescaled',
        'adjusted', 'object_born', 'object_fused', 'object_moved' or 'object_gone'.
        """
    @property
    def object(self) -> int | None:
        """The id of the object (MapObject.id), or None."""
    @property
    def kept(self) -> int | None:
        """The id of the object that it was fused with, or None."""
    @property
    def mean_moved(self) -> float:
        """The mean distance by which a correction has moved keyframes, m."""
    @property
    def most_moved(self) -> float:
        """The largest such distance, or that by which an object has moved, m."""
    @property
    def scale(self) -> float:
        """The factor by which lengths in the map have grown."""

class TrackResult:
    """What track() found in one frame."""
    @property
    def state(self) -> Literal["tracked", "lost", "initialising"]:
        """'tracked', 'lost', or 'initialising': there is no map yet."""
    @property
    def reason(self) -> str | None:
        """Why the frame has no pose (docs/my-run-fails.md); None if it has one,
        and while the mode 'rgbd' waits for a first image with features.
        """
    @property
    def cam_from_world(self) -> _Doubles | None:
        """(4, 4): maps points of the world frame to the camera frame (x right, y down, z
        forward, m), at the time of tracking. None if the frame is not tracked. The trajectory
        of the system has the pose after later corrections.
        """
    @property
    def world_from_cam(self) -> _Doubles | None:
        """(4, 4): its inverse, the pose of the camera in the world; or None."""
    @property
    def timestamp(self) -> float:
        """Time stamp of the frame, s."""
    @property
    def frame(self) -> int:
        """The number of the frame."""
    @property
    def inliers(self) -> int:
        """The number of landmarks that agree with the pose."""
    @property
    def matches(self) -> _Rows:
        """Structured array (N,) of the keypoints that show a landmark:
        keypoint, its index; landmark, its id in the map before this frame; pixel
        (2,), undistorted.
        """
    @property
    def events(self) -> list[MapEvent]:
        """What has happened since the frame before: list of MapEvent."""
    @property
    def covariance(self) -> _Doubles | None:
        """(6, 6) of the error of the pose (rotation in rad, translation), in
        the axes of the camera, with the drift of the map; or None.
        """
    @property
    def quality(self) -> float:
        """0 to 1: the least probability that the pose places a point in a corner of the image
        at most 1 px from where the landmarks tell.
        """
    @property
    def prior(self) -> Literal["none", "fused", "dropped", "alone"]:
        """How `motion` was used: 'none', 'fused' with the landmarks, 'dropped' because they
        contradict it, or 'alone' where the image shows too few of them.
        """
    @property
    def odom_from_cam(self) -> _Doubles | None:
        """(4, 4): the pose in the world of the odometry, which never jumps but drifts. It goes
        on when the camera is lost. None before the first pose.
        """
    @property
    def map_from_odom(self) -> _Doubles | None:
        """(4, 4): world_from_cam = map_from_odom @ odom_from_cam at tracked frames; or None."""
    @property
    def corrected_at(self) -> int | None:
        """The number of the last frame at which map_from_odom may have jumped; or None."""
    @property
    def odometry_step(self) -> Literal["begun", "measured", "prior", "predicted", "stopped"] | None:
        """Where the last step of the odometry is from: 'begun', 'measured', 'prior',
        'predicted' with the last velocity, or 'stopped'; or None.
        """
    @property
    def linear_velocity(self) -> _Doubles | None:
        """(3,) m/s of the camera since the frame before, in its axes; or None."""
    @property
    def angular_velocity(self) -> _Doubles | None:
        """(3,) rad/s, likewise; or None."""
    @property
    def objects(self) -> list[SeenObject]:
        """The objects that masks show in this frame: list of SeenObject."""

class System:
    """SLAM as one object: images in, poses and map out.

    Calls from several threads take turns. The global interpreter lock is released while a
    call works.
    """
    def __init__(self, settings: SettingsTable, mode: Literal["rgbd", "mono"] = "rgbd", *,
                 pipeline: Literal["sequential", "threaded", "realtime"] = "sequential",
                 vocabulary: _Path | None = "default", map: _Path | None = None,
                 session: str = "", localization: bool = False, seed: int = 0,
                 mask_all: npt.NDArray[np.bool_] | npt.NDArray[np.uint8] | None = None,
                 mask_all_right: npt.NDArray[np.bool_] | npt.NDArray[np.uint8] | None = None,
                 start_pose: _Doubles | None = None) -> None:
        """settings: Settings. mode: 'rgbd', 'mono' for a camera without depth, or 'stereo' for
        a rectified pair of cameras, whose left one the settings describe with Camera.bf.
        pipeline: 'sequential' gives the same bits every time; 'threaded' maps in a thread of
        its own; 'realtime' never waits for it, for live cameras.
        vocabulary: path of a vocabulary of visual words for loops and relocalisation;
        'default': the one that comes with HullSLAM; None: none.
        map: path of a map of earlier runs to go on with. session: the name of this run in
        the map. localization: True to find poses in `map` without changing it.
        seed: seed of all random choices.
        mask_all, mask_all_right: (height, width) bool or uint8, or None: pixels that are 0
        are ignored in all images, or in all right images of a stereo camera.
        start_pose: (4, 4) world_from_cam of the first image of a new map, m, or None: the
        world is the frame of this camera.
        """
    def track(self, image: _Image, depth: _Depth | None = None, masks: Masks | None = None, *,
              right: _Image | None = None, masks_right: Masks | None = None,
              timestamp: float, motion: _Doubles | None = None,
              motion_covariance: _Doubles | None = None) -> TrackResult:
        """Finds the pose of the camera in the next frame: TrackResult.

        image: (height, width) uint8, or (height, width, 3 or 4) with blue first, as OpenCV
        reads images (red first with the setting Camera.RGB). It is copied only if its rows
        are not contiguous, as in image[:, ::-1], and must not be changed meanwhile.
        depth: (height, width) uint16 in units of 1 / DepthMapFactor metres, or float32 in
        metres, registered to the image; 0 or not finite where it is not known. Only in the
        mode 'rgbd'.
        masks: Masks of the objects in the image, or None.
        right: the right image, as `image`, rectified with it. Only in the mode 'stereo'.
        masks_right: Masks of the objects in the right image, or None.
        timestamp: s, larger than in the frame before.
        motion: (4, 4) cam_from_last_cam since the frame before, m, by wheels or an inertial
        sensor, or None. Not in the mode 'mono'.
        motion_covariance: (6, 6) of its error (rotation in rad, translation in m, in the
        axes of the camera now): positive definite.
        Raises InputError for anything else, also for pairs that are swapped, the same or not
        rectified, and for float32 depth that cannot be metres; a refused frame changes
        nothing. Warns of input that can be used but hardly is what was meant.
        """
    def await_masks(self, is_on: bool) -> None:
        """From now on, frames that are tracked without masks await masks by add_masks(): a
        keyframe of such a frame says nothing about objects until then. reset() switches
        this off.
        """
    def add_masks(self, frame: int, masks: Masks) -> bool:
        """Adds the masks of a frame (TrackResult.frame) that were made after it was tracked, at
        most 2 s of time stamps later. If they show an object that is not mapped and no
        keyframe with masks is near in time, it becomes a keyframe unless it is one. Returns
        False for a frame that awaits no masks (any more).
        """
    def name_object(self, id: int, name: str) -> None:
        """Gives an object of the map (MapObject.id) a name of at most 100 bytes of UTF-8, which
        saved maps keep; '' removes it. May be called between two frames, also with a loaded
        map and with `localization`; with threads, the map shows it a little later. Raises
        InputError after finish(), for an unknown object and for another name.
        """
    def lock_object(self, id: int, locked: bool = True) -> None:
        """Locks an object: it keeps its shape, its place relative to the world around it and
        its id, whatever is seen; a candidate is mapped first. May be called and raises as
        name_object().
        """
    def set_object_size(self, id: int, longest_side: float) -> None:
        """Says how long the longest side of an object is, 0.001 to 100 m. Saved maps keep it; 0
        takes it back. A monocular map then gets the metre as its unit, as with
        objects.sizes, from this moment on if the object has been seen often enough. May be
        called and raises as name_object().
        """
    def delete_object(self, id: int) -> None:
        """Removes an object and its observations. Later masks of the thing may be mapped as a
        new object. May be called and raises as name_object().
        """
    def finish(self) -> None:
        """Waits until all keyframes are in the map, adjusts the whole map, and computes the
        poses of all frames again. Ctrl+C ends it early.
        """
    def reset(self) -> None:
        """Begins a new run as after construction, also after finish()."""
    def save_map(self, path: _Path) -> None:
        """Writes the map to a file (docs/maps.md), also during a run. Raises InputError if there
        is no keyframe yet or the file cannot be written.
        """
    def load_map(self, path: _Path, *, session: str = "", localization: bool = False) -> None:
        """Ends this run without finishing it and begins a new one that goes on with a map of
        earlier runs. Raises InputError if the map was made with other settings; then the
        run goes on.
        """
    @property
    def map(self) -> Map:
        """A snapshot: Map. It is empty before the first keyframe."""
    @property
    def trajectory(self) -> Trajectory:
        """The poses of all tracked frames in the current map: Trajectory."""
    @property
    def localization(self) -> bool:
        """Whether poses are found in the map without adding keyframes to it. May be switched
        between two frames, once there is a map.
        """
    @localization.setter
    def localization(self, arg1: bool) -> None: ...
    @property
    def times(self) -> dict[str, _Doubles]:
        """The durations of each stage, ms: dict of (calls,) arrays. `frame` is
        building a frame, `pose` tracking it, and `track` the sum of the two.
        """
    @property
    def object_counts(self) -> dict[str, Any]:
        """Numbers of detections and of frames with and without masks, and the
        numbers of rejected masks and objects by reason: dict.
        """

class KnownPoseMapper:
    """Maps objects from masks and known poses, for example of odometry or
    motion capture. It needs no images.
    """
    def __init__(self, settings: SettingsTable) -> None: ...
    def add_view(self, world_from_cam: npt.ArrayLike, masks: Masks, depth: _Depth | None = None, *,
                 timestamp: float) -> None:
        """Adds a view; a view should differ from the one before.

        world_from_cam: (4, 4) pose of the camera (x right, y down, z forward, m).
        masks: Masks of the image. depth: as in System.track(), or None.
        timestamp: s.
        Raises InputError for a pose that is not finite or no rigid transform, and for masks
        or depth that do not fit the camera; a refused view changes nothing.
        """
    @property
    def map(self) -> Map:
        """A snapshot of the views as keyframes, and of the objects: Map."""
    @property
    def warnings(self) -> list[str]:
        """What is odd about the views so far, such as poses in another unit than the depth:
        list of str.
        """

def preset_names() -> list[str]:
    """The names of the presets (docs/presets.md)."""
def default_settings(sequence: _Path) -> os.PathLike[str]:
    """The path of the settings file of a sequence: `camera.yaml` in its folder, else the file
    for the TUM camera that the name of the folder contains (fr1, freiburg2 ...). Raises
    InputError if there is neither.
    """
def evaluate_trajectory(groundtruth: Trajectory | _Path, estimate: Trajectory | _Path, *,
                        align: Literal["se3", "sim3", "none"] = "se3",
                        pairing: Literal["tum", "evo"] = "tum",
                        max_difference: float | None = None) -> TrajectoryErrors:
    """Measures the error of a trajectory, as `hullslam evaluate` does
    (docs/outputs.md).

    groundtruth, estimate: Trajectory, or path of a file in TUM's format.
    align: 'se3', 'sim3' (monocular) or 'none'.
    pairing: 'tum' or 'evo', the rule by which poses are paired by time.
    max_difference: largest difference of paired time stamps, s; None: by the
    rule, 0.02 or 0.01.
    Raises InputError if there are fewer than three pairs.
    """
def read_trajectory(path: _Path) -> Trajectory:
    """Reads a trajectory in TUM's format. Raises InputError with file and line for bad lines."""
def read_map(path: _Path) -> Map:
    """Reads a map to look at it. To go on with a map, give its path to System. Raises InputError
    if the file is damaged.
    """
def open_dataset(path: _Path, settings: _Path | None, mode: str | None, preset: str,
                 overrides: list[str],
                 choices: dict[str, str]) -> tuple[ImageSequence, SettingsTable]:
    """hullslam.open() without its conveniences."""
def open_tum(folder: _Path, settings: SettingsTable, *, depth: bool = True,
             associations: _Path | None = None) -> ImageSequence:
    """Opens a sequence in TUM's format (docs/datasets.md).

    depth: False for a monocular run, whose frames have no depth.
    associations: a file of pairs of images; None: they are paired by time.
    Raises InputError with file and line for whatever is wrong with the folder.
    """
def open_icl(folder: _Path, settings: SettingsTable, *, depth: bool = True) -> ImageSequence:
    """Opens a sequence of ICL-NUIM, with the settings of config/ICL.yaml.

    depth: False for a monocular run, whose frames have no depth.
    """
def open_euroc(folder: _Path, settings: SettingsTable) -> ImageSequence:
    """Opens the left camera of a sequence of EuRoC. Its settings are from
    Settings(folder / 'mav0/cam0/sensor.yaml').
    """
def open_run(folder: _Path) -> Run:
    """Opens the output folder of a finished run: Run. Raises InputError if there is none."""
def scene(source: _Path) -> dict[str, Any]:
    """The objects, relations and surfaces of a run (its folder) or of a saved map, as in
    scene.json (docs/scene.md): dict. Raises InputError for a run without masks.
    """
def report(source: _Path, output: _Path | None = None) -> pathlib.Path:
    """Writes the report of a run (its folder) or of a saved map, as `hullslam view --report` does.
    Returns its path.

    output: the file; None: report.html in the folder, or beside the map.
    """
def export(source: _Path, format: str, output: _Path, *,
           objects_as: Literal["ellipsoids", "boxes"] = "ellipsoids", text: bool = False,
           masked_classes: set[str] = ..., force: bool = False) -> str:
    """Writes a run (its folder) or a saved map in a format of other programs
    (docs/exports.md). Returns a text about what was written.

    format: such as 'colmap' or 'gltf'. output: the file or folder to write.
    objects_as: 'ellipsoids' or 'boxes' (gltf, ply). text: text files (colmap).
    masked_classes: left out of training (nerfstudio). force: replace what is there.
    Raises InputError if the run lacks something that the format needs.
    """
def open_stored_images(path: _Path) -> ImageSequence:
    """Opens the images of whatever is at a path, as hullslam segment does: a sequence of any
    kind, of a stereo camera its left images, a recording, a video or a folder. They come
    as they are stored, and without a camera: only `names`, `files` and `colour` can be used.
    """
def open_images(path: _Path, settings: SettingsTable, *, fps: float | None = None) -> ImageSequence:
    """Opens a video or a folder of images without depth. Frames of a video must be read
    in order.

    fps: frames per second; None: the time stamps of the video, 30 for a folder.
    """
def open_masks(path: _Path, sequence: ImageSequence, *, format: str = "") -> MaskFiles:
    """Opens masks in one of the formats of docs/masks.md: a folder or a JSON file.

    sequence: the ImageSequence that the masks belong to; their files are found by the
    names of its images. format: one of the names of docs/masks.md; detected if empty.
    """
