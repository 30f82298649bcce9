// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "masks/mask_checks.h"
#include "masks/mask_format.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

constexpr std::string_view kYoloSegName = "yolo-seg";

// How far coordinates may be outside the image. Outlines that pass between pixels are half a pixel
// outside the centres at the border, and rounding adds to this.
constexpr double kMostBeyond = 1.0;  // px

class YoloSegMasks : public TextMasks {
 public:
  using TextMasks::TextMasks;
  std::string format() const override { return std::string(kYoloSegName); }

 private:
  // Coordinates are pixels with integer centres, divided by width and height. Ultralytics writes
  // them in this form: it divides the pixels that cv::findContours() returns. It also writes lines
  // without an outline, or with one of a point or two, for masks without area.
  InstanceMask Parse(const TextRow& row) const override {
    const size_t numbers = row.columns.size() - 1 - (HasTrack(row) ? 1 : 0);
    const size_t points = numbers / 2;
    if (points > kMostOutlinePoints) {
      row.Fail(
          fmt::format("a polygon of {} points, expected at most {}", points, kMostOutlinePoints));
    }
    InstanceMask instance{.label = ClassName(row, 0), .outlines = {}};
    std::vector<Eigen::Vector2d> outline(points);
    for (size_t i = 0; i < points; ++i) {
      outline[i] = {Coordinate(row, 1 + 2 * i, "x", request().width),
                    Coordinate(row, 2 + 2 * i, "y", request().height)};
    }
    if (numbers % 2 == 1) {
      instance.score = Score(row, numbers);
    }
    if (points >= 3) {
      instance.outlines.push_back(std::move(outline));
    }
    return instance;
  }

  // A coordinate in pixels.
  static double Coordinate(const TextRow& row, size_t column, const char* name, int size) {
    const double value = row.Number(column, name);
    const double pixels = value * size;
    if (pixels < -kMostBeyond || pixels > size + kMostBeyond) {
      row.Fail(fmt::format("{} is '{}' in column {}, expected a number from 0 to 1", name, value,
                           column + 1));
    }
    return pixels;
  }
};

bool IsYoloSeg(const MaskProbe& probe) {
  return probe.columns >= 7 && !IsTrackedBox(probe) && IsNormalized(probe, 1);
}

}  // namespace

const MaskFormat kYoloSegFormat = {
    .name = kYoloSegName, .is_meant = IsYoloSeg, .open = OpenAs<YoloSegMasks>};

}  // namespace hullslam
