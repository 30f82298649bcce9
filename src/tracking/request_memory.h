// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <set>

#include "hullslam/map/map.h"

namespace hullslam {

// Counts the keyframes that were requested because of objects and led to no new mapped object.
class RequestMemory {
 public:
  // The number of requests since an object was last mapped for the first time. (An object that is
  // rejected and mapped again does not count as success.) Visits the objects only if the revision
  // of the map has changed.
  int CountFruitless(const Map& map);
  void AddRequest() { ++requests_; }

 private:
  std::set<ObjectId> mapped_;         // all objects that were ever mapped
  std::optional<uint32_t> revision_;  // revision of the map at the last call
  int requests_ = 0;
};

}  // namespace hullslam
