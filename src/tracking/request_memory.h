// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <set>

#include "hullslam/map/map.h"

namespace hullslam {

// Remembers how many keyframes were requested for the sake of objects without success.
class RequestMemory {
 public:
  // The number of requests since an object was last mapped that had never been mapped before. (An
  // object that is rejected and mapped again is no success.) Looks through the objects only if the
  // map has another revision than before.
  int CountFruitless(const Map& map);
  void AddRequest() { ++requests_; }

 private:
  std::set<ObjectId> mapped_;         // all that were ever mapped
  std::optional<uint32_t> revision_;  // of the map that was looked at last
  int requests_ = 0;
};

}  // namespace hullslam
