// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_json.h"
#include "masks/mask_rle.h"

namespace hullslam {

// Parts of JSON files of COCO's form, which the formats coco and json share. The functions call
// record.Fail() for malformed values.

// An instance with its outlines or its runs. The outlines of runs are only computed when the frame
// is read, because runs need less memory and the computation takes time.
struct CocoInstance {
  InstanceMask mask;  // without label
  MaskRuns runs;      // empty if the file has outlines
};

// Reads score and segmentation; without a segmentation, the box. Without an outline of three points
// the instance has no area.
CocoInstance ReadCocoInstance(const JsonRecord& record, const MaskRequest& request);

// Whether the record is marked as a group of objects.
bool IsCrowd(const JsonRecord& record);

void AddCocoInstance(const CocoInstance& instance, const MaskRequest& request, FrameMasks& frame);

// An integer, or a text with one.
int64_t JsonInteger(const JsonRecord& record, const char* name);

// The records of the list "categories".
class CocoCategories {
 public:
  void Add(const JsonRecord& record);
  // The name of a category; without categories in the file, COCO's name. Without a category, the
  // name of the class, and "object" if there is neither.
  std::string NameOf(const JsonRecord& record, const std::optional<int64_t>& category,
                     const std::optional<std::string>& class_name) const;

 private:
  std::map<int64_t, std::string> names_;
};

}  // namespace hullslam
