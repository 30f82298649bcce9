// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>

#include "hullslam/map/map.h"

namespace hullslam {

// Remembers how many keyframes were requested for the sake of objects without success.
class RequestMemory {
 public:
  // The number of requests since an object was last mapped that had never been mapped before. (An
  // object that is rejected and mapped again is no success.)
  int CountFruitless(const Map& map);
  void AddRequest() { ++requests_; }

 private:
  std::set<ObjectId> mapped_;  // all that were ever mapped
  int requests_ = 0;
};

}  // namespace hullslam
