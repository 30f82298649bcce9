// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "masks/labelme_shapes.h"
#include "masks/mask_checks.h"
#include "masks/mask_coco_instance.h"
#include "masks/mask_format.h"
#include "masks/mask_json.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

constexpr std::string_view kJsonFolderName = "json";
constexpr std::string_view kJsonExtension = ".json";

// The instances of the file of one image.
class ImageReader {
 public:
  ImageReader(const MaskRequest& request, const std::filesystem::path& path)
      : request_(request), path_(path), shapes_(request) {}

  FrameMasks Read() {
    ForEachJsonRecord(path_, [&](const JsonRecord& record) { Visit(record); });
    for (Annotation& annotation : annotations_) {  // categories may come later in the file
      const JsonRecord record{path_, annotation.section, annotation.index, {}};
      annotation.instance.mask.label =
          categories_.NameOf(record, annotation.category, annotation.class_name);
      AddCocoInstance(annotation.instance, request_, frame_);
    }
    for (InstanceMask& mask : shapes_.Take()) {
      AddInstance(std::move(mask), frame_);
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
      shapes_.Add(record);
    } else if (record.section == "annotations" || record.section.empty()) {
      AddAnnotation(record);
    }
    if (frame_.crowds + annotations_.size() + shapes_.size() > kMostInstances) {
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

  const MaskRequest& request_;
  const std::filesystem::path& path_;
  CocoCategories categories_;
  std::vector<Annotation> annotations_;
  LabelMeShapes shapes_;
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

// A single file that is not named as a frame rather belongs to all images. LabelMe's files are
// beside the images.
bool IsJsonFolder(const MaskProbe& probe) {
  const bool is_label_png = probe.has_images && probe.has_classes_json;
  return (probe.jsons > 1 || (probe.jsons == 1 && probe.has_names_of_frames)) && probe.texts == 0 &&
         !is_label_png;
}

}  // namespace

const MaskFormat kJsonFolderFormat = {
    .name = kJsonFolderName, .is_meant = IsJsonFolder, .open = OpenAs<JsonFolderMasks>};

}  // namespace hullslam
