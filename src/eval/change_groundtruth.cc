// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>
#include <vector>

#include "eval/object_groundtruth.h"

namespace hullslam {
namespace {

// A change of one object, true or reported: its centre before, after, or both.
struct LocationChange {
  std::optional<Eigen::Vector3d> former = std::nullopt;
  std::optional<Eigen::Vector3d> now = std::nullopt;
  double reach = 0.0;  // m; how far a reported centre may be away; only of true objects
};

std::optional<Eigen::Vector3d> CenterOf(const std::optional<LocatedObject>& object,
                                        const Sim3& truth_from_map) {
  return object ? std::optional(truth_from_map * object->ellipsoid.world_from_object.translation)
                : std::nullopt;
}

bool AreOne(const std::optional<Eigen::Vector3d>& truth,
            const std::optional<Eigen::Vector3d>& reported, double reach) {
  return !truth || (reported && (*truth - *reported).norm() <= reach);
}

// Counts right reports. A reported change is right if it agrees with a true change that no earlier
// reported change agrees with.
ChangeCounts Count(const std::vector<LocationChange>& truths,
                   const std::vector<LocationChange>& reported) {
  ChangeCounts counts{truths.size(), reported.size(), 0};
  std::vector<bool> is_used(truths.size(), false);
  for (const LocationChange& change : reported) {
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

// Changes by their kind; see ChangeComparison.
struct ChangesByKind {
  std::vector<LocationChange> moved = {};
  std::vector<LocationChange> gone = {};
  std::vector<LocationChange> added = {};
  std::vector<LocationChange> left = {};
  std::vector<LocationChange> taken = {};

  void AddMoved(const LocationChange& change) {
    moved.push_back(change);
    left.push_back({change.former, std::nullopt, change.reach});
    taken.push_back({std::nullopt, change.now, change.reach});
  }
  void AddGone(const LocationChange& change) {
    gone.push_back(change);
    left.push_back(change);
  }
  void AddNew(const LocationChange& change) {
    added.push_back(change);
    taken.push_back(change);
  }
};

ChangesByKind TrueChanges(const TrueScene& scene, std::span<const size_t> sightings,
                          size_t min_sightings) {
  ChangesByKind changes;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const TrueObject& object = scene.objects[i];
    const bool is_seen = sightings.empty() || sightings[i] >= min_sightings;
    if (object.is_dynamic || !is_seen) {
      continue;
    }
    const Eigen::Vector3d now = object.world_from_object.translation;
    const double reach = 0.5 * object.Size();
    if (object.status == TrueObjectStatus::kMoved) {
      changes.AddMoved({object.former_world_from_object->translation, now, reach});
    } else if (object.status == TrueObjectStatus::kNew) {
      changes.AddNew({std::nullopt, now, reach});
    }
  }
  for (const TrueObject& object : scene.gone) {
    changes.AddGone({object.world_from_object.translation, std::nullopt, 0.5 * object.Size()});
  }
  return changes;
}

ChangesByKind ReportedChanges(std::span<const ChangedObject> reported, const Sim3& truth_from_map) {
  ChangesByKind changes;
  for (const ChangedObject& changed : reported) {
    const LocationChange said{CenterOf(changed.former, truth_from_map),
                              CenterOf(changed.now, truth_from_map)};
    if (changed.change == ObjectChange::kMoved) {
      changes.AddMoved(said);
    } else if (changed.change == ObjectChange::kGone) {
      changes.AddGone(said);
    } else if (changed.change == ObjectChange::kNew) {
      changes.AddNew(said);
    }
  }
  return changes;
}

}  // namespace

ChangeComparison CompareChanges(const TrueScene& scene, std::span<const ChangedObject> changes,
                                const Sim3& truth_from_map, std::span<const size_t> sightings,
                                size_t min_sightings) {
  const ChangesByKind truth = TrueChanges(scene, sightings, min_sightings);
  const ChangesByKind said = ReportedChanges(changes, truth_from_map);
  return {Count(truth.moved, said.moved), Count(truth.gone, said.gone),
          Count(truth.added, said.added), Count(truth.left, said.left),
          Count(truth.taken, said.taken)};
}

}  // namespace hullslam
