# SPDX-License-Identifier: GPL-3.0-or-later
# Written by scripts/generate_python_stubs.py.
import os
from typing import Any, Literal

from . import _core

_Path = str | os.PathLike[str]
_Values = dict[str, Any]

class _Camera:
    RGB: bool
    bf: float
    cx: float
    cy: float
    fps: float
    fx: float
    fy: float
    height: int
    k1: float
    k2: float
    k3: float
    p1: float
    p2: float
    readout_direction: Literal["rows", "columns"]
    readout_time: float
    width: int

class _ORBextractor:
    iniThFAST: int
    minThFAST: int
    nFeatures: int
    nLevels: int
    scaleFactor: float
    subpixel: bool

class _depth:
    adjustment_pixel_sigma: float
    adjustment_rule: Literal["hullslam", "orb_slam2"]
    disparity_sigma: float
    model: Literal["disparity", "right_column"]
    pixel_sigma: float

class _loop:
    closing: bool
    drift_base: float
    drift_per_metre: float
    global_adjustment: bool
    min_landmarks: int
    min_matches: int
    min_supporters: int
    object_votes: bool
    turn_base: float

class _mapping:
    compact_keyframes: bool
    cull_keyframes: bool
    culling_rule: Literal["hullslam", "orb_slam2"]
    final_bundle_adjustment: bool
    fixed_keyframes: int
    landmark_rule: Literal["hullslam", "orb_slam2"]
    local_keyframes: int

class _objects_association:
    centroid_weight: float
    class_weight: float
    cloud_weight: float
    iou_weight: float
    landmark_weight: float
    measure: Literal["combined", "class_overlap", "wasserstein"]
    min_carried_iou: float
    min_depth_iou: float
    min_projection_iou: float
    min_shared_ratio: float
    min_similarity: float

class _objects_bundle:
    depth_points: int
    loss: Literal["none", "huber", "cauchy", "tukey"]
    loss_scale: float
    max_effective_lines: float
    max_outer_views: int
    min_loss_px: float
    misfit_factor: float
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    sigma: float
    sigma_unit: Literal["pixels", "residual"]

class _objects_changes:
    max_found_ratio: float
    max_move: float
    min_keyframes: int

class _objects_culling:
    max_hidden: float
    max_range: float
    min_found_ratio: float
    min_visible: int

class _objects_detection:
    border_px: float
    duplicate_class_iou: float
    duplicate_iou: float
    epsilon_px: float
    fragment_inside: float
    max_area_share: float
    max_depth_offset: float
    max_depth_points: int
    min_area_px2: float
    min_keypoints: int
    min_line_px: float
    min_score: float
    min_side_px: float
    occlusion_step: float
    occlusion_step_share: float
    primitive: Literal["support", "hull", "contour", "bbox", "conic", "box_ellipse"]
    uniform_directions: int

class _objects_fusion:
    min_overlap: float
    min_overlap_together: float

class _objects_pose:
    loss: Literal["none", "huber", "cauchy", "tukey"]
    loss_scale: float
    max_effective_lines: float
    misfit_factor: float
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    sigma: float
    sigma_unit: Literal["pixels", "residual"]

class _objects_refinement:
    depth_points: int
    landmark_sigma: float
    loss: Literal["none", "huber", "cauchy", "tukey"]
    loss_px: float
    max_effective_lines: float
    max_misfit_px: float
    max_views: int
    min_misfit_px: float
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]

class _objects_start:
    inflation: float
    method: Literal["fitted", "oriented_box", "box_planes", "ray_sphere", "single_view"]
    min_parallax: float
    min_parallax_without_depth: float
    min_views: int
    trimmed: float

class _objects_validity:
    max_elongation: float
    max_half_axis: float
    max_misfit: float
    max_stretch: float
    min_overlap: float
    min_points_near: float

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
    @property
    def changes(self) -> _objects_changes: ...
    @changes.setter
    def changes(self, values: _Values) -> None: ...
    @property
    def culling(self) -> _objects_culling: ...
    @culling.setter
    def culling(self, values: _Values) -> None: ...
    depth_sigma: float
    @property
    def detection(self) -> _objects_detection: ...
    @detection.setter
    def detection(self, values: _Values) -> None: ...
    enabled: bool
    @property
    def fusion(self) -> _objects_fusion: ...
    @fusion.setter
    def fusion(self, values: _Values) -> None: ...
    guided_matching: bool
    joint_pose: bool
    max_effective_lines: float
    misfit_compensation: bool
    @property
    def pose(self) -> _objects_pose: ...
    @pose.setter
    def pose(self, values: _Values) -> None: ...
    prior_sigma: float
    prior_sigma_without_depth: float
    @property
    def refinement(self) -> _objects_refinement: ...
    @refinement.setter
    def refinement(self, values: _Values) -> None: ...
    residual: Literal["tangent", "algebraic_plane", "relative_plane", "algebraic_point", "distribution", "overlap", "bhattacharyya", "box_bounds", "filtered_point"]
    sigma: float
    sizes: dict[str, float]
    @property
    def start(self) -> _objects_start: ...
    @start.setter
    def start(self, values: _Values) -> None: ...
    @property
    def validity(self) -> _objects_validity: ...
    @validity.setter
    def validity(self, values: _Values) -> None: ...

class _run:
    max_lost_at_end: float
    max_lost_share: float

class _tracking:
    begin_islands: bool
    correct_shutter: bool
    dynamic_classes: str
    keyframe_interval: float
    keyframe_ratio: float
    keyframe_rule: Literal["hullslam", "orb_slam2"]
    local_keyframes: int
    locate_at_end: bool
    min_initial_points: int
    min_inliers: int
    refine_at_end: bool
    relocalise_by_objects: bool
    relocalise_by_words: bool
    remove_dynamic: bool
    wide_search: bool


class Settings(_core.SettingsTable):
    def __init__(self, file: _Path | None = None, *, preset: _Path | None = None,
                 **values: Any) -> None: ...
    def __getitem__(self, key: str) -> Any: ...
    def __setitem__(self, key: str, value: Any) -> None: ...
    def describe(self, key: str) -> str: ...
    def summary(self, *, changed_only: bool = False) -> str: ...
    def write(self, path: _Path) -> None: ...
    @property
    def Camera(self) -> _Camera: ...
    @Camera.setter
    def Camera(self, values: _Values) -> None: ...
    DepthMapFactor: float
    @property
    def ORBextractor(self) -> _ORBextractor: ...
    @ORBextractor.setter
    def ORBextractor(self, values: _Values) -> None: ...
    ThDepth: float
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
    def run(self) -> _run: ...
    @run.setter
    def run(self, values: _Values) -> None: ...
    @property
    def tracking(self) -> _tracking: ...
    @tracking.setter
    def tracking(self, values: _Values) -> None: ...
