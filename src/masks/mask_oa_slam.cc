// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "files/json_file.h"
#include "files/plausible.h"
#include "masks/mask_checks.h"
#include "masks/mask_classes.h"
#include "masks/mask_format.h"
#include "masks/mask_json.h"

namespace hullslam {
namespace {

constexpr std::string_view kOaSlamName = "oa-slam";

using Json = nlohmann::json;

struct OaSlamDetection {
  std::string label;
  double score = 1.0;
  std::array<double, 4> box{};                   // left, top, right, bottom, px
  std::optional<std::array<double, 5>> ellipse;  // centre, axes, angle
};
using OaSlamImages = std::map<std::string, std::vector<OaSlamDetection>>;  // by stem

// Factors for the numbers of ellipses: axes may be half axes or, as in OpenCV, full axes; angles
// may be radians or degrees.
struct EllipseUnits {
  double axis = 1.0;
  double angle = 1.0;
};

// Half the size of the axis-aligned box around an ellipse.
Eigen::Vector2d HalfSize(const std::array<double, 5>& ellipse, const EllipseUnits& units) {
  const double a = units.axis * ellipse[2];
  const double b = units.axis * ellipse[3];
  const double cosine = std::cos(units.angle * ellipse[4]);
  const double sine = std::sin(units.angle * ellipse[4]);
  return {std::hypot(a * cosine, b * sine), std::hypot(a * sine, b * cosine)};
}

// Finds the units of the ellipses, which files do not name. Each ellipse comes with its box, and
// the ellipse only fits the box in the right units.
EllipseUnits FindUnits(const OaSlamImages& images) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  constexpr std::array<EllipseUnits, 4> kUnits = {
      {{1.0, 1.0}, {0.5, 1.0}, {1.0, kDegree}, {0.5, kDegree}}};
  std::array<double, kUnits.size()> differences{};
  for (const auto& [stem, detections] : images) {
    for (const OaSlamDetection& detection : detections) {
      for (size_t i = 0; i < kUnits.size() && detection.ellipse; ++i) {
        const Eigen::Vector2d size = 2.0 * HalfSize(*detection.ellipse, kUnits[i]);
        differences[i] += std::abs(size.x() - (detection.box[2] - detection.box[0])) +
                          std::abs(size.y() - (detection.box[3] - detection.box[1]));
      }
    }
  }
  const auto best = std::min_element(differences.begin(), differences.end());
  return kUnits[static_cast<size_t>(best - differences.begin())];
}

std::vector<Eigen::Vector2d> EllipseOutline(const std::array<double, 5>& ellipse,
                                            const EllipseUnits& units) {
  constexpr int kPoints = 64;
  const double turn = units.angle * ellipse[4];
  const Eigen::Vector2d first =
      units.axis * ellipse[2] * Eigen::Vector2d(std::cos(turn), std::sin(turn));
  const Eigen::Vector2d second =
      units.axis * ellipse[3] * Eigen::Vector2d(-std::sin(turn), std::cos(turn));
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    outline.push_back(Eigen::Vector2d(ellipse[0], ellipse[1]) + std::cos(angle) * first +
                      std::sin(angle) * second);
  }
  return outline;
}

template <size_t kCount>
bool AreUpTo(double most, const std::array<double, kCount>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](double number) { return std::abs(number) <= most; });
}

class OaSlamReader {
 public:
  explicit OaSlamReader(const MaskRequest& request)
      : request_(request), classes_(ReadClasses(request.path.parent_path())) {}

  OaSlamImages Read() {
    ForEachJsonRecord(request_.path, [&](const JsonRecord& record) { AddImage(record); });
    return std::move(images_);
  }

 private:
  void AddImage(const JsonRecord& record) {
    const Json& name = Member(record, record.value, "file_name");
    const Json& list = Member(record, record.value, "detections");
    if (!name.is_string() || !list.is_array()) {
      record.Fail("expected \"file_name\" to be a string and \"detections\" a list");
    }
    std::vector<OaSlamDetection>& detections = images_[ImageStem(name.get<std::string>())];
    for (const Json& json : list) {
      detections.push_back(ReadDetection(record, json));
    }
    detections_ += list.size();
    if (detections_ > kMostDetections) {
      record.Fail(fmt::format("more than {} detections in the file", kMostDetections));
    }
    if (detections.size() > kMostInstances) {
      record.Fail(fmt::format("too many instances, expected at most {} per frame", kMostInstances));
    }
  }

  OaSlamDetection ReadDetection(const JsonRecord& record, const Json& json) const {
    OaSlamDetection detection;
    detection.label = Label(record, Member(record, json, "category_id"));
    detection.score = ScoreOf(record, json);
    detection.box = Take<4>(record, Member(record, json, "bbox"), "bbox", "x1, y1, x2, y2");
    const auto& [left, top, right, bottom] = detection.box;
    if (!AreUpTo(kMostPixels, detection.box) || left > right || top > bottom) {
      record.Fail(fmt::format("bbox is {}, expected x1 <= x2 and y1 <= y2, up to {:g} px",
                              ShowJson(json["bbox"]), kMostPixels));
    }
    if (json.contains("ellipse")) {
      detection.ellipse = Take<5>(record, json["ellipse"], "ellipse", "cx, cy, a, b, angle");
      CheckEllipse(record, json["ellipse"], *detection.ellipse);
    }
    return detection;
  }

  // An ellipse may extend beyond the image, because an object may do so, but an ellipse that is
  // much larger than the image is an error of the file.
  void CheckEllipse(const JsonRecord& record, const Json& json,
                    const std::array<double, 5>& ellipse) const {
    constexpr double kMostDiagonals = 4.0;
    constexpr double kMostAngle = 360.0;
    const auto& [x, y, a, b, angle] = ellipse;
    if (a <= 0.0 || b <= 0.0) {
      record.Fail("ellipse is " + ShowJson(json) + ", expected axes > 0");
    }
    const double most = std::ceil(kMostDiagonals * std::hypot(request_.width, request_.height));
    if (!AreUpTo(most, std::array{x, y, a, b}) || !(std::abs(angle) <= kMostAngle)) {
      record.Fail(
          fmt::format("ellipse is {}, expected a centre and axes up to {:g} px for an image of "
                      "{}x{} px, and an angle up to {:g}",
                      ShowJson(json), most, request_.width, request_.height, kMostAngle));
    }
  }

  template <size_t kCount>
  static std::array<double, kCount> Take(const JsonRecord& record, const Json& json,
                                         const char* name, const char* expected) {
    const std::vector<double> numbers = Numbers(record, json, name);
    if (numbers.size() != kCount) {
      record.Fail(fmt::format("{} is {}, expected {}", name, ShowJson(json), expected));
    }
    std::array<double, kCount> taken{};
    std::copy(numbers.begin(), numbers.end(), taken.begin());
    return taken;
  }

  std::string Label(const JsonRecord& record, const Json& category) const {
    if (category.is_string() && !category.get_ref<const std::string&>().empty()) {
      return category.get<std::string>();
    }
    if (!category.is_number_unsigned() || category.get<uint64_t>() >= classes_.size()) {
      record.Fail(
          fmt::format("category_id is {}, expected an integer from 0 to {} (classes.txt "
                      "beside the file may name others) or a name",
                      ShowJson(category), classes_.size() - 1));
    }
    return classes_[category.get<size_t>()];
  }

  static constexpr size_t kMostDetections = 1'000'000;

  const MaskRequest& request_;
  std::vector<std::string> classes_;
  OaSlamImages images_;
  size_t detections_ = 0;
};

class OaSlamMasks : public MaskSource {
 public:
  explicit OaSlamMasks(const MaskRequest& request)
      : request_(request), images_(OaSlamReader(request).Read()), units_(FindUnits(images_)) {}

  std::string format() const override { return std::string(kOaSlamName); }
  bool Contains(const MaskFrame& frame) const override { return images_.contains(frame.stem); }
  std::string Example() const override { return images_.empty() ? "" : images_.begin()->first; }

  FrameMasks Read(const MaskFrame& frame) const override {
    FrameMasks result;
    const auto image = images_.find(frame.stem);
    result.is_missing = image == images_.end();
    if (result.is_missing) {
      return result;
    }
    for (const OaSlamDetection& detection : image->second) {
      const auto& [left, top, right, bottom] = detection.box;
      AddInstance(
          {.label = detection.label,
           .score = detection.score,
           .shape = detection.ellipse ? MaskShape::kEllipse : MaskShape::kBox,
           .outlines = {detection.ellipse ? EllipseOutline(*detection.ellipse, units_)
                                          : BoxOutline(left, top, right, bottom, request_)}},
          result);
    }
    return result;
  }

 private:
  MaskRequest request_;
  OaSlamImages images_;
  EllipseUnits units_;
};

constexpr std::array<std::string_view, 1> kOaSlamKeys = {"detections"};

}  // namespace

const MaskFormat kOaSlamFormat = {
    .name = kOaSlamName, .json_keys = kOaSlamKeys, .open = OpenAs<OaSlamMasks>};

}  // namespace hullslam
