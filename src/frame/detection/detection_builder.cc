// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/detection_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <utility>

#include "frame/detection/detection_depth.h"
#include "frame/detection/detection_lines.h"
#include "frame/detection/mask_region.h"
#include "geometry/polygon.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Rejections = std::vector<std::optional<DetectionRejection>>;

// A mask for which a detection is being built.
struct Candidate {
  size_t index;  // index of the mask
  const InstanceMask* mask;
  std::vector<Polygon2> parts;
  Outline outline;
  MaskRegion region;
  Detection detection;
  MaskCamera view;
  double depth = 0.0;  // m, median of its points; 0 if unknown
};

struct FrameView {
  const DetectionOptions& options;
  MaskDepth depth;
  std::span<const RawKeypoint> keypoints;
  const cv::Mat& mask_all;

  // The same frame in the view of a mask.
  FrameView From(const MaskCamera& view) const {
    return {
        .options = options,
        .depth = {.camera = view, .image = depth.image, .units_per_metre = depth.units_per_metre},
        .keypoints = keypoints,
        .mask_all = mask_all};
  }

  // Whether a pixel of the view is at the border of what is used of the image.
  bool IsAtBorder(const Eigen::Vector2d& pixel) const {
    return depth.camera.IsAtBorder(pixel, options.border_px) ||
           (!mask_all.empty() && IsNearIgnored(depth.camera.Distort(pixel)));
  }

 private:
  bool IsNearIgnored(const Eigen::Vector2d& raw) const {
    const auto reach = static_cast<int>(std::ceil(options.border_px));
    const cv::Rect about(cvRound(raw.x()) - reach, cvRound(raw.y()) - reach, 2 * reach + 1,
                         2 * reach + 1);
    const cv::Rect inside = about & cv::Rect({}, mask_all.size());
    return !inside.empty() && cv::countNonZero(mask_all(inside)) < inside.area();
  }
};

// The ellipse that touches the four sides of the box in their middle.
Ellipse EllipseInBox(const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2d half = 0.5 * box.sizes();
  return {.center = box.center(), .shape = half.cwiseProduct(half).asDiagonal()};
}

std::optional<DetectionRejection> CheckOutline(const Outline& outline, const FrameView& frame) {
  if (outline.hull.size() < 3) {
    return DetectionRejection::kDegenerate;
  }
  if (BoundingBox(outline.hull).sizes().minCoeff() < frame.options.min_side_px) {
    return DetectionRejection::kTooSmall;
  }
  if (SignedArea(outline.hull) < frame.options.min_area_px2) {
    return DetectionRejection::kTooSmall;
  }
  const double image =
      static_cast<double>(frame.depth.camera.camera().width) * frame.depth.camera.camera().height;
  if (SignedArea(outline.hull) > frame.options.max_area_share * image) {
    return DetectionRejection::kTooLarge;
  }
  return std::nullopt;
}

std::vector<uint32_t> KeypointsIn(const MaskRegion& region,
                                  std::span<const RawKeypoint> keypoints) {
  std::vector<uint32_t> inside;
  for (size_t i = 0; i < keypoints.size(); ++i) {
    if (region.Contains(keypoints[i].raw.cast<double>())) {
      inside.push_back(static_cast<uint32_t>(i));
    }
  }
  inside.shrink_to_fit();
  return inside;
}

// The vector with length 1, as maps keep it: readers of maps refuse longer ones.
std::vector<float> Normalized(const std::vector<float>& vector) {
  double sum = 0.0;
  for (const float element : vector) {
    sum += static_cast<double>(element) * element;
  }
  std::vector<float> result;
  result.reserve(vector.size());
  for (const float element : vector) {
    result.push_back(static_cast<float>(element / std::sqrt(sum)));
  }
  return result;
}

// Makes the detection without its lines. They are added later, because they depend on other masks.
Detection DetectionOf(const InstanceMask& mask, const Outline& outline, const FrameView& frame) {
  Detection detection;
  detection.label = mask.label;
  detection.score = mask.score;
  detection.embedding = Normalized(mask.embedding);
  detection.contour = outline.contour;
  detection.hull = outline.hull;
  detection.box = BoundingBox(outline.hull);
  detection.primitive = frame.options.primitive;
  detection.is_box = mask.shape == MaskShape::kBox;
  detection.is_cut = std::any_of(outline.hull.begin(), outline.hull.end(),
                                 [&](const auto& corner) { return frame.IsAtBorder(corner); });
  if (mask.shape == MaskShape::kEllipse || frame.options.primitive == ObjectPrimitive::kConic) {
    detection.ellipse = FitEllipse(outline.contour);
  } else if (frame.options.primitive == ObjectPrimitive::kBoxEllipse) {
    detection.ellipse = EllipseInBox(detection.box);
  }
  return detection;
}

// Makes the candidate, unless the mask alone is a reason to reject it.
std::optional<DetectionRejection> Prepare(const InstanceMask& mask, size_t index,
                                          const FrameView& whole,
                                          std::optional<Candidate>& candidate) {
  if (mask.score < whole.options.min_score) {
    return DetectionRejection::kLowScore;
  }
  std::vector<Polygon2> parts = LargeParts(mask.outlines, whole.options.min_part_share);
  const PinholeCamera& camera = whole.depth.camera.camera();
  const FrameView frame = whole.From(MaskCamera(camera, parts));
  Outline outline = UndistortOutline(parts, frame.depth.camera);
  if (const auto rejection = CheckOutline(outline, frame)) {
    return rejection;
  }
  MaskRegion region(parts, camera);
  Detection detection = DetectionOf(mask, outline, frame);
  detection.keypoints = KeypointsIn(region, frame.keypoints);
  if (detection.keypoints.size() < static_cast<size_t>(frame.options.min_keypoints)) {
    return DetectionRejection::kFewKeypoints;
  }
  double depth = 0.0;
  if (!frame.depth.image.empty()) {
    std::vector<Eigen::Vector3d> points =
        DepthPoints(frame.depth, region, frame.options.max_depth_points);
    RemoveFarFromMedian(frame.depth.camera, detection.box.sizes().maxCoeff(),
                        frame.options.max_depth_offset, points);
    depth = MedianDepth(points);
    detection.points = points;
  }
  candidate = Candidate{.index = index,
                        .mask = &mask,
                        .parts = std::move(parts),
                        .outline = std::move(outline),
                        .region = std::move(region),
                        .detection = std::move(detection),
                        .view = frame.depth.camera,
                        .depth = depth};
  return std::nullopt;
}

// The candidates of all masks that are not rejected, in the order of the masks.
std::vector<Candidate> PrepareAll(std::span<const InstanceMask> masks, const FrameView& frame,
                                  TaskRunner& runner, Rejections& rejections) {
  std::vector<std::optional<Candidate>> prepared(masks.size());
  rejections.resize(masks.size());
  runner.Run(masks.size(),
             [&](size_t i) { rejections[i] = Prepare(masks[i], i, frame, prepared[i]); });
  std::vector<Candidate> candidates;
  candidates.reserve(masks.size());
  for (std::optional<Candidate>& candidate : prepared) {
    if (candidate) {
      candidates.push_back(std::move(*candidate));
    }
  }
  return candidates;
}

// Whether two masks show the same object. A network can report one thing under two classes, so
// classes are compared only where the depth cannot distinguish things.
bool AreOneObject(const Candidate& a, const Candidate& b, const DetectionOptions& options) {
  const double shared = SharedArea(a.region, b.region);
  const double smaller = std::min(a.region.area(), b.region.area());
  const double larger = std::max(a.region.area(), b.region.area());
  if (shared <= 0.0) {
    return false;
  }
  const double iou = shared / (smaller + larger - shared);
  if (iou >= options.duplicate_iou) {
    return true;
  }
  if (a.depth > 0.0 && b.depth > 0.0) {
    const bool is_fragment =
        shared >= options.fragment_inside * smaller && smaller >= options.fragment_area * larger;
    return is_fragment &&
           std::abs(a.depth - b.depth) <= options.fragment_depth * std::min(a.depth, b.depth);
  }
  const bool are_outlines =
      a.mask->shape == MaskShape::kContour && b.mask->shape == MaskShape::kContour;
  return are_outlines && a.mask->label == b.mask->label && iou >= options.duplicate_class_iou;
}

// When several masks show the same object, keeps that of the highest score; ties go to the first.
void RejectDuplicates(const DetectionOptions& options, std::vector<Candidate>& candidates,
                      Rejections& rejections) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.mask->score > b.mask->score; });
  std::vector<Candidate> kept;
  kept.reserve(candidates.size());
  for (Candidate& candidate : candidates) {
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return AreOneObject(candidate, other, options);
    });
    if (is_known) {
      rejections[candidate.index] = DetectionRejection::kDuplicate;
    } else {
      kept.push_back(std::move(candidate));
    }
  }
  candidates = std::move(kept);
  std::sort(candidates.begin(), candidates.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
}

std::vector<LineOnOutline> LinesOf(const Candidate& candidate, const FrameView& frame) {
  if (candidate.mask->shape == MaskShape::kBox) {
    return SidesOfBox(candidate.parts[0], frame.depth.camera);
  }
  const ObjectPrimitive primitive = candidate.mask->shape == MaskShape::kEllipse
                                        ? ObjectPrimitive::kConic
                                        : frame.options.primitive;
  return LinesOfOutline(candidate.outline, candidate.detection.ellipse, primitive, frame.options);
}

bool IsOneSided(const LineOnOutline& line, const FrameView& frame, double depth,
                std::span<const MaskRegion* const> others) {
  const bool is_cut =
      std::all_of(line.touching.begin(), line.touching.end(),
                  [&](const Eigen::Vector2d& point) { return frame.IsAtBorder(point); });
  return is_cut ||
         (!frame.depth.image.empty() && IsHidden(line, frame.depth, depth, others, frame.options));
}

void AddLines(const std::vector<Candidate>& candidates, const FrameView& whole,
              Candidate& candidate) {
  const FrameView frame = whole.From(candidate.view);
  std::vector<const MaskRegion*> others;
  for (const Candidate& other : candidates) {
    if (other.index != candidate.index) {
      others.push_back(&other.region);
    }
  }
  const std::vector<LineOnOutline> lines = LinesOf(candidate, frame);
  candidate.detection.lines.reserve(lines.size());
  for (const LineOnOutline& line : lines) {
    candidate.detection.lines.push_back(
        {.line = line.line, .is_one_sided = IsOneSided(line, frame, candidate.depth, others)});
  }
}

void CheckDepth(const cv::Mat& depth, const PinholeCamera& camera) {
  if (!depth.empty()) {
    Check(depth.size() == cv::Size(camera.width, camera.height),
          "the depth image does not have the camera's size");
    Check(depth.type() == CV_16UC1 || depth.type() == CV_32FC1,
          "the depth image is neither CV_16UC1 nor CV_32FC1");
  }
}

}  // namespace

DetectionResult DetectionBuilder::Build(std::span<const InstanceMask> masks, const cv::Mat& depth,
                                        std::span<const RawKeypoint> keypoints) const {
  SerialRunner runner;
  return Build(masks, depth, keypoints, runner);
}

DetectionResult DetectionBuilder::Build(std::span<const InstanceMask> masks, const cv::Mat& depth,
                                        std::span<const RawKeypoint> keypoints,
                                        TaskRunner& runner) const {
  CheckDepth(depth, camera_);
  const FrameView frame{
      .options = options_,
      .depth = {.camera = camera_, .image = depth, .units_per_metre = units_per_metre_},
      .keypoints = keypoints,
      .mask_all = mask_all_};
  DetectionResult result;
  std::vector<Candidate> candidates = PrepareAll(masks, frame, runner, result.rejections);
  RejectDuplicates(options_, candidates, result.rejections);
  runner.Run(candidates.size(), [&](size_t i) { AddLines(candidates, frame, candidates[i]); });
  result.detections.reserve(candidates.size());
  for (Candidate& candidate : candidates) {
    const std::vector<SilhouetteLine>& lines = candidate.detection.lines;
    const bool is_held = std::any_of(lines.begin(), lines.end(),
                                     [](const SilhouetteLine& line) { return !line.is_one_sided; });
    if (is_held) {
      candidate.view.ToUndistorted(candidate.detection);
      result.detections.push_back(std::move(candidate.detection));
    } else {
      result.rejections[candidate.index] = DetectionRejection::kNoSilhouette;
    }
  }
  return result;
}

}  // namespace hullslam
