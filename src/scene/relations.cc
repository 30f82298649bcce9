// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/relations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "scene/surfaces.h"

namespace hullslam {
namespace {

constexpr double kLeastOverlap = 0.5;     // of footprints, for "on"
constexpr double kLeastVolumeIn = 0.5;    // share of the volume that is inside, for "in"
constexpr double kLeastVolumePart = 0.8;  // the same for "part of"
constexpr double kLowerPart = 1.0 / 3.0;  // what stands in the lowest third of a thing is not on it
constexpr double kMostBesideGap = 1.0;    // of the mean width of the two objects
constexpr size_t kLeastObservations = 3;  // for relations that are seen in images
constexpr double kLeastFrontShare = 0.5;  // of the common observations
constexpr double kLeastHiddenShare = 0.25;  // of the observations in which it should be seen

// How one object is held by another one.
struct Holder {
  RelationKind kind = RelationKind::kOn;
  const ObjectBody* body = nullptr;
  double height_error = 0.0;  // m, distance between the lower side and the top of the holder
  Evidence evidence;
};

// The evidence that A is a part of B, in B or on B, if it is.
std::optional<Holder> HolderOf(const ObjectBody& a, const ObjectBody& b,
                               const ObservationStatistics& observations) {
  if (FootprintGap(a, b) > 0.0 || b.size <= 0.0) {
    return std::nullopt;
  }
  const double inside = VolumeShare(a.ellipsoid, b.ellipsoid);
  const double overlap = FootprintOverlap(a, b);
  const JointObservations& joint = observations.Joint(a.id, b.id);
  const double gap = a.bottom - b.top;
  const bool is_smaller = a.size < b.size;
  if (is_smaller && inside >= kLeastVolumePart && joint.observations >= kLeastObservations &&
      2 * joint.mask_inside >= joint.observations) {
    return Holder{RelationKind::kPartOf,
                  &b,
                  std::abs(gap),
                  {{"inside", inside},
                   {"views", static_cast<double>(joint.observations)},
                   {"mask_inside_views", static_cast<double>(joint.mask_inside)}}};
  }
  const bool is_low = a.bottom < b.bottom + kLowerPart * b.Height();
  if (is_smaller && is_low && inside >= kLeastVolumeIn) {
    return Holder{RelationKind::kIn, &b, std::abs(gap), {{"inside", inside}, {"overlap", overlap}}};
  }
  if (!is_low && overlap >= kLeastOverlap && gap <= HeightTolerance(a, b)) {
    return Holder{RelationKind::kOn, &b, std::abs(gap), {{"gap", gap}, {"overlap", overlap}}};
  }
  return std::nullopt;
}

// An object is carried by one other at most: the one whose top is nearest to its lower side. Two
// objects cannot carry each other, because none is on a thing that begins higher up (HolderOf).
std::vector<std::optional<Holder>> FindHolders(std::span<const ObjectBody> bodies,
                                               const ObservationStatistics& observations) {
  std::vector<std::optional<Holder>> holders(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    for (const ObjectBody& other : bodies) {
      if (other.id == bodies[i].id) {
        continue;
      }
      auto holder = HolderOf(bodies[i], other, observations);
      if (holder && (!holders[i] || holder->height_error < holders[i]->height_error)) {
        holders[i] = std::move(holder);
      }
    }
  }
  return holders;
}

// The support of an object: a surface, another object, or none that is known.
struct Stand {
  const Surface* surface = nullptr;
  ObjectId object;
  bool IsSame(const Stand& other) const {
    return surface != nullptr ? surface == other.surface
                              : object.IsValid() && object == other.object;
  }
};

std::map<ObjectId, Stand> FindStands(std::span<const ObjectBody> bodies,
                                     const std::vector<std::optional<Holder>>& holders,
                                     const std::vector<Surface>& surfaces) {
  std::map<ObjectId, Stand> stands;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (holders[i] && holders[i]->kind != RelationKind::kPartOf) {
      stands[bodies[i].id].object = holders[i]->body->id;
    }
  }
  for (const Surface& surface : surfaces) {
    for (const ObjectId id : surface.objects) {
      stands[id].surface = &surface;
    }
  }
  return stands;
}

void AddBeside(std::span<const ObjectBody> bodies, const std::map<ObjectId, Stand>& stands,
               std::vector<Relation>& relations) {
  for (const ObjectBody& a : bodies) {
    const auto stand = stands.find(a.id);
    for (const ObjectBody& b : bodies) {
      const auto other = stands.find(b.id);
      if (a.id == b.id || stand == stands.end() || other == stands.end() ||
          !stand->second.IsSame(other->second)) {
        continue;
      }
      const double gap = FootprintGap(a, b);
      const double width = 0.5 * (a.width + b.width);
      if (gap <= kMostBesideGap * width) {
        relations.push_back(
            {a.id, RelationKind::kBeside, b.id, {{"gap", gap}, {"gap_share", gap / width}}});
      }
    }
  }
}

void Sort(std::vector<Relation>& relations) {
  std::sort(relations.begin(), relations.end(), [](const Relation& a, const Relation& b) {
    return std::tie(a.subject, a.kind, a.object) < std::tie(b.subject, b.kind, b.object);
  });
}

}  // namespace

SceneRelations FindStandingRelations(std::span<const ObjectBody> measured,
                                     const ObservationStatistics& observations) {
  SceneRelations found;
  const std::vector<ObjectBody> bodies = ExtendToFloor(measured);
  const std::vector<std::optional<Holder>> holders = FindHolders(bodies, observations);
  std::vector<const ObjectBody*> standing;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (!holders[i]) {
      standing.push_back(&bodies[i]);
      continue;
    }
    const auto& [kind, holder, error, evidence] = *holders[i];
    found.relations.push_back({bodies[i].id, kind, holder->id, evidence});
    if (kind == RelationKind::kOn) {
      found.relations.push_back({holder->id, RelationKind::kSupports, bodies[i].id, evidence});
    }
  }
  found.surfaces = FindSurfaces(standing, FloorHeight(measured), observations);
  AddBeside(bodies, FindStands(bodies, holders, found.surfaces), found.relations);
  Sort(found.relations);
  return found;
}

std::vector<Relation> FindObservedRelations(const ObservationStatistics& observations) {
  std::vector<Relation> relations;
  for (const auto& [pair, joint] : observations.joint) {
    const double share =
        static_cast<double>(joint.in_front) / static_cast<double>(joint.observations);
    if (joint.observations >= kLeastObservations && share >= kLeastFrontShare) {
      relations.push_back({pair.first,
                           RelationKind::kInFrontOf,
                           pair.second,
                           {{"views", static_cast<double>(joint.observations)}, {"share", share}}});
    }
  }
  for (const auto& [pair, hidden] : observations.hidden) {
    const double share =
        static_cast<double>(hidden.hidden) / static_cast<double>(hidden.observations);
    if (hidden.hidden >= kLeastObservations && share >= kLeastHiddenShare) {
      relations.push_back({pair.first,
                           RelationKind::kHiddenBy,
                           pair.second,
                           {{"views", static_cast<double>(hidden.observations)},
                            {"share", share},
                            {"most_hidden", hidden.most}}});
    }
  }
  Sort(relations);
  return relations;
}

}  // namespace hullslam
