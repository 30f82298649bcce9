// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/change_groundtruth.h"

#include <optional>
#include <vector>

namespace hullslam {
namespace {

// A change of one true object: where it was, where it is, or both.
struct TrueChange {
  std::optional<Eigen::Vector3d> former = std::nullopt;
  std::optional<Eigen::Vector3d> now = std::nullopt;
  double reach = 0.0;  // m, from its centre to that of a mapped object
};

std::optional<Eigen::Vector3d> CenterOf(const std::optional<ObjectPlace>& place,
                                        const Rigid3& truth_from_map) {
  return place ? std::optional(truth_from_map * place->ellipsoid.world_from_object.translation)
               : std::nullopt;
}

bool AreOne(const std::optional<Eigen::Vector3d>& truth,
            const std::optional<Eigen::Vector3d>& reported, double reach) {
  return !truth || (reported && (*truth - *reported).norm() <= reach);
}

// Each reported change is right if it is that of a true change that no earlier one was.
ChangeCounts Count(const std::vector<TrueChange>& truths, const std::vector<TrueChange>& reported) {
  ChangeCounts counts{truths.size(), reported.size(), 0};
  std::vector<bool> is_used(truths.size(), false);
  for (const TrueChange& change : reported) {
    for (size_t i = 0; i < truths.size(); ++i) {
      if (!is_used[i] && AreOne(truths[i].former, change.former, truths[i].reach) &&
          AreOne(truths[i].now, change.now, truths[i].reach)) {
        is_used[i] = true;
        ++counts.right;
        break;
      }
    }
  }
  return counts;
}

}  // namespace

ChangeComparison CompareChanges(const TrueScene& scene, std::span<const ChangedObject> changes,
                                const Rigid3& truth_from_map, std::span<const size_t> sightings,
                                size_t min_sightings) {
  std::vector<TrueChange> moved, gone, added, left, taken;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const TrueObject& object = scene.objects[i];
    const bool is_seen = sightings.empty() || sightings[i] >= min_sightings;
    const Eigen::Vector3d now = object.world_from_object.translation;
    const double reach = 0.5 * object.Size();
    if (object.is_dynamic || !is_seen) {
      continue;
    }
    if (object.status == TrueObjectStatus::kMoved) {
      const Eigen::Vector3d former = object.former_world_from_object->translation;
      moved.push_back({former, now, reach});
      left.push_back({former, std::nullopt, reach});
      taken.push_back({std::nullopt, now, reach});
    } else if (object.status == TrueObjectStatus::kNew) {
      added.push_back({std::nullopt, now, reach});
      taken.push_back(added.back());
    }
  }
  for (const TrueObject& object : scene.gone) {
    gone.push_back({object.world_from_object.translation, std::nullopt, 0.5 * object.Size()});
    left.push_back(gone.back());
  }
  std::vector<TrueChange> said_moved, said_gone, said_added, said_left, said_taken;
  for (const ChangedObject& changed : changes) {
    const TrueChange said{CenterOf(changed.former, truth_from_map),
                          CenterOf(changed.now, truth_from_map), 0.0};
    if (changed.change == ObjectChange::kMoved) {
      said_moved.push_back(said);
      said_left.push_back(said);
      said_taken.push_back(said);
    } else if (changed.change == ObjectChange::kGone) {
      said_gone.push_back(said);
      said_left.push_back(said);
    } else if (changed.change == ObjectChange::kNew) {
      said_added.push_back(said);
      said_taken.push_back(said);
    }
  }
  return {Count(moved, said_moved), Count(gone, said_gone), Count(added, said_added),
          Count(left, said_left), Count(taken, said_taken)};
}

}  // namespace hullslam
