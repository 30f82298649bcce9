// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <set>

#include "hullslam/map/map.h"

namespace hullslam {

// When a frame that shows things which are not mapped yet is made a keyframe because of them: there
// must be no other keyframe within this time.
struct ObjectRequestRule {
  double time = 1.0 / 3.0;  // s
  // Some detections can never be mapped. From this number of fruitless requests on, each further
  // one doubles the time, up to the largest factor.
  int patient_requests = 4;
  double max_time_factor = 16.0;

  // The time after so many fruitless requests, s.
  double TimeAfter(int fruitless_requests) const;
};

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
