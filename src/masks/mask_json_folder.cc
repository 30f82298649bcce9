// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_json_folder.h"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "files/json_file.h"
#include "masks/mask_checks.h"
#include "masks/mask_coco_instance.h"
#include "masks/mask_json.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

constexpr std::string_view kJsonFolderName = "json";
constexpr std::string_view kJsonExtension = ".json";

using Json = nlohmann::json;

// The instances of the file of one image.
class ImageReader {
 public:
  ImageReader(const MaskRequest& request, const std::filesystem::path& path)
      : request_(request), path_(path) {}

  FrameMasks Read() {
    ForEachJsonRecord(path_, [&](const JsonRecord& record) { Visit(record); });
    for (Annotation& annotation : annotations_) {  // categories may come later in the file
      const JsonRecord record{path_, annotation.section, annotation.index, {}};
      annotation.instance.mask.label =
          categories_.NameOf(record, annotation.category, annotation.class_name);
      AddCocoInstance(annotation.instance, request_, frame_);
    }
    return std::move(frame_);
  }

 private:
  struct Annotation {
    std::string section;
    size_t index = 0;
    std::optional<int64_t> category;
    std::optional<std::string> class_name;
    CocoInstance instance;
  };

  void Visit(const JsonRecord& record) {
    if (record.section == "categories") {
      categories_.Add(record);
    } else if (record.section == "shapes") {
      AddShape(record);
    } else if (record.section == "annotations" || record.section.empty()) {
      AddAnnotation(record);
    }
    if (HasTooMany(frame_) || annotations_.size() > kMostInstances) {
      record.Fail(fmt::format("too many instances, expected at most {} per frame", kMostInstances));
    }
  }

  void AddAnnotation(const JsonRecord& record) {
    if (IsCrowd(record)) {
      ++frame_.crowds;
      return;
    }
    Annotation annotation{.section = record.section,
                          .index = record.index,
                          .category = {},
                          .class_name = ClassNameOf(record.value),
                          .instance = ReadCocoInstance(record, request_)};
    if (record.value.contains("category_id")) {
      annotation.category = JsonInteger(record, "category_id");
    }
    annotations_.push_back(std::move(annotation));
  }

  // Shapes that enclose no area, such as points and lines, are only counted.
  void AddShape(const JsonRecord& record) {
    const std::string type = record.value.value("shape_type", Json("polygon")).dump();
    const std::optional<std::string> label = ClassNameOf(record.value);
    if (!label) {
      record.Fail("has no 'label', expected the name of a class");
    }
    InstanceMask mask{.label = *label, .score = ScoreOf(record, record.value), .outlines = {}};
    const std::vector<Eigen::Vector2d> points = Points(record);
    if (type == "\"rectangle\"" && points.size() >= 2) {
      const Eigen::Vector2d& a = points[0];
      const Eigen::Vector2d& b = points[points.size() / 2];  // the corner across, of 2 or of 4
      mask.shape = MaskShape::kBox;
      mask.outlines.push_back(BoxOutline(std::min(a.x(), b.x()), std::min(a.y(), b.y()),
                                         std::max(a.x(), b.x()), std::max(a.y(), b.y()), request_));
    } else if (type == "\"polygon\"" && points.size() >= 3) {
      mask.outlines.push_back(InCentres(record, points));
    }
    AddInstance(std::move(mask), frame_);
  }

  std::vector<Eigen::Vector2d> Points(const JsonRecord& record) const {
    const Json& list = Member(record, record.value, "points");
    if (!list.is_array() || list.size() > kMostOutlinePoints) {
      record.Fail(fmt::format("points is {}, expected a list of up to {} points", ShowJson(list),
                              kMostOutlinePoints));
    }
    std::vector<Eigen::Vector2d> points;
    for (const Json& point : list) {
      const std::vector<double> numbers = Numbers(record, point, "a point");
      if (numbers.size() != 2) {
        record.Fail("a point is " + ShowJson(point) + ", expected [x, y]");
      }
      points.emplace_back(numbers[0], numbers[1]);
    }
    return points;
  }

  // In the files, 0 is the border of the image.
  std::vector<Eigen::Vector2d> InCentres(const JsonRecord& record,
                                         std::vector<Eigen::Vector2d> points) const {
    for (Eigen::Vector2d& point : points) {
      point.array() -= 0.5;
      if (!IsNearImage(point, request_)) {
        record.Fail(fmt::format("point ({}, {}) is outside the image of {}x{} px", point.x() + 0.5,
                                point.y() + 0.5, request_.width, request_.height));
      }
    }
    return points;
  }

  const MaskRequest& request_;
  const std::filesystem::path& path_;
  CocoCategories categories_;
  std::vector<Annotation> annotations_;
  FrameMasks frame_;
};

class JsonFolderMasks : public MaskSource {
 public:
  explicit JsonFolderMasks(const MaskRequest& request)
      : request_(request), stems_(ListFiles(request.path, kJsonExtension)) {
    stems_.erase("classes");
  }

  std::string format() const override { return std::string(kJsonFolderName); }
  bool Contains(const MaskFrame& frame) const override { return stems_.contains(frame.stem); }
  std::string Example() const override {
    return stems_.empty() ? std::string() : *stems_.begin() + std::string(kJsonExtension);
  }

  FrameMasks Read(const MaskFrame& frame) const override {
    FrameMasks result;
    result.is_missing = !Contains(frame);
    if (result.is_missing) {
      return result;
    }
    const std::filesystem::path path = request_.path / (frame.stem + std::string(kJsonExtension));
    return ImageReader(request_, path).Read();
  }

 private:
  MaskRequest request_;
  std::set<std::string> stems_;
};

// A single file is rather that of all images.
bool IsJsonFolder(const MaskProbe& probe) {
  return probe.jsons > 1 && probe.texts == 0 && !probe.has_images;
}

std::unique_ptr<MaskSource> OpenJsonFolder(const MaskRequest& request) {
  return std::make_unique<JsonFolderMasks>(request);
}

}  // namespace

const MaskFormat kJsonFolderFormat = {
    .name = kJsonFolderName, .is_meant = IsJsonFolder, .open = OpenJsonFolder};

}  // namespace hullslam
