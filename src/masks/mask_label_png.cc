// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "files/json_file.h"
#include "files/read_file.h"
#include "files/text_rows.h"
#include "frame/detection/mask_outline.h"
#include "hullslam/frame/mask_image.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "masks/mask_checks.h"
#include "masks/mask_format.h"
#include "masks/mask_text.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr std::string_view kLabelPngName = "label-png";

using Json = nlohmann::json;

constexpr size_t kMostClassesBytes = 16'000'000;
constexpr const char* kClassesFile = "classes.json";

using InstanceClasses = std::map<int, InstanceClass>;

// The classes of all frames, and the classes of single frames, which take precedence.
struct LabelClasses {
  InstanceClasses of_all;
  std::map<std::string, InstanceClasses> of_frame;
};

class ClassesReader {
 public:
  explicit ClassesReader(std::filesystem::path path) : path_(std::move(path)) {}

  LabelClasses Read() const {
    const Json json = ReadJson(path_, {.most_bytes = kMostClassesBytes});
    CheckObject(json, "the file");
    LabelClasses classes;
    for (const auto& [key, value] : json.items()) {
      if (key != "frames") {
        Add(key, value, classes.of_all);
        continue;
      }
      CheckObject(value, "frames");
      for (const auto& [stem, instances] : value.items()) {
        CheckObject(instances, "frames." + ShowText(stem));
        for (const auto& [instance, entry] : instances.items()) {
          Add(instance, entry, classes.of_frame[stem]);
        }
      }
    }
    return classes;
  }

 private:
  void CheckObject(const Json& json, const std::string& what) const {
    if (!json.is_object()) {
      throw InputError(fmt::format("{}: {} is {}, expected an object {{\"1\": \"cup\"}}",
                                   path_.string(), what, ShowJson(json)));
    }
  }

  void Add(const std::string& key, const Json& value, InstanceClasses& classes) const {
    double number = 0.0;
    if (!ParseFinite(key, number) || !(number >= 1.0 && number <= 65535.0) ||
        number != static_cast<int>(number)) {
      throw InputError(fmt::format("{}: key '{}', expected the number of an instance, 1 to 65535",
                                   path_.string(), ShowText(key)));
    }
    InstanceClass& entry = classes[static_cast<int>(number)];
    const Json& label = value.is_object() && value.contains("class") ? value["class"] : value;
    if (!label.is_string() || label.get<std::string>().empty()) {
      throw InputError(
          fmt::format("{}: instance {} is {}, expected \"cup\" or {{\"class\": \"cup\", "
                      "\"score\": 0.9}}",
                      path_.string(), ShowText(key), ShowJson(value)));
    }
    entry.label = label.get<std::string>();
    if (value.is_object() && value.contains("score")) {
      entry.score = value["score"].is_number() ? value["score"].get<double>() : -1.0;
      if (!(entry.score >= 0.0 && entry.score <= 1.0)) {
        throw InputError(
            fmt::format("{}: score of instance {} is {}, expected a number from 0 to 1",
                        path_.string(), ShowText(key), ShowJson(value["score"])));
      }
    }
  }

  std::filesystem::path path_;
};

// The type of a PNG image in its first chunk: bytes 24 and 25 of the file.
struct PngType {
  int bits = 0;    // per channel
  int colour = 0;  // 0: grey; 3: a palette
};

PngType TypeOf(std::string_view bytes) {
  return bytes.size() < 26 ? PngType() : PngType{bytes[24], bytes[25]};
}

// The index of each colour of the palette. The chunk PLTE has three bytes per colour. A chunk is
// its length, its name, its data, and a sum of four bytes. The first one follows eight bytes.
std::map<std::array<uint8_t, 3>, int> PaletteOf(const std::filesystem::path& path,
                                                std::string_view bytes) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(bytes[i]); };
  std::map<std::array<uint8_t, 3>, int> palette;
  for (size_t at = 8; at + 8 <= bytes.size();) {
    const size_t length =
        size_t{byte(at)} << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
    if (length > bytes.size() - at - 8) {
      break;
    }
    for (size_t i = 0; bytes.substr(at + 4, 4) == "PLTE" && i + 3 <= length; i += 3) {
      const size_t colour = at + 8 + i;
      if (!palette.emplace(std::array{byte(colour + 2), byte(colour + 1), byte(colour)}, i / 3)
               .second) {
        throw InputError(
            fmt::format("{}: two entries of its palette have the same colour, so its "
                        "numbers are unclear; expected a grey PNG",
                        path.string()));
      }
    }
    at += length + 12;
  }
  return palette;
}

// The numbers of a palette PNG, which OpenCV can only decode to colours.
cv::Mat DecodePalette(const std::filesystem::path& path, std::string_view bytes) {
  const cv::Mat colours = DecodeColourImage(path, bytes);
  const std::map<std::array<uint8_t, 3>, int> palette = PaletteOf(path, bytes);
  cv::Mat labels(colours.size(), CV_8UC1);
  for (int y = 0; y < colours.rows; ++y) {
    for (int x = 0; x < colours.cols; ++x) {
      const auto& bgr = colours.at<cv::Vec3b>(y, x);
      const auto index = palette.find({bgr[0], bgr[1], bgr[2]});
      if (index == palette.end()) {
        throw InputError(path.string() + ": has a pixel whose colour is not in its palette");
      }
      labels.at<uint8_t>(y, x) = static_cast<uint8_t>(index->second);
    }
  }
  return labels;
}

cv::Mat ReadLabels(const std::filesystem::path& path) {
  constexpr size_t kMostBytes = 512'000'000;
  constexpr int kGrey = 0;
  constexpr int kPalette = 3;
  const std::string bytes = ReadFile(path, kMostBytes);
  const PngType type = TypeOf(bytes);
  if (type.colour == kPalette) {
    return DecodePalette(path, bytes);
  }
  return type.colour == kGrey && type.bits == 8 ? DecodeGreyImage(path, bytes)
                                                : ReadLabelImage(path);
}

// The number that a name consists of: 7 for "00007".
std::optional<size_t> NumberOf(const std::string& stem) {
  size_t number = 0;
  const char* const end = stem.data() + stem.size();
  const auto [rest, error] = std::from_chars(stem.data(), end, number);
  return error == std::errc() && rest == end ? std::optional(number) : std::nullopt;
}

class LabelPngMasks : public MaskSource {
 public:
  explicit LabelPngMasks(const MaskRequest& request)
      : request_(request),
        stems_(ListFiles(request.path, ".png")),
        classes_(ClassesReader(request.path / kClassesFile).Read()) {
    for (const std::string& stem : stems_) {
      if (const auto number = NumberOf(stem)) {
        by_number_[*number] = stem;
      }
    }
    // Nothing tells which image files belong to if they are numbered from elsewhere, or if some
    // only happen to be numbers.
    if (by_number_.size() < stems_.size() || !by_number_.contains(0)) {
      by_number_.clear();
    }
  }

  std::string format() const override { return std::string(kLabelPngName); }
  bool Contains(const MaskFrame& frame) const override { return !StemOf(frame).empty(); }
  std::string Example() const override { return stems_.empty() ? "" : *stems_.begin() + ".png"; }

  FrameMasks Read(const MaskFrame& frame) const override {
    FrameMasks result;
    result.is_missing = !Contains(frame);
    if (result.is_missing) {
      return result;
    }
    const cv::Mat labels = Load(frame);
    for (auto& [number, outlines] : FindLabelOutlines(labels)) {
      const InstanceClass& entry = ClassOf(frame, number);
      AddInstance({.label = entry.label, .score = entry.score, .outlines = std::move(outlines)},
                  result);
      if (HasTooMany(result)) {
        throw InputError(fmt::format("{}: too many instances, expected at most {} per frame",
                                     Path(frame).string(), kMostInstances));
      }
    }
    return result;
  }

 private:
  // The name of a frame's file without ".png"; empty if there is none. SAM 2 numbers its files from
  // 00000. Where the images are numbers as well, theirs count.
  std::string StemOf(const MaskFrame& frame) const {
    if (stems_.contains(frame.stem)) {
      return frame.stem;
    }
    const auto found = by_number_.find(NumberOf(frame.stem).value_or(frame.number));
    return found == by_number_.end() ? std::string() : found->second;
  }

  std::filesystem::path Path(const MaskFrame& frame) const {
    return request_.path / (StemOf(frame) + ".png");
  }

  cv::Mat Load(const MaskFrame& frame) const {
    const std::filesystem::path path = Path(frame);
    cv::Mat labels = ReadLabels(path);
    if (labels.cols != request_.width || labels.rows != request_.height) {
      throw InputError(fmt::format("{}: {}x{} px, expected the size of the images, {}x{}",
                                   path.string(), labels.cols, labels.rows, request_.width,
                                   request_.height));
    }
    return labels;
  }

  const InstanceClass& ClassOf(const MaskFrame& frame, int number) const {
    const auto of_frame = classes_.of_frame.find(StemOf(frame));
    if (of_frame != classes_.of_frame.end()) {
      const auto entry = of_frame->second.find(number);
      if (entry != of_frame->second.end()) {
        return entry->second;
      }
    }
    const auto entry = classes_.of_all.find(number);
    if (entry == classes_.of_all.end()) {
      throw InputError(
          fmt::format("{}: instance {} is not in {}", Path(frame).string(), number, kClassesFile));
    }
    return entry->second;
  }

  MaskRequest request_;
  std::set<std::string> stems_;
  std::map<size_t, std::string> by_number_;  // only if files are numbered from 0
  LabelClasses classes_;
};

bool IsLabelPng(const MaskProbe& probe) { return probe.has_images && probe.has_classes_json; }

}  // namespace

const MaskFormat kLabelPngFormat = {
    .name = kLabelPngName, .is_meant = IsLabelPng, .open = OpenAs<LabelPngMasks>};

}  // namespace hullslam
