// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "hullslam/geometry/dual_quadric.h"
#include "images/image_codecs.h"
#include "map/islands.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr size_t kMostOutlinePoints = 80;
constexpr size_t kMostKeypoints = 1500;
constexpr size_t kMostEllipses = 60;   // without masks
constexpr double kLeastWidth = 160.0;  // px
constexpr double kMostWidth = 640.0;
constexpr int kLiveQuality = 70;  // of JPEG

std::string EncodeGrey(const cv::Mat& grey, double scale) {
  cv::Mat scaled;
  cv::resize(grey, scaled, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  return EncodeJpeg(scaled, kLiveQuality);
}

// Undistorted px as px of the picture.
ViewShape ShapeOf(ObjectId object, const std::string& label,
                  const std::vector<Eigen::Vector2d>& undistorted, const PinholeCamera& camera,
                  double scale) {
  ViewShape shape{object, label, {}};
  for (const Eigen::Vector2d& point : Thin(undistorted, kMostOutlinePoints)) {
    shape.points.push_back(scale * camera.Distort(point));
  }
  return shape;
}

// Whether the object is in the island in which the frame was tracked.
bool IsWhereTheFrameIs(const FrameReport& report, const Map& map, const ObjectLandmark& object) {
  const auto& reference = report.tracked.from_keyframe;
  return !reference || !map.keyframes().Contains(reference->reference) ||
         object.observations.empty() ||
         IslandOf(map, object) == IslandOf(map, reference->reference);
}

}  // namespace

LivePicture LivePictures::Make(const LiveFrame& frame) {
  LivePicture made;
  made.picture.timestamp = frame.report.tracked.timestamp;
  if (frame.grey.empty()) {
    return made;
  }
  const double scale = std::min(1.0, width_ / frame.grey.cols);
  made.picture.jpeg = EncodeGrey(frame.grey, scale);
  made.picture.width = static_cast<int>(std::lround(scale * frame.grey.cols));
  made.picture.height = static_cast<int>(std::lround(scale * frame.grey.rows));
  // The size of a file grows about as the area of the picture does.
  const double excess =
      static_cast<double>(made.picture.jpeg.size()) / static_cast<double>(jpeg_bytes_);
  width_ =
      std::clamp(width_ * std::clamp(std::pow(excess, -0.25), 0.8, 1.05), kLeastWidth, kMostWidth);
  AddShapes(frame, scale, made.picture);
  AddKeypoints(frame, scale, made);
  return made;
}

// Masks may come when the frame has been shown. The mapped objects are where they should be seen.
void LivePictures::AddMappedObjects(const LiveFrame& frame, double scale,
                                    ViewPicture& picture) const {
  if (frame.map == nullptr || frame.report.tracked.state != TrackingState::kTracked) {
    return;
  }
  const cv::Rect2d image(0.0, 0.0, picture.width, picture.height);
  frame.map->objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (picture.ellipses.size() >= kMostEllipses || object.state != ObjectState::kMapped ||
        !IsWhereTheFrameIs(frame.report, *frame.map, object)) {
      return;
    }
    const auto ellipse =
        ProjectEllipsoid(camera_.Matrix(), frame.report.tracked.cam_from_world, object.ellipsoid);
    if (!ellipse) {
      return;
    }
    ViewShape shape = ShapeOf(id, object.Label(), ellipse->Polygon(), camera_, scale);
    if (std::ranges::any_of(shape.points, [&](const Eigen::Vector2d& point) {
          return image.contains(cv::Point2d(point.x(), point.y()));
        })) {
      picture.ellipses.push_back(std::move(shape));
    }
  });
}

void LivePictures::AddShapes(const LiveFrame& frame, double scale, ViewPicture& picture) const {
  const FrameReport& report = frame.report;
  if (report.frame->detections.empty()) {
    AddMappedObjects(frame, scale, picture);
  }
  for (size_t i = 0; i < report.frame->detections.size(); ++i) {
    const Detection& seen = report.frame->detections[i];
    const ObjectId id = i < report.objects.size() ? report.objects[i] : ObjectId();
    picture.outlines.push_back(ShapeOf(id, seen.label,
                                       seen.contour.size() > 0 ? seen.contour.Unpack() : seen.hull,
                                       camera_, scale));
    const ObjectLandmark* object =
        frame.map != nullptr && id.IsValid() ? frame.map->objects().Find(id) : nullptr;
    if (object == nullptr || object->state != ObjectState::kMapped) {
      continue;
    }
    const auto ellipse =
        ProjectEllipsoid(camera_.Matrix(), report.tracked.cam_from_world, object->ellipsoid);
    if (ellipse) {
      picture.ellipses.push_back(ShapeOf(id, object->Label(), ellipse->Polygon(), camera_, scale));
    }
  }
}

void LivePictures::AddKeypoints(const LiveFrame& frame, double scale, LivePicture& picture) const {
  const std::vector<Keypoint>& keypoints = frame.report.frame->features.keypoints;
  const std::vector<LandmarkId>& landmarks = frame.report.landmarks;
  const size_t step = keypoints.size() / kMostKeypoints + 1;
  for (size_t i = 0; i < keypoints.size(); i += step) {
    const Eigen::Vector2d raw = scale * camera_.Distort(keypoints[i].undistorted.cast<double>());
    const bool is_matched = i < landmarks.size() && landmarks[i].IsValid();
    std::vector<float>& list = is_matched ? picture.matched : picture.unmatched;
    list.push_back(static_cast<float>(raw.x()));
    list.push_back(static_cast<float>(raw.y()));
  }
}

}  // namespace hullslam
