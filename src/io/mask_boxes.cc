// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mask_boxes.h"

#include <fmt/format.h>

#include "io/mask_checks.h"
#include "io/mask_text.h"
#include "io/plausible.h"

namespace hullslam {
namespace {

constexpr size_t kColumns = 6;

class BoxMasks : public TextMasks {
 public:
  using TextMasks::TextMasks;
  std::string format() const override { return "boxes"; }

 private:
  InstanceMask Parse(const TextRow& row) const override {
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

  static double Length(const TextRow& row, size_t column, const char* name) {
    const double value = row.Number(column, name, kMostPixels);
    if (value < 0.0) {
      row.Fail(fmt::format("{} is '{}', expected a number >= 0 (px)", name, value));
    }
    return value;
  }
};

}  // namespace

// Boxes in fractions of width and height, which YOLO writes for detections, are another format.
bool IsBoxes(const MaskProbe& probe) {
  return probe.columns == kColumns && !IsNormalized(probe, 1) && IsNormalized(probe, kColumns - 1);
}

std::unique_ptr<MaskSource> OpenBoxes(const MaskRequest& request) {
  return std::make_unique<BoxMasks>(request);
}

}  // namespace hullslam
