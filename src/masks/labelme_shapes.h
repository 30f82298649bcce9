// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_json.h"

namespace hullslam {

// The shapes of LabelMe and X-AnyLabeling in the file of one image: polygons, rectangles, turned
// rectangles ("rotation", "oriented_rectangle"), circles, and masks as PNG. Shapes that enclose no
// area, such as points and lines, are instances without an outline. Shapes of one label with the
// same group_id are the parts of one instance.
class LabelMeShapes {
 public:
  explicit LabelMeShapes(const MaskRequest& request) : request_(request) {}

  // Calls record.Fail() for a malformed shape.
  void Add(const JsonRecord& record);
  // The number of instances so far.
  size_t size() const { return instances_.size(); }
  // The instances in the order of their first shapes.
  std::vector<InstanceMask> Take() { return std::move(instances_); }

 private:
  void AddOutlines(const JsonRecord& record, InstanceMask& mask) const;

  const MaskRequest& request_;
  std::vector<InstanceMask> instances_;
  std::map<std::pair<std::string, std::string>, size_t> groups_;  // indices, by label and group
};

}  // namespace hullslam
