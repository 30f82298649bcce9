// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/labelme_shapes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "files/base64.h"
#include "files/json_file.h"
#include "files/plausible.h"
#include "frame/detection/mask_outline.h"
#include "geometry/polygon.h"
#include "images/image_file.h"
#include "masks/mask_checks.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;
using Points = std::vector<Eigen::Vector2d>;

// In the files, 0 is the border of the image.
Points PointsOf(const JsonRecord& record) {
  const Json& list = Member(record, record.value, "points");
  if (!list.is_array() || list.size() > kMostOutlinePoints) {
    record.Fail(fmt::format("points is {}, expected a list of up to {} points", ShowJson(list),
                            kMostOutlinePoints));
  }
  Points points;
  for (const Json& point : list) {
    const std::vector<double> numbers = Numbers(record, point, "a point");
    if (numbers.size() != 2 || !(std::abs(numbers[0]) <= kMostPixels) ||
        !(std::abs(numbers[1]) <= kMostPixels)) {
      record.Fail(fmt::format("a point is {}, expected [x, y] up to {:g} px", ShowJson(point),
                              kMostPixels));
    }
    points.emplace_back(numbers[0], numbers[1]);
  }
  return points;
}

Points PolygonOf(const JsonRecord& record, Points points, const MaskRequest& request) {
  for (Eigen::Vector2d& point : points) {
    point.array() -= 0.5;
    if (!IsNearImage(point, request)) {
      record.Fail(fmt::format("point ({}, {}) is outside the image of {}x{} px", point.x() + 0.5,
                              point.y() + 0.5, request.width, request.height));
    }
  }
  return points;
}

// The part of a convex shape that is inside the image, which it may leave as a box may.
Points ClippedOf(Points points, const MaskRequest& request) {
  if (SignedArea(points) < 0.0) {
    std::reverse(points.begin(), points.end());
  }
  const Eigen::AlignedBox2d image(Eigen::Vector2d::Zero(),
                                  Eigen::Vector2d(request.width, request.height));
  Points clipped = ClipToBox(points, image);
  for (Eigen::Vector2d& point : clipped) {
    point.array() -= 0.5;
  }
  return clipped;
}

// The points are the centre and any point of the circle.
Points CircleOf(const Points& points, const MaskRequest& request) {
  constexpr int kCorners = 64;
  const double radius = (points[1] - points[0]).norm();
  Points circle;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    circle.push_back(points[0] + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ClippedOf(std::move(circle), request);
}

// The points are two corners, or all four of them.
Points RectangleOf(const Points& points, const MaskRequest& request) {
  const Eigen::Vector2d& a = points[0];
  const Eigen::Vector2d& b = points[points.size() / 2];
  return BoxOutline(std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()),
                    std::max(a.y(), b.y()), request);
}

// A PNG of the pixels from the first corner to the second one, in base64.
std::vector<Points> PartsOfMask(const JsonRecord& record, const Points& points,
                                const MaskRequest& request) {
  const Json& text = Member(record, record.value, "mask");
  const std::optional<std::string> bytes =
      text.is_string() ? DecodeBase64(text.get_ref<const std::string&>()) : std::nullopt;
  if (!bytes) {
    record.Fail("mask is " + ShowJson(text) + ", expected a PNG in base64");
  }
  const cv::Mat mask = DecodeGreyImage(
      fmt::format("{}: {}[{}].mask", record.path.string(), record.section, record.index), *bytes);
  const Eigen::Vector2d low = points[0].cwiseMin(points[1]).array().floor();
  const Eigen::Vector2d high = points[0].cwiseMax(points[1]).array().floor();
  if (high.x() - low.x() + 1.0 != mask.cols || high.y() - low.y() + 1.0 != mask.rows ||
      low.minCoeff() < 0.0 || high.x() >= request.width || high.y() >= request.height) {
    record.Fail(fmt::format(
        "mask has {}x{} px for the pixels ({:g}, {:g}) to ({:g}, {:g}) of an image of {}x{} px, "
        "expected one for each pixel from the first point to the second one",
        mask.cols, mask.rows, low.x(), low.y(), high.x(), high.y(), request.width, request.height));
  }
  std::vector<Points> parts = FindMaskOutlines(mask);
  for (Points& part : parts) {
    std::ranges::for_each(part, [&](Eigen::Vector2d& point) { point += low; });
  }
  return parts;
}

std::string TypeOf(const JsonRecord& record) {
  const auto type = record.value.find("shape_type");
  return type != record.value.end() && type->is_string() ? type->get<std::string>() : "polygon";
}

}  // namespace

void LabelMeShapes::AddOutlines(const JsonRecord& record, InstanceMask& mask) const {
  const std::string type = TypeOf(record);
  const Points points = PointsOf(record);
  if (type == "rectangle" && points.size() >= 2) {
    mask.shape = MaskShape::kBox;
    mask.outlines.push_back(RectangleOf(points, request_));
  } else if (type == "mask" && points.size() == 2) {
    mask.outlines = PartsOfMask(record, points, request_);
  } else if (type == "circle" && points.size() == 2) {
    mask.outlines.push_back(CircleOf(points, request_));
  } else if ((type == "rotation" || type == "oriented_rectangle") && points.size() == 4) {
    mask.outlines.push_back(ClippedOf(points, request_));
  } else if (type == "polygon" && points.size() >= 3) {
    mask.outlines.push_back(PolygonOf(record, points, request_));
  }
}

void LabelMeShapes::Add(const JsonRecord& record) {
  const std::optional<std::string> label = ClassNameOf(record.value);
  if (!label) {
    record.Fail("has no 'label', expected the name of a class");
  }
  InstanceMask mask{.label = *label, .score = ScoreOf(record, record.value), .outlines = {}};
  AddOutlines(record, mask);
  const auto group = record.value.find("group_id");
  if (group != record.value.end() && !group->is_null()) {
    const auto [found, is_new] = groups_.try_emplace({*label, ShowJson(*group)}, instances_.size());
    if (!is_new) {
      InstanceMask& instance = instances_[found->second];
      instance.shape = MaskShape::kContour;  // also of two boxes
      instance.score = std::max(instance.score, mask.score);
      std::ranges::move(mask.outlines, std::back_inserter(instance.outlines));
      return;
    }
  }
  instances_.push_back(std::move(mask));
}

}  // namespace hullslam
