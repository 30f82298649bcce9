// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_window.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <set>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "optim/object_bundle.h"

namespace hullslam {
namespace {

// At most `count` keyframes (0: all) that observe the landmarks and are not in `inside` (sorted),
// those with most observations first.
std::vector<KeyframeId> OuterObservers(const Map& map, const std::vector<LandmarkId>& landmarks,
                                       const std::vector<KeyframeId>& inside, size_t count) {
  std::vector<Covisible> outer = CountObservers(map, landmarks);
  std::erase_if(outer, [&](const Covisible& keyframe) {
    return std::ranges::binary_search(inside, keyframe.keyframe);
  });
  if (count > 0) {
    outer.resize(std::min(outer.size(), count));
  }
  std::vector<KeyframeId> ids;
  for (const Covisible& keyframe : outer) {
    ids.push_back(keyframe.keyframe);
  }
  return ids;
}

bool ConstrainsPoses(const ObjectLandmark& object) {
  return object.state == ObjectState::kMapped && object.has_shape;
}

std::vector<ObjectId> ObservedObjects(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::set<ObjectId> objects;
  for (const KeyframeId keyframe : keyframes) {
    for (const ObjectId object : map.keyframes().At(keyframe).objects) {
      if (object.IsValid() && ConstrainsPoses(map.objects().At(object))) {
        objects.insert(object);
      }
    }
  }
  return {objects.begin(), objects.end()};
}

}  // namespace

BundleWindow LocalWindow(const Map& map, KeyframeId center, size_t max_moving, size_t max_fixed,
                         WindowObjects objects) {
  BundleWindow window;
  window.moving = BestCovisible(map.keyframes().At(center), std::max<size_t>(max_moving, 1) - 1);
  window.moving.push_back(center);
  std::sort(window.moving.begin(), window.moving.end());
  window.landmarks = ObservedLandmarks(map, window.moving);
  window.fixed = OuterObservers(map, window.landmarks, window.moving, max_fixed);

  const bool has_root = !map.keyframes().At(window.moving.front()).parent.IsValid();
  if (has_root || window.fixed.empty()) {
    window.fixed.push_back(window.moving.front());
    window.moving.erase(window.moving.begin());
  }
  const auto tied = std::stable_partition(window.moving.begin(), window.moving.end(),
                                          [&](KeyframeId id) { return !IsTied(map, id); });
  window.fixed.insert(window.fixed.end(), tied, window.moving.end());
  window.moving.erase(tied, window.moving.end());
  std::sort(window.fixed.begin(), window.fixed.end());
  if (objects == WindowObjects::kMapped) {
    window.objects = ObservedObjects(map, window.moving);
  }
  return window;
}

WindowObjects ObjectsToAdjust(const ObjectOptions& options) {
  const bool are_used = options.enabled && options.bundle_adjustment;
  return are_used ? WindowObjects::kMapped : WindowObjects::kNone;
}

BundleWindow GlobalWindow(const Map& map, IslandId island, WindowObjects objects) {
  BundleWindow window;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.island == island) {
      const bool is_held = !keyframe.parent.IsValid() || IsTied(map, id);
      (is_held ? window.fixed : window.moving).push_back(id);
    }
  });
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if (IslandOf(map, landmark.reference) == island) {
      window.landmarks.push_back(id);
    }
  });
  if (objects == WindowObjects::kMapped) {
    window.objects = ObservedObjects(map, window.moving);
  }
  return window;
}

void SortForElimination(const Map& map, BundleWindow& window) {
  const auto size = static_cast<int>(window.moving.size());
  const internal::PoseIndices places = internal::IndexPoses(window);
  std::vector<Eigen::Triplet<double>> edges;
  for (int i = 0; i < size; ++i) {
    edges.emplace_back(i, i, 1.0);  // Eigen's ordering needs the diagonal
    const KeyframeId id = window.moving[static_cast<size_t>(i)];
    for (const Covisible& other : map.keyframes().At(id).covisible) {
      const size_t* const place = places.Find(other.keyframe);
      if (place != nullptr && *place < window.moving.size()) {
        edges.emplace_back(i, static_cast<int>(*place), 1.0);
      }
    }
  }
  Eigen::SparseMatrix<double> graph(size, size);
  graph.setFromTriplets(edges.begin(), edges.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  const std::vector<KeyframeId> before = window.moving;
  std::ranges::transform(order.indices(), window.moving.begin(),
                         [&](int place) { return before[static_cast<size_t>(place)]; });
}

}  // namespace hullslam
