// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/messages.h"
#include "hullslam/map/tracking_failure.h"

namespace hullslam {

// Makes the first map of a monocular camera from two frames with enough parallax and some frames
// between them. Several earlier frames stay candidates for the first view, so a frame that has no
// parallax to the newest candidate does not delay the map.
class MonocularInitialiser {
 public:
  // `sensor` must outlive the initialiser. `seed` is that of the run.
  MonocularInitialiser(const Sensor& sensor, uint64_t seed);

  struct Result {
    // The first view is at the origin, and the median depth of the points in it is 1. The frame is
    // the last view. Null if there is a failure.
    std::optional<InitialMap> map;
    InitialisationFailure failure = InitialisationFailure::kTooFewFeatures;
  };

  // Frames come in order of time. After a map was made, the initialiser has no frames.
  Result Process(std::shared_ptr<const Frame> frame);
  // Forgets all frames.
  void Forget() { references_.clear(); }

 private:
  Result TryReferences(const std::shared_ptr<const Frame>& frame) const;
  Result TryReference(size_t reference, const std::shared_ptr<const Frame>& frame) const;
  void KeepAsReference(std::shared_ptr<const Frame> frame);

  const Sensor& sensor_;
  const uint64_t seed_;
  const uint32_t interval_;                               // frames from one reference to the next
  std::vector<std::shared_ptr<const Frame>> references_;  // in order of time
};

}  // namespace hullslam
