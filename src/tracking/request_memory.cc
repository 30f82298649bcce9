// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/request_memory.h"

namespace hullslam {

int RequestMemory::CountFruitless(const Map& map) {
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (object.state == ObjectState::kMapped && mapped_.insert(id).second) {
      requests_ = 0;
    }
  });
  return requests_;
}

}  // namespace hullslam
