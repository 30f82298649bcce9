// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/answer_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "hullslam/util/error.h"
#include "images/image_file.h"

namespace hullslam {
namespace {

constexpr int kTile = 220;  // px, of the longer side of a cut-out
constexpr int kGap = 12;
constexpr int kTextWidth = 230;
constexpr size_t kTiles = 3;
const cv::Scalar kPaper(255, 255, 255);
const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kOutline(0, 140, 255);  // orange

// Empty if the picture is no image.
cv::Mat DecodeCutout(const ViewPicture& picture) {
  try {
    return DecodeColourImage("", picture.jpeg);
  } catch (const InputError&) {
    return {};
  }
}

cv::Mat DrawCutout(const ViewPicture& picture) {
  cv::Mat image = DecodeCutout(picture);
  if (image.empty()) {
    return image;
  }
  const double scale = static_cast<double>(kTile) / std::max(image.cols, image.rows);
  cv::resize(image, image, {}, scale, scale, cv::INTER_LINEAR);
  for (const ViewShape& outline : picture.outlines) {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& point : outline.points) {
      points.emplace_back(static_cast<int>(std::lround(scale * point.x())),
                          static_cast<int>(std::lround(scale * point.y())));
    }
    cv::polylines(image, points, true, kOutline, 2, cv::LINE_AA);
  }
  return image;
}

// Text of any length in a column of a fixed width: it becomes smaller if it is too long.
void Write(const std::string& text, const cv::Point& at, double size, cv::Mat& sheet) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  int baseline = 0;
  const int width = cv::getTextSize(text, kFont, size, 1, &baseline).width;
  const double fitting = size * std::min(1.0, static_cast<double>(kTextWidth) / std::max(width, 1));
  cv::putText(sheet, text, at, kFont, fitting, kInk, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat DrawAnswers(std::span<const Answer> answers, const ViewModel& model) {
  const int row = kTile + kGap;
  cv::Mat sheet(static_cast<int>(answers.size()) * row + kGap,
                kTextWidth + static_cast<int>(kTiles) * row + 2 * kGap, CV_8UC3, kPaper);
  int top = kGap;
  int rank = 1;
  for (const Answer& answer : answers) {
    const auto shown =
        std::find_if(model.objects.begin(), model.objects.end(),
                     [&](const ViewObject& object) { return object.object.id == answer.object; });
    if (shown != model.objects.end()) {
      Write(fmt::format("{}. {} {}", rank, shown->object.label, answer.object.value),
            {kGap, top + 40}, 0.9, sheet);
      Write(fmt::format("score {:.2f}", answer.score), {kGap, top + 75}, 0.6, sheet);
      int left = kTextWidth + 2 * kGap;
      const size_t count = std::min(shown->cutouts.size(), kTiles);
      for (const ViewPicture& picture : std::span(shown->cutouts).first(count)) {
        const cv::Mat tile = DrawCutout(picture);
        if (tile.empty()) {
          continue;
        }
        tile.copyTo(sheet(cv::Rect(cv::Point(left, top), tile.size())));
        left += row;
      }
    }
    top += row;
    ++rank;
  }
  return sheet;
}

}  // namespace hullslam
