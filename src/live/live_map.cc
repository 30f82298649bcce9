// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_map.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

#include "eval/object_metrics.h"
#include "map/islands.h"
#include "map/located_landmarks.h"
#include "util/lists.h"
#include "view/view_of_map.h"

namespace hullslam {
namespace {

// Mixes the bits of an id, so that ids with the same last bits are an even choice.
uint32_t Mix(uint32_t id) {
  id ^= id >> 16;
  id *= 0x7feb352dU;
  id ^= id >> 15;
  id *= 0x846ca68bU;
  return id ^ (id >> 16);
}

// The least power of two that divides the landmarks into parts of at most `most`.
uint32_t ThinningOf(size_t total, size_t most) {
  uint32_t parts = 1;
  while (total / parts > most) {
    parts *= 2;
  }
  return parts;
}

bool IsInIsland(const Map& map, const Landmark& landmark, IslandId island) {
  return !landmark.observations.empty() &&
         map.keyframes().At(landmark.observations.front().keyframe).island == island;
}

void WritePose(const Rigid3& pose, float* row) {
  for (int i = 0; i < 3; ++i) {
    row[i] = static_cast<float>(pose.translation[i]);
  }
  for (int i = 0; i < 4; ++i) {
    row[3 + i] = static_cast<float>(pose.rotation.coeffs()[i]);
  }
}

// Only the poses of the views are needed after the object was measured.
void DropOutlines(ObjectResult& object) {
  for (ObservationResult& view : object.observations) {
    view.label = {};
    view.hull = {};
    view.contour = {};
    view.lines = {};
  }
}

// Movements that cannot be seen are not sent: a small part of the median distance between landmarks
// and the cameras that see them. (The size of the whole map is no measure: a long corridor is
// looked at piece by piece.)
float ToleranceOf(const Map& map, const std::vector<const Landmark*>& landmarks) {
  constexpr double kPart = 1e-3;
  constexpr size_t kSamples = 500;
  std::vector<double> distances;
  for (const Landmark* landmark : Thin(landmarks, kSamples)) {
    const Keyframe& keyframe = map.keyframes().At(landmark->observations.front().keyframe);
    distances.push_back((keyframe.cam_from_world * landmark->position).norm());
  }
  if (distances.empty()) {
    return 0.0f;
  }
  std::nth_element(distances.begin(),
                   distances.begin() + static_cast<ptrdiff_t>(distances.size() / 2),
                   distances.end());
  return static_cast<float>(kPart * distances[distances.size() / 2]);
}

bool IsSame(const ObjectResult& old, const ObjectLandmark& object) {
  return old.state == object.state && old.observations.size() == object.observations.size() &&
         old.votes == object.votes && old.ellipsoid.half_axes == object.ellipsoid.half_axes &&
         old.ellipsoid.world_from_object.translation ==
             object.ellipsoid.world_from_object.translation;
}

}  // namespace

LiveMapChange LiveMap::Follow(const Map& map, bool is_limited) {
  const IslandId island = MainIsland(map);
  LiveMapChange change;
  change.landmarks = FollowLandmarks(map, island, is_limited);
  change.keyframes = FollowKeyframes(map, island, is_limited);
  FollowObjects(map, island, is_limited, change);
  change.were_edges_changed = FollowEdges(map, island);
  return change;
}

RowChange LiveMap::FollowLandmarks(const Map& map, IslandId island, bool is_limited) {
  landmark_total_ = map.landmarks().size();
  const uint32_t mask = ThinningOf(landmark_total_, limits_.landmarks) - 1;
  const bool has_islands = map.islands_begun() > 1;
  std::vector<uint32_t> ids;
  std::vector<const Landmark*> wanted;
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    if ((Mix(id.value) & mask) != 0 || landmark.observations.empty() ||
        (has_islands && !IsInIsland(map, landmark, island))) {
      return;
    }
    if (landmarks_.Contains(id.value) || IsDistanceKnown(map, landmark, sensor_)) {
      ids.push_back(id.value);
      wanted.push_back(&landmark);
    }
  });
  tolerance_ = ToleranceOf(map, wanted);
  return landmarks_.Update(
      ids,
      [&](size_t i, float* row) {
        for (int axis = 0; axis < 3; ++axis) {
          row[axis] = static_cast<float>(wanted[i]->position[axis]);
        }
        row[3] = static_cast<float>(CreationOf(map, *wanted[i]) - start_);
      },
      tolerance_, is_limited ? limits_.changed_landmarks : wanted.size());
}

RowChange LiveMap::FollowKeyframes(const Map& map, IslandId island, bool is_limited) {
  constexpr float kMostTolerance = 1e-3f;  // of the quaternions, too
  std::vector<uint32_t> ids;
  std::vector<const Keyframe*> wanted;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.island == island) {
      ids.push_back(id.value);
      wanted.push_back(&keyframe);
    }
  });
  return keyframes_.Update(
      ids,
      [&](size_t i, float* row) {
        row[0] = static_cast<float>(wanted[i]->frame->timestamp - start_);
        WritePose(Inverse(wanted[i]->cam_from_world), row + 1);
      },
      std::min(tolerance_, kMostTolerance), is_limited ? limits_.changed_keyframes : ids.size());
}

// The objects that are shown. If there are too many, only those stay that were seen last. Some more
// are removed than needed, so that this happens rarely.
std::map<ObjectId, const ObjectLandmark*> LiveMap::ChooseObjects(const Map& map, IslandId island) {
  std::map<ObjectId, const ObjectLandmark*> chosen;
  std::vector<KeyframeId> last_views;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (!object.has_shape || object.observations.empty() || IslandOf(map, object) != island) {
      return;
    }
    if (object.observations.back().keyframe < oldest_view_) {
      are_objects_left_out_ = true;
      return;
    }
    chosen[id] = &object;
    last_views.push_back(object.observations.back().keyframe);
  });
  if (chosen.size() > limits_.objects + limits_.objects / 4) {
    const auto last = last_views.begin() + static_cast<ptrdiff_t>(limits_.objects);
    std::nth_element(last_views.begin(), last, last_views.end(), std::greater<>());
    oldest_view_ = *last;
    std::erase_if(chosen, [&](const auto& entry) {
      return entry.second->observations.back().keyframe < oldest_view_;
    });
    are_objects_left_out_ = true;
  }
  return chosen;
}

void LiveMap::FollowObjects(const Map& map, IslandId island, bool is_limited,
                            LiveMapChange& change) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const std::map<ObjectId, const ObjectLandmark*> chosen = ChooseObjects(map, island);
  change.were_objects_removed = std::erase_if(objects_, [&](const auto& entry) {
                                  return chosen.count(entry.first) == 0;
                                }) > 0;
  std::vector<std::pair<ObjectId, const ObjectLandmark*>> changed;
  for (const auto& [id, object] : chosen) {
    const auto old = objects_.find(id);
    if (old == objects_.end() || !IsSame(old->second, *object)) {
      changed.emplace_back(id, object);
    }
  }
  // Those that had no time in the last call come first.
  const auto first = std::find_if(changed.begin(), changed.end(),
                                  [&](const auto& entry) { return entry.first >= next_object_; });
  std::rotate(changed.begin(), first, changed.end());
  for (const auto& [id, object] : changed) {
    const std::chrono::duration<double> used = Clock::now() - begin;
    if (is_limited && used.count() > limits_.object_seconds) {
      next_object_ = id;
      return;
    }
    ObjectResult report = ResultOfObject(map, id, *object);
    report.fit = MeasureObject(report.ellipsoid, report.observations, sensor_.camera);
    DropOutlines(report);
    objects_[id] = std::move(report);
    change.objects.push_back(id);
  }
}

bool LiveMap::FollowEdges(const Map& map, IslandId island) {
  ViewEdges edges = FindEdges(map, limits_.covisibility, island);
  const bool is_changed = edges.covisibility != edges_.covisibility || edges.loops != edges_.loops;
  edges_ = std::move(edges);
  return is_changed;
}

}  // namespace hullslam
