// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// The change of an object between the earlier sessions of a map and the last one.
enum class ObjectChange {
  kSeenAgain,
  kMoved,      // it is gone, and there is a new object of its class and size elsewhere
  kGone,       // it should be visible, but what is behind it is seen instead
  kNew,        // earlier sessions saw that it was not there
  kNotSeen,    // no keyframe of the session shows it, but this does not prove that it has left
  kFirstSeen,  // mapped for the first time, and not known to be new
};

inline constexpr std::array kObjectChanges = {ObjectChange::kSeenAgain, ObjectChange::kMoved,
                                              ObjectChange::kGone,      ObjectChange::kNew,
                                              ObjectChange::kNotSeen,   ObjectChange::kFirstSeen};

// The name in files: "seen_again", "moved", "gone", "new", "not_seen", "first_seen".
std::string_view ToString(ObjectChange change);

// An object with its location and shape, in the coordinates of the map after the session.
struct LocatedObject {
  ObjectId object;
  Ellipsoid ellipsoid;
};

struct ChangedObject {
  ObjectChange change = ObjectChange::kSeenAgain;
  std::string label;
  // The object after the session; absent if it is gone or no longer in the map.
  std::optional<LocatedObject> now = std::nullopt;
  // The object before the session, with its id in the former map; absent if it is new or first
  // seen.
  std::optional<LocatedObject> former = std::nullopt;
  // The evidence: the number of keyframes that should show the object, and the number of those in
  // which it is found. For new and first seen objects these are keyframes of earlier sessions, for
  // all others keyframes of the last session.
  int expected = 0;
  int found = 0;
};

// Compares the mapped objects of `former`, a map of earlier sessions, with `map`, the same map
// after a session whose frames have the id `session` or a larger one. The objects of the former map
// come first, by increasing id, then those that are new or were first seen. Keyframes without any
// detection count as not seen, so a session without masks changes nothing. `left` are objects of
// the former map that are known to have left. Locked objects are not gone whatever is seen.
std::vector<ChangedObject> FindObjectChanges(const Map& former, const Map& map, FrameId session,
                                             const Sensor& sensor, const ObjectOptions& options,
                                             const std::set<ObjectId>& left = {});

}  // namespace hullslam
