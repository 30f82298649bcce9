// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/frame_detector.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/polygon.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// The disparity at the median depth of the points on the object; 0 if there are none.
double DisparityOf(const Detection& left, const PinholeCamera& camera) {
  std::vector<double> depths;
  for (const Eigen::Vector3d& point : left.points.Unpack()) {
    depths.push_back(point.z());
  }
  return depths.empty() ? 0.0 : camera.bf / Median(std::move(depths));
}

// The IoU of the two hulls after the shift; 0 for different labels and for an object that would be
// farther away than infinity.
double Overlap(const Detection& left, const Detection& right, double disparity) {
  const double shift = disparity > 0.0 ? disparity : left.box.center().x() - right.box.center().x();
  if (left.label != right.label || shift < 0.0) {
    return 0.0;
  }
  std::vector<Eigen::Vector2d> moved = left.hull;
  for (Eigen::Vector2d& corner : moved) {
    corner.x() -= shift;
  }
  return IntersectionOverUnion(moved, right.hull);
}

// The depths beside a line, which show whether something hides the object there, are known in the
// left image only. So a line is also one-sided if the line of the left image with the nearest
// normal is.
std::vector<SilhouetteLine> LinesOf(const Detection& left, const Detection& right) {
  std::vector<SilhouetteLine> lines = right.lines;
  for (SilhouetteLine& line : lines) {
    const auto nearest = std::ranges::max_element(left.lines, {}, [&](const SilhouetteLine& other) {
      return other.line.normal.dot(line.line.normal);
    });
    line.is_one_sided = line.is_one_sided || nearest->is_one_sided;
  }
  return lines;
}

DetectionOptions WithoutKeypoints(DetectionOptions options) {
  options.min_keypoints = 0;
  return options;
}

}  // namespace

size_t AddLinesOfRight(std::span<const Detection> right, const PinholeCamera& camera,
                       std::vector<Detection>& left) {
  constexpr double kLeastOverlap = 0.5;
  std::vector<uint8_t> is_taken(right.size(), 0);
  size_t added = 0;
  for (Detection& detection : left) {
    const double disparity = DisparityOf(detection, camera);
    double best = kLeastOverlap;
    size_t chosen = right.size();
    for (size_t i = 0; i < right.size(); ++i) {
      const double overlap = is_taken[i] == 0 ? Overlap(detection, right[i], disparity) : 0.0;
      if (overlap > best) {
        best = overlap;
        chosen = i;
      }
    }
    if (chosen < right.size()) {
      is_taken[chosen] = 1;
      detection.right_lines = LinesOf(detection, right[chosen]);
      ++added;
    }
  }
  return added;
}

FrameDetector::FrameDetector(const Sensor& sensor, const DepthOptions& depth,
                             const DetectionOptions& options, std::set<std::string> dynamic_classes)
    : camera_(sensor.camera),
      builder_(sensor.camera, depth.units_per_metre, options, sensor.mask_all),
      right_builder_(sensor.camera, depth.units_per_metre, WithoutKeypoints(options),
                     sensor.mask_all_right),
      dynamic_classes_(std::move(dynamic_classes)) {}

std::vector<InstanceMask> FrameDetector::OfObjects(std::span<const InstanceMask> masks) const {
  std::vector<InstanceMask> of_objects;
  std::copy_if(masks.begin(), masks.end(), std::back_inserter(of_objects),
               [&](const InstanceMask& mask) { return !dynamic_classes_.contains(mask.label); });
  return of_objects;
}

void FrameDetector::AddDetections(std::span<const InstanceMask> masks, const cv::Mat& depth,
                                  std::span<const RawKeypoint> keypoints, TaskRunner& runner,
                                  BuiltFrame& built) {
  if (!masks.empty()) {
    DetectionResult result = builder_.Build(OfObjects(masks), depth, keypoints, runner);
    for (const std::optional<DetectionRejection>& rejection : result.rejections) {
      if (rejection) {
        ++built.masks.rejections[*rejection];
      }
    }
    built.masks.detections = result.detections.size();
    built.frame->detections = std::move(result.detections);
  }
}

void FrameDetector::AddRightLines(std::span<const InstanceMask> masks, TaskRunner& runner,
                                  BuiltFrame& built) {
  if (masks.empty()) {
    return;
  }
  const std::vector<InstanceMask> of_objects = OfObjects(masks);
  const DetectionResult right = right_builder_.Build(of_objects, cv::Mat(), {}, runner);
  const size_t added = AddLinesOfRight(right.detections, camera_, built.frame->detections);
  built.masks.right_masks = added;
  if (added < of_objects.size()) {
    built.masks.rejections[DetectionRejection::kNotInLeft] += of_objects.size() - added;
  }
}

}  // namespace hullslam
