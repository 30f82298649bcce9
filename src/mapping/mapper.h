// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/mapping/mapping_options.h"
#include "hullslam/objects/object_mapper.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/stage_timer.h"
#include "optim/bundle_adjustment.h"

namespace hullslam {

// Owns the live map. It adds keyframes, creates, fuses and culls landmarks, maps objects, and runs
// bundle adjustment.
class Mapper {
 public:
  using Publish = std::function<void(std::shared_ptr<const Map>)>;

  // `sensor` must outlive the mapper. `publish` is called with every snapshot that others
  // should see.
  Mapper(const Sensor& sensor, const MappingOptions& options, const ObjectOptions& objects,
         Publish publish);

  // Does what the message asks for. `hurry` (may be null) is requested while another message waits.
  // The mapper then leaves out what is not necessary. Throws CheckError for an initial map if the
  // map is not empty.
  void Process(const MapMessage& message, const Cancellation* hurry);

  // To be called once, at the end. Adjusts the whole map if mapping.final_bundle_adjustment is set,
  // and publishes it. If `cancellation` (may be null) is requested, it ends early with what it has.
  void Finish(const Cancellation* cancellation, const ProgressCallback& on_progress = {});

  const StageTimes& times() const { return times_; }
  const std::map<ObjectRejection, size_t>& object_rejections() const {
    return object_mapper_.rejections();
  }

 private:
  void Apply(const InitialMap& initial, const Cancellation* hurry);
  void Apply(const KeyframeRequest& request, const Cancellation* hurry);
  void Apply(const MapCorrection& correction, const Cancellation* hurry);
  void ExtendMap(KeyframeId keyframe, const Cancellation* hurry);
  void PublishSnapshot();
  void MapObjects(KeyframeId keyframe);
  void AdjustNeighbourhood(KeyframeId keyframe, const Cancellation* hurry);
  void Adjust(const BundleWindow& window, const BundleOptions& options,
              const Cancellation* cancellation, const ProgressCallback& on_progress = {});
  void RecheckObjects(const std::vector<ObjectId>& objects);
  WindowObjects ObjectsToAdjust() const;

  const Sensor& sensor_;
  MappingOptions options_;
  ObjectOptions object_options_;
  Publish publish_;
  StageTimes times_;
  ObjectMapper object_mapper_;
  Map map_;
  std::vector<LandmarkId> recent_;  // new landmarks that CullRecentLandmarks checks
  std::vector<KeyframeId> full_;    // keyframes that CompactOldKeyframes checks, by increasing id
};

}  // namespace hullslam
