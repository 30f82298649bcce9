// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/known_pose_mapper.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "camera/fit_depth.h"
#include "frame/depth_source.h"
#include "frame/detection/frame_detector.h"
#include "frame/detection/mask_region.h"
#include "frame/input_check.h"
#include "hullslam/util/check.h"
#include "map/keyframe_graph.h"
#include "objects/object_mapper.h"
#include "system/finish_run.h"
#include "system/make_sensor.h"
#include "system/pose_scale_check.h"
#include "util/text.h"

namespace hullslam {
struct KnownPoseMapper::State {
  explicit State(const SystemOptions& options)
      : sensor(MakeSensor(options)),
        detector(sensor, options.depth, options.objects.detection,
                 SplitNames(options.tracking.dynamic_classes)),
        mapper(sensor, options.objects),
        check(sensor, options.depth),
        units_per_metre(options.depth.units_per_metre) {}

  Sensor sensor;
  FrameDetector detector;
  ObjectMapper mapper;
  InputCheck check;
  PoseScaleCheck scale;
  double units_per_metre;  // of depth images
  Map map;
  DetectionCounts masks;
};

KnownPoseMapper::KnownPoseMapper(const SystemOptions& options)
    : state_(std::make_unique<State>(options)) {}

KnownPoseMapper::~KnownPoseMapper() = default;

void KnownPoseMapper::AddView(double timestamp, const Rigid3& world_from_cam,
                              std::vector<InstanceMask> masks, const cv::Mat& given_depth) {
  State& state = *state_;
  Check(std::isfinite(timestamp), "the time stamp is not a number");
  Check(world_from_cam.translation.allFinite() && world_from_cam.rotation.coeffs().allFinite(),
        "the pose is not finite");
  const PinholeCamera& camera = state.sensor.camera;
  ValidateMasks(masks, camera.width, camera.height);
  if (!given_depth.empty()) {
    CheckDepthImage(given_depth, camera);
    state.check.CheckDepth(given_depth);
  }
  const cv::Mat depth = FitDepth(given_depth, {camera.width, camera.height});
  SerialRunner runner;
  BuiltFrame built{.frame = std::make_unique<Frame>(), .masks = {}, .begin = {}};
  built.frame->id = FrameId(state.map.keyframes().NextId().value);
  built.frame->timestamp = timestamp;
  built.masks.frames_with_masks = masks.empty() ? 0 : 1;
  built.frame->depth = DepthGrid(depth, state.units_per_metre);
  state.detector.AddDetections(masks, depth, {}, runner, built);
  state.masks.Add(built.masks);
  state.scale.Add(built.frame->detections, world_from_cam);
  const KeyframeId added = state.map.AddKeyframe(std::move(built.frame), Inverse(world_from_cam));
  if (added != KeyframeId(0)) {
    SetParent(state.map, added, KeyframeId(0));  // the tree of an island has one root
  }
  state.mapper.Process(state.map, added);
}

const Map& KnownPoseMapper::map() const { return state_->map; }

Map KnownPoseMapper::Snapshot() { return state_->map.Snapshot(); }

std::vector<std::string> KnownPoseMapper::warnings() const {
  // The centre of what is seen of a thing is not its centre, so the scale is known roughly.
  constexpr double kMost = 1.5;
  std::vector<std::string> warnings = state_->check.warnings();
  const std::optional<double> scale = state_->scale.Scale();
  if (scale && (*scale > kMost || *scale < 1.0 / kMost)) {
    warnings.push_back(fmt::format(
        "the depth images say that the camera has moved {:.2g} times as far as the poses say; are "
        "the poses those of a monocular run, or is DepthMapFactor wrong? Hardly any object is "
        "mapped then: scale the poses, or map without the depth (--without-depth)",
        *scale));
  }
  return warnings;
}

ObjectCounts KnownPoseMapper::counts() const {
  return CountObjects(state_->masks, state_->map.keyframes().size(), state_->mapper.rejections());
}

}  // namespace hullslam
