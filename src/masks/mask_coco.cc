// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_coco.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "files/json_file.h"
#include "files/plausible.h"
#include "hullslam/util/error.h"
#include "masks/mask_checks.h"
#include "masks/mask_classes.h"
#include "masks/mask_json.h"
#include "masks/mask_rle.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

constexpr std::string_view kCocoName = "coco";

using Json = nlohmann::json;

constexpr const char* kNoClass = "object";  // for masks of SAM, which have no classes

// An instance with its outlines or its runs. The outlines of runs are only computed when the frame
// is read, because runs need less memory and the computation takes time.
struct CocoInstance {
  InstanceMask mask;
  MaskRuns runs;  // empty if the file has outlines
};

struct CocoImage {
  std::vector<CocoInstance> instances;
  size_t crowds = 0;
};

// An annotation whose image and category may come later in the file.
struct CocoAnnotation {
  size_t index = 0;  // index in its list
  std::string image;
  std::optional<int64_t> category;
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
      const Json& name = Member(record, record.value, "name");
      categories_[Integer(record, "id")] =
          name.is_string() ? name.get<std::string>() : ShowJson(name);
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
      annotation.category = Integer(record, "category_id");
    }
    annotation.is_crowd = record.value.value("iscrowd", Json(0)) == 1;
    if (!annotation.is_crowd) {
      annotation.instance.mask.score = ScoreOf(record, record.value, "score");
      ReadShape(record, annotation.instance);
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

  void ReadShape(const JsonRecord& record, CocoInstance& instance) const {
    const Json none = Json::array();
    const auto found = record.value.find("segmentation");
    const Json& segmentation = found == record.value.end() ? none : *found;
    if (segmentation.is_object()) {
      instance.runs = ReadRuns(record, segmentation);
    } else if (!segmentation.is_array()) {
      record.Fail("segmentation is " + ShowJson(segmentation) +
                  ", expected lists of coordinates or run lengths");
    } else if (!segmentation.empty()) {
      for (const Json& polygon : segmentation) {
        instance.mask.outlines.push_back(ReadPolygon(record, polygon));
      }
    } else {
      instance.mask.shape = MaskShape::kBox;
      instance.mask.outlines.push_back(ReadBox(record));
    }
  }

  // In COCO's coordinates the corners of pixels are integers: 0 is the border of the image.
  std::vector<Eigen::Vector2d> ReadPolygon(const JsonRecord& record, const Json& list) const {
    const std::vector<double> numbers = Numbers(record, list, "a polygon of segmentation");
    if (numbers.size() < 6 || numbers.size() % 2 != 0) {
      record.Fail(
          fmt::format("a polygon of segmentation has {} numbers, expected x and y of 3 "
                      "points or more",
                      numbers.size()));
    }
    std::vector<Eigen::Vector2d> outline(numbers.size() / 2);
    if (outline.size() > kMostOutlinePoints) {
      record.Fail(fmt::format("a polygon of segmentation has {} points, expected at most {}",
                              outline.size(), kMostOutlinePoints));
    }
    for (size_t i = 0; i < outline.size(); ++i) {
      outline[i] = {numbers[2 * i] - 0.5, numbers[2 * i + 1] - 0.5};
      if (!IsNearImage(outline[i], request_)) {
        record.Fail(fmt::format("point ({}, {}) of segmentation is outside the image of {}x{} px",
                                numbers[2 * i], numbers[2 * i + 1], request_.width,
                                request_.height));
      }
    }
    return outline;
  }

  std::vector<Eigen::Vector2d> ReadBox(const JsonRecord& record) const {
    const std::vector<double> box = Numbers(record, Member(record, record.value, "bbox"), "bbox");
    const bool is_plausible = std::all_of(
        box.begin(), box.end(), [](double number) { return std::abs(number) <= kMostPixels; });
    if (box.size() != 4 || !is_plausible || box[2] < 0.0 || box[3] < 0.0) {
      record.Fail(fmt::format("bbox is {}, expected x, y, width, height up to {:g} px",
                              ShowJson(record.value["bbox"]), kMostPixels));
    }
    return BoxOutline(box[0], box[1], box[0] + box[2], box[1] + box[3], request_);
  }

  MaskRuns ReadRuns(const JsonRecord& record, const Json& segmentation) const {
    const std::vector<double> size =
        Numbers(record, Member(record, segmentation, "size"), "size of segmentation");
    if (size != std::vector<double>{static_cast<double>(request_.height),
                                    static_cast<double>(request_.width)}) {
      record.Fail(
          fmt::format("size of segmentation is {}, expected height and width of the "
                      "images, [{},{}]",
                      ShowJson(segmentation["size"]), request_.height, request_.width));
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
        static_cast<uint64_t>(request_.width) * static_cast<uint64_t>(request_.height);
    if (pixels != expected) {
      record.Fail(fmt::format("counts of segmentation add up to {}, expected width x height, {}",
                              pixels, expected));
    }
    return std::move(*runs);
  }

  static std::optional<MaskRuns> ListRuns(const Json& counts) {
    const auto is_run = [](const Json& count) {
      return count.is_number_unsigned() && count.get<uint64_t>() <= UINT32_MAX;
    };
    if (!counts.is_array() || !std::all_of(counts.begin(), counts.end(), is_run)) {
      return std::nullopt;
    }
    return counts.get<MaskRuns>();
  }

  void Finish(CocoAnnotation& annotation, std::map<std::string, CocoImage>& images) const {
    const JsonRecord record{
        request_.path, stems_.empty() ? "" : "annotations", annotation.index, {}};
    const auto stem = stems_.find(annotation.image);
    if (!stems_.empty() && stem == stems_.end()) {
      record.Fail("image_id " + ShowText(annotation.image) + " is in no entry of 'images'");
    }
    CocoImage& image = images[stem == stems_.end() ? annotation.image : stem->second];
    annotation.instance.mask.label = Label(record, annotation.category);
    if (annotation.is_crowd) {
      ++image.crowds;
    } else {
      image.instances.push_back(std::move(annotation.instance));
    }
    if (image.instances.size() + image.crowds > kMostInstances) {
      record.Fail(fmt::format("too many instances, expected at most {} per frame", kMostInstances));
    }
  }

  std::string Label(const JsonRecord& record, const std::optional<int64_t>& category) const {
    if (!category) {
      return kNoClass;
    }
    if (categories_.empty()) {
      const std::optional<std::string> label = CocoCategory(*category);
      if (!label) {
        record.Fail(
            fmt::format("category_id is {}, expected one of COCO's (1 to 90 with gaps) or a "
                        "list 'categories' in the file",
                        *category));
      }
      return *label;
    }
    const auto found = categories_.find(*category);
    if (found == categories_.end()) {
      record.Fail(fmt::format("category_id {} is in no entry of 'categories'", *category));
    }
    return found->second;
  }

  static int64_t Integer(const JsonRecord& record, const char* name) {
    const Json& value = Member(record, record.value, name);
    const bool is_too_large =
        value.is_number_unsigned() &&
        value.get<uint64_t>() > static_cast<uint64_t>(std::numeric_limits<int64_t>::max());
    if (!value.is_number_integer() || is_too_large) {
      record.Fail(fmt::format("{} is {}, expected an integer", name, ShowJson(value)));
    }
    return value.get<int64_t>();
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
  std::map<int64_t, std::string> categories_;
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
      InstanceMask mask = instance.mask;
      if (!instance.runs.empty()) {
        mask.outlines = OutlineRuns(instance.runs, request_.width, request_.height);
      }
      AddInstance(std::move(mask), result);
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

std::unique_ptr<MaskSource> OpenCoco(const MaskRequest& request) {
  return std::make_unique<CocoMasks>(request);
}

}  // namespace

const MaskFormat kCocoFormat = {.name = kCocoName, .json_keys = kCocoKeys, .open = OpenCoco};

}  // namespace hullslam
