// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/request_memory.h"

namespace hullslam {

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
