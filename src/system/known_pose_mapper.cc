// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/known_pose_mapper.h"

#include <set>
#include <string>
#include <utility>

#include "frame/detection_builder.h"
#include "frame/dynamic_mask.h"
#include "objects/object_mapper.h"

namespace hullslam {
namespace {

Sensor SensorOfViews(const SystemOptions& options) {
  options.Validate();
  Sensor sensor;
  sensor.camera = options.camera;
  sensor.bounds = options.camera.UndistortedBounds();
  return sensor;
}

}  // namespace

struct KnownPoseMapper::State {
  explicit State(const SystemOptions& options)
      : sensor(SensorOfViews(options)),
        dynamic_classes(SplitNames(options.tracking.dynamic_classes)),
        builder(options.camera, options.depth.units_per_metre, options.objects.detection),
        mapper(sensor, options.objects) {}

  Sensor sensor;
  std::set<std::string> dynamic_classes;
  DetectionBuilder builder;
  ObjectMapper mapper;
  Map map;
  ObjectCounts counts;
};

KnownPoseMapper::KnownPoseMapper(const SystemOptions& options)
    : state_(std::make_unique<State>(options)) {}

KnownPoseMapper::~KnownPoseMapper() = default;

void KnownPoseMapper::AddView(double timestamp, const Rigid3& world_from_cam,
                              std::vector<InstanceMask> masks, const cv::Mat& depth) {
  State& state = *state_;
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(state.map.keyframes().NextId().value);
  frame->timestamp = timestamp;
  std::erase_if(
      masks, [&](const InstanceMask& mask) { return state.dynamic_classes.contains(mask.label); });
  DetectionResult result = state.builder.Build(masks, depth, {});
  for (const auto& rejection : result.rejections) {
    if (rejection) {
      ++state.counts.rejections["mask_" + ToString(*rejection)];
    }
  }
  state.counts.detections += result.detections.size();
  frame->detections = std::move(result.detections);
  state.mapper.Process(state.map, state.map.AddKeyframe(std::move(frame), Inverse(world_from_cam)));
}

const Map& KnownPoseMapper::map() const { return state_->map; }

ObjectCounts KnownPoseMapper::counts() const {
  ObjectCounts counts = state_->counts;
  for (const auto& [reason, count] : state_->mapper.rejections()) {
    counts.rejections[ToString(reason)] = count;
  }
  return counts;
}

}  // namespace hullslam
