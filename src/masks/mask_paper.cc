// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "masks/mask_checks.h"
#include "masks/mask_format.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

constexpr std::string_view kPaperName = "paper";

constexpr size_t kColumnsBeforePolygon = 4;

class PaperMasks : public TextMasks {
 public:
  using TextMasks::TextMasks;
  std::string format() const override { return std::string(kPaperName); }

 private:
  std::string FileName(const MaskFrame& frame) const override {
    return fmt::format("{:06}", frame.number);
  }

  InstanceMask Parse(const TextRow& row) const override {
    const size_t columns = row.columns.size();
    if (columns < kColumnsBeforePolygon || columns % 2 != 0) {
      row.Fail(
          fmt::format("{} column(s), expected a polygon: instance track "
                      "label confidence x1 y1 ... xn yn",
                      columns));
    }
    if ((columns - kColumnsBeforePolygon) / 2 > kMostOutlinePoints) {
      row.Fail(fmt::format("a polygon of {} points, expected at most {}",
                           (columns - kColumnsBeforePolygon) / 2, kMostOutlinePoints));
    }
    row.Number(0, "instance");
    row.Number(1, "track");
    double number = 0.0;
    const bool is_number = ParseFinite(row.columns[2], number);
    InstanceMask instance{.label = is_number ? ClassName(row, 2) : std::string(row.columns[2]),
                          .score = Score(row, 3),
                          .outlines = {}};
    std::vector<Eigen::Vector2d> outline((columns - kColumnsBeforePolygon) / 2);
    for (size_t i = 0; i < outline.size(); ++i) {
      const size_t column = kColumnsBeforePolygon + 2 * i;
      outline[i] = {row.Number(column, "x"), row.Number(column + 1, "y")};
      if (!IsNearImage(outline[i], request())) {
        row.Fail(fmt::format("point ({}, {}) in column {} is outside the image of {}x{} px",
                             outline[i].x(), outline[i].y(), column + 1, request().width,
                             request().height));
      }
    }
    if (outline.size() >= 3) {  // others have no area
      instance.outlines.push_back(std::move(outline));
    }
    return instance;
  }
};

bool IsPaper(const MaskProbe& probe) {
  double number = 0.0;
  const auto is_share = [&](size_t column) {
    return ParseFinite(probe.row[column], number) && number >= 0.0 && number <= 1.0;
  };
  return probe.has_paper_folder ||
         (probe.columns >= kColumnsBeforePolygon + 6 && probe.columns % 2 == 0 && is_share(3) &&
          !IsNormalized(probe, kColumnsBeforePolygon));
}

std::unique_ptr<MaskSource> OpenPaper(const MaskRequest& request) {
  MaskRequest within = request;
  std::error_code error;
  if (std::filesystem::is_directory(request.path / "segmentation_txt", error)) {
    within.path /= "segmentation_txt";
  }
  return std::make_unique<PaperMasks>(within);
}

}  // namespace

const MaskFormat kPaperFormat = {.name = kPaperName, .is_meant = IsPaper, .open = OpenPaper};

}  // namespace hullslam
