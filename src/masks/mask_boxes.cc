// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "files/plausible.h"
#include "masks/mask_checks.h"
#include "masks/mask_format.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

constexpr std::string_view kBoxesName = "boxes";

constexpr size_t kColumns = 6;
constexpr double kRounding = 0.01;  // how far shares may be beyond 0 to 1, because files round them

bool IsYoloBox(const MaskProbe& probe) {
  return IsTrackedBox(probe) ||
         ((probe.columns == kColumns || probe.columns == kColumns - 1) && IsNormalized(probe, 1));
}

class BoxMasks : public TextMasks {
 public:
  explicit BoxMasks(const MaskRequest& request)
      : TextMasks(request), is_yolo_(IsYoloBox(ProbeMasks(request.path))) {}
  std::string format() const override { return std::string(kBoxesName); }

 private:
  InstanceMask Parse(const TextRow& row) const override {
    return is_yolo_ ? ParseYolo(row) : ParsePixels(row);
  }

  InstanceMask ParsePixels(const TextRow& row) const {
    if (row.columns.size() != kColumns) {
      row.Fail(fmt::format("{} column(s), expected {}: class x y width height score",
                           row.columns.size(), kColumns));
    }
    const double x = row.Number(1, "x", kMostPixels);
    const double y = row.Number(2, "y", kMostPixels);
    const double width = Length(row, 3, "width");
    const double height = Length(row, 4, "height");
    return {.label = ClassName(row, 0),
            .score = Score(row, 5),
            .shape = MaskShape::kBox,
            .outlines = {BoxOutline(x, y, x + width, y + height, request())}};
  }

  // The numbers are shares of the width and height of the image: the outer edge of the first pixel
  // is at 0, the outer edge of the last one at 1.
  InstanceMask ParseYolo(const TextRow& row) const {
    // A line of five columns ends in the height, which may be 1 too.
    const size_t columns =
        row.columns.size() - (row.columns.size() >= kColumns && HasTrack(row) ? 1 : 0);
    if (columns != kColumns && columns != kColumns - 1) {
      row.Fail(fmt::format(
          "{} column(s), expected {} to {}: class x y width height [confidence] [track]",
          row.columns.size(), kColumns - 1, kColumns + 1));
    }
    const double x = request().width * Share(row, 1, "x");
    const double y = request().height * Share(row, 2, "y");
    const double half_width = 0.5 * request().width * Share(row, 3, "width");
    const double half_height = 0.5 * request().height * Share(row, 4, "height");
    return {.label = ClassName(row, 0),
            .score = columns == kColumns ? Score(row, 5) : 1.0,
            .shape = MaskShape::kBox,
            .outlines = {BoxOutline(x - half_width, y - half_height, x + half_width,
                                    y + half_height, request())}};
  }

  static double Share(const TextRow& row, size_t column, const char* name) {
    const double value = row.Number(column, name);
    if (value < -kRounding || value > 1.0 + kRounding) {
      row.Fail(
          fmt::format("{} is '{}', expected a share of the image from 0 to 1, as in the first "
                      "box of the folder",
                      name, value));
    }
    return std::clamp(value, 0.0, 1.0);
  }

  static double Length(const TextRow& row, size_t column, const char* name) {
    const double value = row.Number(column, name, kMostPixels);
    if (value < 0.0) {
      row.Fail(fmt::format("{} is '{}', expected a number >= 0 (px)", name, value));
    }
    return value;
  }

  const bool is_yolo_;  // decided by the first box of the folder, because some lines fit both forms
};

bool IsBoxes(const MaskProbe& probe) {
  return IsYoloBox(probe) || (probe.columns == kColumns && IsNormalized(probe, kColumns - 1));
}

}  // namespace

bool IsTrackedBox(const MaskProbe& probe) {
  return probe.columns == kColumns + 1 && IsTrackNumber(probe.row.back()) && IsNormalized(probe, 1);
}

const MaskFormat kBoxesFormat = {.name = kBoxesName, .is_meant = IsBoxes, .open = OpenAs<BoxMasks>};

}  // namespace hullslam
