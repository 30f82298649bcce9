// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "files/json_file.h"
#include "hullslam/util/error.h"
#include "masks/mask_checks.h"
#include "masks/mask_coco_instance.h"
#include "masks/mask_format.h"
#include "masks/mask_json.h"
#include "masks/mask_rle.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr std::string_view kCocoName = "coco";

using Json = nlohmann::json;

struct CocoImage {
  std::vector<CocoInstance> instances;
  size_t crowds = 0;
};

// An annotation whose image and category may come later in the file.
struct CocoAnnotation {
  size_t index = 0;  // index in its list
  std::string image;
  std::optional<int64_t> category;
  std::optional<std::string> class_name;  // used if there is no category
  bool is_crowd = false;
  CocoInstance instance;
};

class CocoReader {
 public:
  explicit CocoReader(const MaskRequest& request) : request_(request) {}

  std::map<std::string, CocoImage> Read() {
    ForEachJsonRecord(request_.path, [&](const JsonRecord& record) { Visit(record); });
    std::map<std::string, CocoImage> images;
    for (const auto& [id, stem] : stems_) {
      images[stem];
    }
    for (CocoAnnotation& annotation : annotations_) {
      Finish(annotation, images);
    }
    return images;
  }

 private:
  void Visit(const JsonRecord& record) {
    if (record.section == "images") {
      AddImage(record);
    } else if (record.section == "categories") {
      categories_.Add(record);
    } else if (record.section.empty() || record.section == "annotations") {
      AddAnnotation(record);
    }
  }

  void AddImage(const JsonRecord& record) {
    const Json& name = Member(record, record.value, "file_name");
    if (!name.is_string()) {
      record.Fail("file_name is " + ShowJson(name) + ", expected a string");
    }
    for (const auto& [key, size] :
         {std::pair("width", request_.width), {"height", request_.height}}) {
      if (record.value.contains(key) && record.value[key] != size) {
        record.Fail(fmt::format("{} is {}, expected that of the images, {}", key,
                                ShowJson(record.value[key]), size));
      }
    }
    stems_[ImageId(record, "id")] = ImageStem(name.get<std::string>());
  }

  void AddAnnotation(const JsonRecord& record) {
    CocoAnnotation annotation;
    annotation.index = record.index;
    annotation.image = ImageId(record, "image_id");
    if (record.value.contains("category_id")) {
      annotation.category = JsonInteger(record, "category_id");
    }
    annotation.is_crowd = IsCrowd(record);
    annotation.class_name = ClassNameOf(record.value);
    if (!annotation.is_crowd) {
      annotation.instance = ReadCocoInstance(record, request_);
      CountBytes(record, annotation.instance);
    }
    annotations_.push_back(std::move(annotation));
  }

  // Limits the memory of all masks: a number of one digit in the file becomes eight bytes here.
  void CountBytes(const JsonRecord& record, const CocoInstance& instance) {
    constexpr size_t kMostBytes = 512'000'000;
    bytes_ += instance.runs.size() * sizeof(uint32_t);
    for (const auto& outline : instance.mask.outlines) {
      bytes_ += sizeof(outline) + outline.size() * sizeof(Eigen::Vector2d);
    }
    if (bytes_ > kMostBytes) {
      record.Fail(
          fmt::format("the masks up to here take more than {} MB; a format with one file "
                      "per frame needs less memory",
                      kMostBytes / 1'000'000));
    }
  }

  void Finish(CocoAnnotation& annotation, std::map<std::string, CocoImage>& images) const {
    const JsonRecord record{
        request_.path, stems_.empty() ? "" : "annotations", annotation.index, {}};
    const auto stem = stems_.find(annotation.image);
    if (!stems_.empty() && stem == stems_.end()) {
      record.Fail("image_id " + ShowText(annotation.image) + " is in no entry of 'images'");
    }
    CocoImage& image = images[stem == stems_.end() ? annotation.image : stem->second];
    annotation.instance.mask.label =
        categories_.NameOf(record, annotation.category, annotation.class_name);
    if (annotation.is_crowd) {
      ++image.crowds;
    } else {
      image.instances.push_back(std::move(annotation.instance));
    }
    if (image.instances.size() + image.crowds > kMostInstances) {
      record.Fail(fmt::format("too many instances, expected at most {} per frame", kMostInstances));
    }
  }

  // The id of an image as text: an integer in decimal, or the stem of a file name.
  static std::string ImageId(const JsonRecord& record, const char* name) {
    const Json& value = Member(record, record.value, name);
    if (!value.is_string() && !value.is_number_integer()) {
      record.Fail(fmt::format("{} is {}, expected an integer or a string", name, ShowJson(value)));
    }
    return value.is_string() ? ImageStem(value.get<std::string>()) : value.dump();
  }

  const MaskRequest& request_;
  std::map<std::string, std::string> stems_;  // of the images, by their ids
  CocoCategories categories_;
  std::vector<CocoAnnotation> annotations_;
  size_t bytes_ = 0;  // memory of all outlines and runs
};

class CocoMasks : public MaskSource {
 public:
  explicit CocoMasks(const MaskRequest& request)
      : request_(request), images_(CocoReader(request).Read()) {}

  std::string format() const override { return std::string(kCocoName); }
  bool Contains(const MaskFrame& frame) const override { return Find(frame) != images_.end(); }
  std::string Example() const override { return images_.empty() ? "" : images_.begin()->first; }

  FrameMasks Read(const MaskFrame& frame) const override {
    FrameMasks result;
    const auto image = Find(frame);
    result.is_missing = image == images_.end();
    if (result.is_missing) {
      return result;
    }
    result.crowds = image->second.crowds;
    for (const CocoInstance& instance : image->second.instances) {
      AddCocoInstance(instance, request_, result);
    }
    return result;
  }

 private:
  using Images = std::map<std::string, CocoImage>;  // by stem

  // If the file has no list of images, their ids may be numbers. Then a frame whose name has only
  // digits is found by its number: 000012 has the id 12.
  Images::const_iterator Find(const MaskFrame& frame) const {
    const auto image = images_.find(frame.stem);
    const bool is_number = frame.stem.find_first_not_of("0123456789") == std::string::npos;
    if (image != images_.end() || !is_number) {
      return image;
    }
    const size_t zeros = std::min(frame.stem.find_first_not_of('0'), frame.stem.size() - 1);
    return images_.find(frame.stem.substr(zeros));
  }

  MaskRequest request_;
  Images images_;
};

constexpr std::array<std::string_view, 2> kCocoKeys = {"annotations", "image_id"};

}  // namespace

const MaskFormat kCocoFormat = {
    .name = kCocoName, .json_keys = kCocoKeys, .open = OpenAs<CocoMasks>};

}  // namespace hullslam
