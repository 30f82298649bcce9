# SPDX-License-Identifier: GPL-3.0-or-later
# Written by scripts/generate_python_stubs.py.
import os
from typing import Any, Literal

from . import _core

_Path = str | os.PathLike[str]
_Values = dict[str, Any]

class _Camera:
    RGB: bool
    """colour images that the library receives from memory are RGB (else BGR) (true or false (1 or 0); default false)"""
    alpha: float
    """share of DoubleSphere and EUCM (a number from 0 to 1; default 0)"""
    beta: float
    """shape of EUCM (a number from 0.001 to 1000; default 1)"""
    bf: float
    """baseline of the virtual stereo camera (m) times fx (px) (a number from 0.001 to 1e+06; default 40)"""
    cx: float
    """principal point in x, px (a number from -1e+05 to 1e+05; default 0)"""
    cy: float
    """principal point in y, px (a number from -1e+05 to 1e+05; default 0)"""
    fps: float
    """frame rate of the camera, 1/s (a number > 0; default 30)"""
    fx: float
    """focal length in x, px (a number from 10 to 1e+05; default 0)"""
    fy: float
    """focal length in y, px (a number from 10 to 1e+05; default 0)"""
    height: int
    """height of the images, px (an integer from 16 to 16384; default 480)"""
    k1: float
    """radial distortion, second order (a number of any size; default 0)"""
    k2: float
    """radial distortion, fourth order (a number of any size; default 0)"""
    k3: float
    """radial distortion, sixth order (a number of any size; default 0)"""
    k4: float
    """radial divisor; the fourth of a fisheye (a number of any size; default 0)"""
    k5: float
    """radial divisor (a number of any size; default 0)"""
    k6: float
    """radial divisor (a number of any size; default 0)"""
    p1: float
    """tangential distortion (a number of any size; default 0)"""
    p2: float
    """tangential distortion (a number of any size; default 0)"""
    readout_direction: Literal["rows", "columns"]
    """rolling shutter: an image is exposed row after row or column after column (one of: rows, columns; default rows)"""
    readout_time: float
    """rolling shutter: time from the top row of an image to the bottom row (columns: from left to right), s; negative: the other way round; 0: all at once (a number from -0.1 to 0.1; default 0)"""
    type: Literal["PinHole", "KannalaBrandt8", "DoubleSphere", "EUCM"]
    """lens (one of: PinHole, KannalaBrandt8, DoubleSphere, EUCM; default PinHole)"""
    width: int
    """width of the images, px (an integer from 16 to 16384; default 640)"""
    xi: float
    """distance of the spheres of DoubleSphere (a number from -0.9 to 1; default 0)"""

class _ORBextractor:
    iniThFAST: int
    """FAST threshold, grey levels (an integer from 1 to 255; default 20)"""
    keepEdges: bool
    """monocular: keep features on straight edges, which look alike along the edge (true or false (1 or 0); default false)"""
    minThFAST: int
    """FAST threshold in regions without corners at the first threshold, grey levels (an integer from 1 to 255; default 7)"""
    nFeatures: int
    """number of features to extract from an image; without this key, more than 1000 if the image is larger or smaller than 640x480 px (an integer from 1 to 50000; default 1000)"""
    nLevels: int
    """number of levels of the image pyramid; without this key, more than 8 if the image is larger than 640x480 px, and fewer if it is too small for them (an integer from 1 to 16; default 8)"""
    scaleFactor: float
    """ratio of the sizes of neighbouring levels of the image pyramid (a number above 1 to 2; default 1.2)"""
    subpixel: bool
    """refine the positions of features within a pixel of their level (true or false (1 or 0); default true)"""

class _depth:
    adjustment_pixel_sigma: float
    """error of a keypoint of pyramid level 0 in bundle adjustment, px (a number from 0.01 to 100; default 0.8)"""
    adjustment_rule: Literal["hullslam", "orb_slam2"]
    """weights and loss of keypoints without depth in bundle adjustment: measured precision and Cauchy's loss, or fixed sigmas and Huber's loss (one of: hullslam, orb_slam2; default hullslam)"""
    disparity_offset: float
    """disparity of depth images minus the true one, px (a number from -20 to 20; default 0)"""
    disparity_sigma: float
    """error of a depth, as an error of the disparity Camera.bf / depth, px (a number from 0.01 to 100; default 1)"""
    model: Literal["disparity", "right_column"]
    """error of a keypoint with depth: pixel and disparity have independent errors, or both columns of a stereo camera have the error of the keypoint (one of: disparity, right_column; default disparity)"""
    pixel_sigma: float
    """error of a keypoint of pyramid level 0 in tracking and mapping, px (a number from 0.01 to 100; default 0.56)"""
    shift_x: float
    """translation from colour to registered depth images, m (a number from -0.2 to 0.2; default 0)"""
    shift_y: float
    """translation from colour to registered depth images, m (a number from -0.2 to 0.2; default 0)"""
    shift_z: float
    """translation from colour to registered depth images, m (a number from -0.2 to 0.2; default 0)"""
    time_offset: float
    """depth images are taken so much later than their stamps say, s (a number from -0.2 to 0.2; default 0)"""
    turn_x: float
    """rotation from colour to registered depth images, rad (a number from -0.2 to 0.2; default 0)"""
    turn_y: float
    """rotation from colour to registered depth images, rad (a number from -0.2 to 0.2; default 0)"""
    turn_z: float
    """rotation from colour to registered depth images, rad (a number from -0.2 to 0.2; default 0)"""

class _loop:
    closing: bool
    """close loops when the camera comes back to a known place; needs a vocabulary (true or false (1 or 0); default true)"""
    drift_base: float
    """a loop may always move the camera by this, m; without depth, the median depth of the scene counts as a metre (a number >= 0; default 0.2)"""
    global_adjustment: bool
    """adjust the whole map after a loop was closed (true or false (1 or 0); default true)"""
    min_landmarks: int
    """number of landmarks around the candidate that the query must find (an integer >= 4; default 40)"""
    min_matches: int
    """number of landmarks that must agree between query and candidate (an integer >= 4; default 20)"""
    min_supporters: int
    """if fewer neighbours of the query look like the candidate's place, twice as many landmarks are needed (an integer >= 0; default 2)"""
    object_votes: bool
    """mapped objects at both ends speak for or against a loop (true or false (1 or 0); default true)"""
    turn_base: float
    """a loop may always turn the camera by this, radians (a number >= 0; default 0.1)"""

class _mapping:
    compact_keyframes: bool
    """remove keypoints that show no landmark from keyframes far from the newest one (true or false (1 or 0); default true)"""
    cull_keyframes: bool
    """remove redundant keyframes (true or false (1 or 0); default true)"""
    culling_rule: Literal["hullslam", "orb_slam2"]
    """which keyframes are redundant: also observations of objects, far landmarks and directions count, or the rule of ORB-SLAM2 (one of: hullslam, orb_slam2; default hullslam)"""
    final_bundle_adjustment: bool
    """run a global bundle adjustment once at the end of the run (true or false (1 or 0); default true)"""
    fixed_keyframes: int
    """largest number of fixed keyframes in local bundle adjustment; 0: all that observe its landmarks (an integer >= 0; default 0)"""
    landmark_rule: Literal["hullslam", "orb_slam2"]
    """which keypoints become landmarks: all with depth and pairs whose expected parallax is large enough, or those that are near or whose own parallax is large enough, as in ORB-SLAM2 (one of: hullslam, orb_slam2; default hullslam)"""
    local_keyframes: int
    """largest number of keyframes that local bundle adjustment moves (an integer >= 2; default 20)"""
    max_keyframes: int
    """largest number of keyframes in the map; 0: no bound. Those go first of which others see most, none that connects places or that an object needs (an integer >= 0; default 0)"""

class _objects_association:
    measure: Literal["combined", "class_overlap", "wasserstein"]
    """how detections and objects are compared (docs/objects.md) (one of: combined, class_overlap, wasserstein; default combined)"""

class _objects_bundle:
    depth_points: int
    """largest number of depth points that are used per detection; 0: none (an integer from 0 to 10000; default 6)"""
    loss: Literal["none", "huber", "cauchy", "tukey"]
    """robust loss of each residual (one of: none, huber, cauchy, tukey; default tukey)"""
    loss_scale: float
    """scale of the robust loss, in standard deviations (a number from 0.1 to 1000; default 6)"""
    max_effective_lines: float
    """largest number of effective lines per detection (a number from 0 to 1000; default 8)"""
    max_outer_views: int
    """largest number of keyframes outside the window that constrain an object (an integer from 0 to 10000; default 5)"""
    min_loss_px: float
    """least scale of the robust loss, px (a number from 0 to 1000; default 15)"""
    misfit_factor: float
    """factor of the misfit of the object in the standard deviation of a line (a number from 0 to 100; default 2)"""
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    """residual that is minimised between a quadric and a detection (one of: tangent, algebraic_plane, relative_plane, algebraic_point, distribution, overlap, bhattacharyya, box_bounds, filtered_point; default tangent)"""
    sigma: float
    """standard deviation of a line, in addition to the misfit of the object, px (a number from 0.001 to 1000; default 0.5)"""
    sigma_unit: Literal["pixels", "residual"]
    """unit of sigma: pixels, which are converted for the size and distance of each object, or that of the residual, which has no misfit (one of: pixels, residual; default pixels)"""

class _objects_changes:
    max_found_ratio: float
    """an object is gone or new if it is found in a smaller share of the keyframes that should show it (a number from 0 to 1; default 0.2)"""
    max_move: float
    """an object is taken for one that was moved only up to this distance, m (a number from 0 to 1e+06; default 4)"""
    min_keyframes: int
    """keyframes that should show an object before it is called gone or new (an integer from 1 to 1e+06; default 3)"""

class _objects_culling:
    max_hidden: float
    """a keyframe should show an object only if at most this share of it is hidden (a number from 0 to 1; default 0.3)"""
    max_range: float
    """a keyframe should show an object only up to this many times the largest distance at which the object was observed (a number from 0 to 1000; default 1.25)"""
    min_found_ratio: float
    """a mapped object is removed if it is found in a smaller share of the keyframes that should show it (a number from 0 to 1; default 0.25)"""

class _objects_detection:
    border_px: float
    """a line that touches its mask only within this distance of the border of the image is one-sided, px (a number from 0 to 1000; default 5)"""
    duplicate_class_iou: float
    """two outlines of one class with at least this IoU are the same object, if the depth of either is not known (a number from 0.1 to 1; default 0.25)"""
    duplicate_iou: float
    """two masks of a frame with at least this IoU are the same object (a number from 0.1 to 1; default 0.6)"""
    epsilon_px: float
    """tolerance for simplifying the hull or contour, px (a number from 0 to 100; default 3)"""
    max_area_share: float
    """masks whose hull covers a larger share of the image are rejected (a number from 0 to 1; default 0.5)"""
    max_depth_offset: float
    """depth points farther than this from the median depth of their mask are left out, as a share of the larger side of the mask at that depth (a number from 0 to 1000; default 0.75)"""
    min_area_px2: float
    """masks whose hull has a smaller area are rejected, px^2 (a number from 0 to 1e+08; default 0)"""
    min_keypoints: int
    """masks that contain fewer keypoints are rejected (an integer from 0 to 10000; default 0)"""
    min_score: float
    """masks with a lower score are rejected (a number from 0 to 1; default 0)"""
    min_side_px: float
    """masks with a smaller width or height are rejected, px (a number from 0 to 10000; default 10)"""
    occlusion_step: float
    """something that is nearer than an object by less than this does not hide it, m (a number from 0 to 100; default 0.03)"""
    occlusion_step_share: float
    """something that is nearer than an object by less than this does not hide it, as a share of its depth (a number from 0 to 1; default 0.04)"""
    primitive: Literal["support", "hull", "contour", "bbox", "conic", "box_ellipse"]
    """what the lines of a detection are made from (one of: support, hull, contour, bbox, conic, box_ellipse; default support)"""
    uniform_directions: int
    """number of evenly spread directions of support lines, in addition to those of the edges of the hull (an integer from 0 to 64; default 8)"""

class _objects_fusion:
    min_overlap: float
    """two objects that were never seen together are fused if the IoU of their volumes is at least this (a number from 0 to 1; default 0.25)"""

class _objects_pose:
    loss: Literal["none", "huber", "cauchy", "tukey"]
    """robust loss of each residual (one of: none, huber, cauchy, tukey; default cauchy)"""
    loss_scale: float
    """scale of the robust loss, in standard deviations (a number from 0.1 to 1000; default 2.5)"""
    max_effective_lines: float
    """largest number of effective lines per detection (a number from 0 to 1000; default 8)"""
    misfit_factor: float
    """factor of the misfit of the object in the standard deviation of a line (a number from 0 to 100; default 1)"""
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    """residual that is minimised between a quadric and a detection (one of: tangent, algebraic_plane, relative_plane, algebraic_point, distribution, overlap, bhattacharyya, box_bounds, filtered_point; default tangent)"""
    sigma: float
    """standard deviation of a line, in addition to the misfit of the object, px (a number from 0.001 to 1000; default 0.5)"""
    sigma_unit: Literal["pixels", "residual"]
    """unit of sigma: pixels, which are converted for the size and distance of each object, or that of the residual, which has no misfit (one of: pixels, residual; default pixels)"""

class _objects_refinement:
    depth_points: int
    """largest number of depth points that are used per detection; 0: none (an integer from 0 to 10000; default 20)"""
    loss: Literal["none", "huber", "cauchy", "tukey"]
    """robust loss of each residual (one of: none, huber, cauchy, tukey; default huber)"""
    max_effective_lines: float
    """largest number of effective lines per detection (a number from 0.1 to 1000; default 4)"""
    max_misfit_px: float
    """largest standard deviation of a line when a quadric is refined, px (a number from 0.1 to 100; default 5)"""
    max_views: int
    """largest number of keyframes that are used to refine a quadric (an integer from 2 to 10000; default 20)"""
    min_misfit_px: float
    """least standard deviation of a line when a quadric is refined, px (a number from 0.1 to 100; default 1)"""
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    """residual that is minimised between a quadric and a detection (one of: tangent, algebraic_plane, relative_plane, algebraic_point, distribution, overlap, bhattacharyya, box_bounds, filtered_point; default tangent)"""

class _objects_start:
    inflation: float
    """half axes of the start of a quadric in relation to those of the box of its points (a number from 0.5 to 3; default 1.2)"""
    method: Literal["fitted", "oriented_box", "box_planes", "ray_sphere", "single_view"]
    """how the first quadric of an object is made (docs/objects.md) (one of: fitted, oriented_box, box_planes, ray_sphere, single_view; default fitted)"""
    min_parallax: float
    """least angle between rays that an object with depth needs to be mapped, degrees (a number from 0 to 180; default 1)"""
    min_parallax_without_depth: float
    """least angle between rays that an object without depth needs to be mapped, degrees (a number from 0 to 180; default 15)"""
    min_views: int
    """number of keyframes that must observe an object before it is mapped (an integer from 1 to 1000; default 3)"""

class _objects_validity:
    max_elongation: float
    """a mapped object that is longer along its rays than across them by a larger factor needs more parallax (a number from 1 to 1000; default 1.5)"""
    max_misfit: float
    """largest RMS distance of the outlines of a mapped object from its projected ellipses, as a share of the size of its masks (a number from 0 to 100; default 0.25)"""
    max_stretch: float
    """largest ratio of a half axis of a mapped object to the extent of its depth points along it (a number from 1 to 1000; default 2.5)"""
    min_overlap: float
    """least mean IoU of projected ellipse and hull for a mapped object (a number from 0 to 1; default 0.6)"""
    min_points_near: float
    """least share of depth points inside or near a mapped object (a number from 0 to 1; default 0.4)"""

class _objects:
    @property
    def association(self) -> _objects_association: ...
    @association.setter
    def association(self, values: _Values) -> None: ...
    @property
    def bundle(self) -> _objects_bundle: ...
    @bundle.setter
    def bundle(self, values: _Values) -> None: ...
    bundle_adjustment: bool
    """adjust quadrics together with poses and landmarks (true or false (1 or 0); default true)"""
    @property
    def changes(self) -> _objects_changes: ...
    @changes.setter
    def changes(self, values: _Values) -> None: ...
    @property
    def culling(self) -> _objects_culling: ...
    @culling.setter
    def culling(self, values: _Values) -> None: ...
    depth_sigma: float
    """standard deviation of the distance of depth points from the surface of a quadric, m (a number from 0.001 to 100; default 0.1)"""
    @property
    def detection(self) -> _objects_detection: ...
    @detection.setter
    def detection(self, values: _Values) -> None: ...
    enabled: bool
    """map objects from their masks (true or false (1 or 0); default true)"""
    @property
    def fusion(self) -> _objects_fusion: ...
    @fusion.setter
    def fusion(self, values: _Values) -> None: ...
    guided_matching: bool
    """search landmarks on mapped objects that are not in the local map, inside the hulls of their detections (true or false (1 or 0); default true)"""
    joint_pose: bool
    """mapped objects constrain the pose of each frame (true or false (1 or 0); default true)"""
    max_effective_lines: float
    """largest number of effective lines per detection, in joint pose and bundle adjustment (a number from 0 to 1000; default 8)"""
    misfit_compensation: bool
    """correct lines by the excess that other keyframes measured (true or false (1 or 0); default true)"""
    @property
    def pose(self) -> _objects_pose: ...
    @pose.setter
    def pose(self, values: _Values) -> None: ...
    prior_sigma: float
    """standard deviation of the log half axes in the prior about a quadric (a number from 0.01 to 100; default 0.5)"""
    prior_sigma_without_depth: float
    """standard deviation of the log half axes in the prior about a quadric, for an object without depth (a number from 0.01 to 100; default 0.15)"""
    @property
    def refinement(self) -> _objects_refinement: ...
    @refinement.setter
    def refinement(self, values: _Values) -> None: ...
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    """residual that is minimised between a quadric and a detection (one of: tangent, algebraic_plane, relative_plane, algebraic_point, distribution, overlap, bhattacharyya, box_bounds, filtered_point; default tangent)"""
    sigma: float
    """standard deviation of a line in joint pose and bundle adjustment, in addition to the misfit of the object, px (a number from 0.001 to 1000; default 0.5)"""
    sizes: dict[str, float]
    """longest side of objects by class, m; a monocular run gets its scale from objects of known size (name:number pairs, separated by commas, each number from 0.001 to 20; default )"""
    @property
    def start(self) -> _objects_start: ...
    @start.setter
    def start(self, values: _Values) -> None: ...
    @property
    def validity(self) -> _objects_validity: ...
    @validity.setter
    def validity(self, values: _Values) -> None: ...

class _odometry:
    sigma_turn: float
    """standard deviation of a step of --odometry, as a share of its rotation (a number from 0 to 1; default 0.02)"""
    sigma_way: float
    """standard deviation of a step of --odometry, as a share of its length (a number from 0 to 1; default 0.02)"""

class _run:
    max_lost_at_end: float
    """the run fails (exit code 1) if no frame of a longer time at its end has a pose, s (a number >= 0; default 1)"""
    max_lost_share: float
    """the run fails (exit code 1) if a larger share of its frames has no pose (a number from 0 to 1; default 0.1)"""

class _tracking:
    begin_islands: bool
    """a camera that stays lost begins a new part of the map; if not, only while the map has at most five keyframes (true or false (1 or 0); default true)"""
    correct_shutter: bool
    """correct the rolling shutter that Camera.readout_time describes; if not, the readout time counts as 0 (true or false (1 or 0); default true)"""
    dynamic_classes: str
    """classes of dynamic objects, separated by commas; they are not mapped, and keypoints on their masks are removed (text; default person)"""
    keyframe_interval: float
    """least time between keyframes, unless tracking weakens abruptly, s; in the rule orb_slam2 the time in which the mapper is busy with a keyframe (a number from 0 to 60; default 0.2)"""
    keyframe_rule: Literal["hullslam", "orb_slam2"]
    """when a frame becomes a keyframe: evenly in time, or by the rule of ORB-SLAM2 (one of: hullslam, orb_slam2; default hullslam)"""
    keyframes_for_objects: bool
    """objects that are not mapped yet are a reason for a keyframe (rule hullslam only) (true or false (1 or 0); default true)"""
    local_keyframes: int
    """largest number of keyframes whose landmarks form the local map (an integer >= 1; default 80)"""
    locate_at_end: bool
    """look for early and lost frames in the map at the end of the run (true or false (1 or 0); default true)"""
    min_initial_points: int
    """number of keypoints with depth that the first frame needs (an integer >= 10; default 50)"""
    min_inliers: int
    """number of landmarks that must be found in a frame; with fewer it is lost (an integer >= 6; default 30)"""
    refine_at_end: bool
    """compute the poses of frames again at the end of the run, from the landmarks and objects that were found in them (true or false (1 or 0); default true)"""
    relocalise_by_objects: bool
    """find a lost frame by the arrangement of the mapped objects in it (needs masks) (true or false (1 or 0); default true)"""
    relocalise_by_words: bool
    """find a lost frame by keyframes that look like it (needs a vocabulary) (true or false (1 or 0); default true)"""
    remove_dynamic: bool
    """remove the keypoints on the masks of dynamic classes (true or false (1 or 0); default true)"""
    wide_matches: bool
    """a lost frame is also sought by matches without words or a prediction, as in recordings whose images are far apart (without depth, two pairs of images must agree with its rotation); at the end, lost frames and parts of the map are joined in the same way (true or false (1 or 0); default true)"""
    wide_search: bool
    """search windows grow with the width of the image and, if needed, up to the expected motion; if not, they double once (true or false (1 or 0); default true)"""


class Settings(_core.SettingsTable):
    """All settings of a run.

        settings = Settings("TUM1.yaml", objects={"start": {"min_views": 4}}, ORBextractor={"nFeatures": 1500})
        settings.objects.detection.min_score = 0.5
        settings["tracking.min_inliers"]

    file: a settings file of HullSLAM, ORB-SLAM2 or ORB-SLAM3. Without it, Camera must have the
        intrinsics: Camera={"fx": 517.3, "fy": 516.5, "cx": 318.6, "cy": 255.3}.
    preset: the name or file of a preset (preset_names()).
    Keyword arguments: groups of settings as dicts, or single settings, which replace those of the
        preset and of the file. dict keys may have several words: {"objects.start.min_views": 4}.

    Raises InputError that names the file, line, key and value, and what was expected.
    """
    def __init__(self, file: _Path | None = None, *, preset: _Path | None = None,
                 **values: Any) -> None: ...
    def __getitem__(self, key: str) -> Any: ...
    def __setitem__(self, key: str, value: Any) -> None: ...
    def describe(self, key: str) -> str:
        """The meaning of a setting, and the values that it may have."""
    def summary(self, *, changed_only: bool = False) -> str:
        """All settings as text, one line each. Those that differ from the default say so."""
    def write(self, path: _Path) -> None:
        """Writes all settings to a file that Settings() reads."""
    @property
    def Camera(self) -> _Camera: ...
    @Camera.setter
    def Camera(self, values: _Values) -> None: ...
    DepthMapFactor: float
    """units of the 16-bit depth images per metre (a number from 0.001 to 1e+06; default 5000)"""
    @property
    def ORBextractor(self) -> _ORBextractor: ...
    @ORBextractor.setter
    def ORBextractor(self, values: _Values) -> None: ...
    ThDepth: float
    """largest distance of a close point, in units of the baseline (a number from 0.001 to 1e+06; default 40)"""
    @property
    def depth(self) -> _depth: ...
    @depth.setter
    def depth(self, values: _Values) -> None: ...
    @property
    def loop(self) -> _loop: ...
    @loop.setter
    def loop(self, values: _Values) -> None: ...
    @property
    def mapping(self) -> _mapping: ...
    @mapping.setter
    def mapping(self, values: _Values) -> None: ...
    @property
    def objects(self) -> _objects: ...
    @objects.setter
    def objects(self, values: _Values) -> None: ...
    @property
    def odometry(self) -> _odometry: ...
    @odometry.setter
    def odometry(self, values: _Values) -> None: ...
    @property
    def run(self) -> _run: ...
    @run.setter
    def run(self, values: _Values) -> None: ...
    @property
    def tracking(self) -> _tracking: ...
    @tracking.setter
    def tracking(self, values: _Values) -> None: ...
