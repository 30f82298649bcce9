// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map_events.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr double kSameScale = 1e-9;

size_t CountLoops(const Map& map) {
  size_t ends = 0;
  map.keyframes().ForEach(
      [&](KeyframeId, const Keyframe& keyframe) { ends += keyframe.loops.size(); });
  return ends / 2;
}

// How corrections have moved the keyframes that both maps have.
MapEvent MeasureCorrection(const Map& before, const Map& after) {
  MapEvent event;
  std::vector<double> scales;
  double sum = 0.0;
  before.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (after.keyframes().Contains(id)) {
      const double moved = (Inverse(after.CamFromWorld(id)).translation -
                            Inverse(keyframe.cam_from_world).translation)
                               .norm();
      sum += moved;
      event.most_moved = std::max(event.most_moved, moved);
      scales.push_back(after.ScaleOf(id) / keyframe.scale);
    }
  });
  if (!scales.empty()) {
    event.mean_moved = sum / static_cast<double>(scales.size());
    event.scale = Median(std::move(scales));
  }
  return event;
}

// Corrections that come together are one event, of the kind that says most.
void AddCorrections(const Map& before, const Map& after, std::vector<MapEvent>& events) {
  MapEvent event = MeasureCorrection(before, after);
  if (after.islands_joined() > before.islands_joined()) {
    event.kind = MapEventKind::kIslandJoined;
  } else if (CountLoops(after) > CountLoops(before)) {
    event.kind = MapEventKind::kLoopClosed;
  } else if (std::abs(event.scale - 1.0) > kSameScale) {
    event.kind = MapEventKind::kRescaled;
  }
  events.push_back(event);
}

bool IsMapped(const ObjectLandmark* object) {
  return object != nullptr && object->state == ObjectState::kMapped;
}

void AddObjects(const Map& before, const Map& after, std::vector<MapEvent>& events) {
  const bool is_corrected = after.correction_count() != before.correction_count();
  before.objects().ForEach([&](ObjectId id, const ObjectLandmark& old) {
    if (!IsMapped(&old)) {
      return;
    }
    const ObjectLandmark* const now = after.objects().Find(id);
    if (!IsMapped(now)) {
      const ObjectId kept = after.Resolve(id);
      const bool is_fused = kept.IsValid() && kept != id;
      events.push_back({.kind = is_fused ? MapEventKind::kObjectFused : MapEventKind::kObjectGone,
                        .object = id,
                        .kept = is_fused ? kept : ObjectId()});
    } else if (!is_corrected) {
      const double moved = (now->ellipsoid.world_from_object.translation -
                            old.ellipsoid.world_from_object.translation)
                               .norm();
      if (moved > old.ellipsoid.half_axes.mean()) {
        events.push_back({.kind = MapEventKind::kObjectMoved,
                          .object = id,
                          .mean_moved = moved,
                          .most_moved = moved});
      }
    }
  });
  after.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (IsMapped(&object) && !IsMapped(before.objects().Find(id))) {
      events.push_back({.kind = MapEventKind::kObjectBorn, .object = id});
    }
  });
}

}  // namespace

std::string_view ToString(MapEventKind kind) {
  constexpr std::array<std::string_view, 11> kNames = {
      "lost",     "relocalised", "island_begun", "island_joined", "loop_closed", "rescaled",
      "adjusted", "object_born", "object_fused", "object_moved",  "object_gone"};
  return kNames.at(static_cast<size_t>(kind));
}

std::vector<MapEvent> EventsBetween(const Map& before, const Map& after) {
  std::vector<MapEvent> events;
  // The first island is where every map begins.
  for (size_t i = std::max<size_t>(1, before.islands_begun()); i < after.islands_begun(); ++i) {
    events.push_back({.kind = MapEventKind::kIslandBegun});
  }
  if (after.correction_count() != before.correction_count()) {
    AddCorrections(before, after, events);
  }
  AddObjects(before, after, events);
  return events;
}

}  // namespace hullslam
