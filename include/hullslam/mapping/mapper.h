// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/map/sensor.h"
#include "hullslam/mapping/mapping_options.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/stage_timer.h"

namespace hullslam {

// Owns the live map: makes keyframes, creates, fuses and culls landmarks, adjusts the
// neighbourhood.
class Mapper {
 public:
  using Publish = std::function<void(std::shared_ptr<const Map>)>;

  // `sensor` must outlive the mapper. `publish` is called in Process with every snapshot that
  // others should see.
  Mapper(const Sensor& sensor, const MappingOptions& options, Publish publish);

  // `hurry` (may be null) is asked when another keyframe waits: then what can be left out is.
  void Process(const KeyframeRequest& request, const Cancellation* hurry);

  const StageTimes& times() const { return times_; }

 private:
  void PublishSnapshot();
  void AdjustNeighbourhood(KeyframeId keyframe, const Cancellation* hurry);

  const Sensor& sensor_;
  MappingOptions options_;
  Publish publish_;
  StageTimes times_;
  Map map_;
  std::vector<LandmarkId> recent_;  // landmarks that have yet to prove themselves
};

}  // namespace hullslam
