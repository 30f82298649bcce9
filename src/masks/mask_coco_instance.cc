// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_coco_instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "files/json_file.h"
#include "files/plausible.h"
#include "masks/mask_checks.h"
#include "masks/mask_classes.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

constexpr const char* kNoClass = "object";  // for masks of SAM, which have no classes

// In COCO's coordinates the corners of pixels are integers: 0 is the border of the image. A polygon
// of a point or two has no area; networks write such polygons for small masks.
std::vector<Eigen::Vector2d> ReadPolygon(const JsonRecord& record, const Json& list,
                                         const MaskRequest& request) {
  const std::vector<double> numbers = Numbers(record, list, "a polygon of segmentation");
  if (numbers.size() % 2 != 0) {
    record.Fail(fmt::format("a polygon of segmentation has {} numbers, expected x and y of points",
                            numbers.size()));
  }
  std::vector<Eigen::Vector2d> outline(numbers.size() / 2);
  if (outline.size() > kMostOutlinePoints) {
    record.Fail(fmt::format("a polygon of segmentation has {} points, expected at most {}",
                            outline.size(), kMostOutlinePoints));
  }
  for (size_t i = 0; i < outline.size(); ++i) {
    outline[i] = {numbers[2 * i] - 0.5, numbers[2 * i + 1] - 0.5};
    if (!IsNearImage(outline[i], request)) {
      record.Fail(fmt::format("point ({}, {}) of segmentation is outside the image of {}x{} px",
                              numbers[2 * i], numbers[2 * i + 1], request.width, request.height));
    }
  }
  return outline;
}

std::vector<Eigen::Vector2d> ReadBox(const JsonRecord& record, const MaskRequest& request) {
  const std::vector<double> box = Numbers(record, Member(record, record.value, "bbox"), "bbox");
  const bool is_plausible = std::all_of(
      box.begin(), box.end(), [](double number) { return std::abs(number) <= kMostPixels; });
  if (box.size() != 4 || !is_plausible || box[2] < 0.0 || box[3] < 0.0) {
    record.Fail(fmt::format("bbox is {}, expected x, y, width, height up to {:g} px",
                            ShowJson(record.value["bbox"]), kMostPixels));
  }
  return BoxOutline(box[0], box[1], box[0] + box[2], box[1] + box[3], request);
}

std::optional<MaskRuns> ListRuns(const Json& counts) {
  const auto is_run = [](const Json& count) {
    return count.is_number_unsigned() && count.get<uint64_t>() <= UINT32_MAX;
  };
  if (!counts.is_array() || !std::all_of(counts.begin(), counts.end(), is_run)) {
    return std::nullopt;
  }
  return counts.get<MaskRuns>();
}

MaskRuns ReadRuns(const JsonRecord& record, const Json& segmentation, const MaskRequest& request) {
  const std::vector<double> size =
      Numbers(record, Member(record, segmentation, "size"), "size of segmentation");
  if (size != std::vector<double>{static_cast<double>(request.height),
                                  static_cast<double>(request.width)}) {
    record.Fail(
        fmt::format("size of segmentation is {}, expected height and width of the "
                    "images, [{},{}]",
                    ShowJson(segmentation["size"]), request.height, request.width));
  }
  const Json& counts = Member(record, segmentation, "counts");
  std::optional<MaskRuns> runs =
      counts.is_string() ? DecodeRuns(counts.get_ref<const std::string&>()) : ListRuns(counts);
  if (!runs) {
    record.Fail("counts of segmentation are " + ShowJson(counts) +
                ", expected a list of integers >= 0 or a string in COCO's compressed form");
  }
  const uint64_t pixels = CountPixels(*runs);
  const uint64_t expected =
      static_cast<uint64_t>(request.width) * static_cast<uint64_t>(request.height);
  if (pixels != expected) {
    record.Fail(fmt::format("counts of segmentation add up to {}, expected width x height, {}",
                            pixels, expected));
  }
  return std::move(*runs);
}

}  // namespace

CocoInstance ReadCocoInstance(const JsonRecord& record, const MaskRequest& request) {
  CocoInstance instance;
  instance.mask.score = ScoreOf(record, record.value);
  const auto found = record.value.find("segmentation");
  const Json none;
  const Json& segmentation = found == record.value.end() ? none : *found;
  if (segmentation.is_object()) {
    instance.runs = ReadRuns(record, segmentation, request);
  } else if (!segmentation.is_array() && !segmentation.is_null()) {
    record.Fail("segmentation is " + ShowJson(segmentation) +
                ", expected lists of coordinates or run lengths");
  } else if (!segmentation.empty()) {
    for (const Json& polygon : segmentation) {
      std::vector<Eigen::Vector2d> outline = ReadPolygon(record, polygon, request);
      if (outline.size() >= 3) {
        instance.mask.outlines.push_back(std::move(outline));
      }
    }
  } else if (segmentation.is_array() || record.value.contains("bbox")) {
    instance.mask.shape = MaskShape::kBox;
    instance.mask.outlines.push_back(ReadBox(record, request));
  } else if (found == record.value.end()) {
    record.Fail("has neither 'segmentation' nor 'bbox'");
  }
  return instance;
}

bool IsCrowd(const JsonRecord& record) {
  const Json crowd = record.value.value("iscrowd", Json(0));
  return crowd == 1 || crowd == true;
}

void AddCocoInstance(const CocoInstance& instance, const MaskRequest& request, FrameMasks& frame) {
  InstanceMask mask = instance.mask;
  if (!instance.runs.empty()) {
    mask.outlines = OutlineRuns(instance.runs, request.width, request.height);
  }
  AddInstance(std::move(mask), frame);
}

int64_t JsonInteger(const JsonRecord& record, const char* name) {
  const Json& value = Member(record, record.value, name);
  int64_t number = 0;
  if (value.is_string()) {
    const std::string& text = value.get_ref<const std::string&>();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && end == text.data() + text.size()) {
      return number;
    }
  }
  const bool is_too_large =
      value.is_number_unsigned() &&
      value.get<uint64_t>() > static_cast<uint64_t>(std::numeric_limits<int64_t>::max());
  if (!value.is_number_integer() || is_too_large) {
    record.Fail(fmt::format("{} is {}, expected an integer", name, ShowJson(value)));
  }
  return value.get<int64_t>();
}

void CocoCategories::Add(const JsonRecord& record) {
  const Json& name = Member(record, record.value, "name");
  names_[JsonInteger(record, "id")] = name.is_string() ? name.get<std::string>() : ShowJson(name);
}

std::string CocoCategories::NameOf(const JsonRecord& record, const std::optional<int64_t>& category,
                                   const std::optional<std::string>& class_name) const {
  if (!category) {
    return class_name.value_or(kNoClass);
  }
  if (names_.empty()) {
    const std::optional<std::string> label = CocoCategory(*category);
    if (!label) {
      record.Fail(
          fmt::format("category_id is {}, expected one of COCO's (1 to 90 with gaps) or a "
                      "list 'categories' in the file",
                      *category));
    }
    return *label;
  }
  const auto found = names_.find(*category);
  if (found == names_.end()) {
    record.Fail(fmt::format("category_id {} is in no entry of 'categories'", *category));
  }
  return found->second;
}

}  // namespace hullslam
