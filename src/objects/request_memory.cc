// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/request_memory.h"

#include <algorithm>
#include <cmath>

namespace hullslam {

double ObjectRequestRule::TimeAfter(int fruitless_requests) const {
  const double time_factor =
      std::min(max_time_factor, std::exp2(fruitless_requests - patient_requests + 1));
  return time * std::max(1.0, time_factor);
}

int RequestMemory::CountFruitless(const Map& map) {
  const bool is_snapshot = map.revision() != 0;  // any other map may change
  if (is_snapshot && revision_ == map.revision()) {
    return requests_;
  }
  revision_ = map.revision();
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (object.state == ObjectState::kMapped && mapped_.insert(id).second) {
      requests_ = 0;
    }
  });
  return requests_;
}

}  // namespace hullslam
