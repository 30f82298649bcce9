// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/mask_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hullslam {
namespace {

using Eigen::Vector2d;

constexpr int kScale = 2;
constexpr int kShift = 4;  // fractional bits of drawn coordinates
constexpr double kLongestPiece =
    24.0;  // px, length of a line that is drawn on either side of the point where it touches
constexpr double kTick = 4.0;  // px, the mark that shows the outer side of a line

const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kRed(60, 60, 255);
const cv::Scalar kYellow(0, 230, 255);
const cv::Scalar kGreen(60, 220, 60);
const cv::Scalar kOrange(0, 130, 255);

// The position in the picture of a point of the raw image, as integers with kShift fractional bits.
cv::Point ToPicture(const Vector2d& raw) {
  const Vector2d scaled = ((raw.array() + 0.5) * kScale - 0.5) * (1 << kShift);
  return {cvRound(scaled.x()), cvRound(scaled.y())};
}

void DrawPolygon(cv::Mat& picture, std::span<const Vector2d> raw, const cv::Scalar& colour,
                 int thickness) {
  std::vector<cv::Point> points;
  std::transform(raw.begin(), raw.end(), std::back_inserter(points), ToPicture);
  cv::polylines(picture, points, true, colour, thickness, cv::LINE_AA, kShift);
}

void DrawText(cv::Mat& picture, const Vector2d& raw, const std::string& text,
              const cv::Scalar& colour) {
  constexpr double kSize = 0.45;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kSize, 1, nullptr);
  const auto limit = [](double wanted, int low, int high) {
    return std::clamp(cvRound(kScale * wanted), low, std::max(low, high));
  };
  const cv::Point at(limit(raw.x(), 0, picture.cols - size.width),
                     limit(raw.y(), size.height, picture.rows - 4));
  for (const auto& [paint, thickness] : {std::pair(cv::Scalar(0, 0, 0), 3), {colour, 1}}) {
    cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, kSize, paint, thickness, cv::LINE_AA);
  }
}

// The corner of the hull that lies farthest along the line's normal.
Vector2d Support(const Detection& detection, const Line2& line) {
  return *std::max_element(detection.hull.begin(), detection.hull.end(),
                           [&](const Vector2d& a, const Vector2d& b) {
                             return line.normal.dot(a) < line.normal.dot(b);
                           });
}

void DrawLine(cv::Mat& picture, const PinholeCamera& camera, const Detection& detection,
              const SilhouetteLine& silhouette) {
  const Line2& line = silhouette.line;
  const Vector2d support = Support(detection, line);
  const Vector2d touch = support - line.SignedDistance(support) * line.normal;
  const Vector2d along(-line.normal.y(), line.normal.x());
  const double reach = std::min(kLongestPiece, 0.25 * detection.box.diagonal().norm());
  const auto draw = [&](const Vector2d& a, const Vector2d& b) {
    cv::line(picture, ToPicture(camera.Distort(a)), ToPicture(camera.Distort(b)),
             silhouette.is_one_sided ? kOrange : kGreen, 2, cv::LINE_AA, kShift);
  };
  draw(touch - reach * along, touch + reach * along);
  draw(touch, touch + kTick * line.normal);
}

void DrawDetection(cv::Mat& picture, const PinholeCamera& camera, const Detection& detection) {
  std::vector<Vector2d> raw;
  for (const Vector2d& corner : detection.hull) {
    raw.push_back(camera.Distort(corner));
  }
  DrawPolygon(picture, raw, kYellow, 1);
  for (const SilhouetteLine& line : detection.lines) {
    DrawLine(picture, camera, detection, line);
  }
  DrawText(picture, camera.Distort(detection.box.min()),
           fmt::format("{} {:.2f}{}", detection.label, detection.score,
                       detection.is_cut ? " (cut)" : ""),
           kWhite);
}

void DrawOutlines(cv::Mat& picture, const InstanceMask& mask,
                  const std::optional<DetectionRejection>& rejection) {
  for (const std::vector<Vector2d>& outline : mask.outlines) {
    DrawPolygon(picture, outline, rejection ? kRed : kWhite, 1);
  }
  if (rejection && !mask.outlines.empty()) {
    const std::vector<Vector2d>& outline = mask.outlines.front();
    const Vector2d middle =
        outline[outline.size() / 2];  // the labels of hulls are at the upper left
    DrawText(picture, middle,
             fmt::format("{} {:.2f}: {}", mask.label, mask.score, ToString(*rejection)), kRed);
  }
}

}  // namespace

cv::Mat DrawMasks(const cv::Mat& grey, const PinholeCamera& camera,
                  std::span<const InstanceMask> masks, const DetectionResult& result) {
  cv::Mat picture;
  cv::cvtColor(0.6 * grey, picture, cv::COLOR_GRAY2BGR);  // darkened, so that the lines are visible
  cv::resize(picture, picture, {}, kScale, kScale, cv::INTER_LINEAR);
  for (size_t i = 0; i < masks.size(); ++i) {
    DrawOutlines(picture, masks[i], result.rejections.at(i));
  }
  for (const Detection& detection : result.detections) {
    DrawDetection(picture, camera, detection);
  }
  return picture;
}

}  // namespace hullslam
