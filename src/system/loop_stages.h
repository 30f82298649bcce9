// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/system/options.h"
#include "loop/loop_closer.h"
#include "mapping/mapper.h"

namespace hullslam {

// The stages that follow the mapper. A pipeline runs them at once or in threads of their own. A
// stage that has found a correction sends it to the mapper as the next message.
class LoopStages {
 public:
  virtual ~LoopStages() = default;

  // Searches a loop at a new keyframe.
  virtual void Seek(LoopQuery query) = 0;
  // Adjusts the whole map. To be called with the map in which a loop was closed.
  virtual void Adjust(std::shared_ptr<const Map> corrected) = 0;
};

// Starts the stage that follows a message. To be called when the mapper has processed the message;
// `is_applied` is the result of Mapper::Process, and `published` is the newest published map. After
// a new keyframe a loop is sought (loop.enabled, and a vocabulary is needed). After a loop the
// whole map is adjusted (loop.global_adjustment). A loop that was dropped is sought again at the
// newest keyframe.
void StartNextStage(const MapMessage& message, bool is_applied, const SystemOptions& options,
                    Mapper& mapper, const std::shared_ptr<const Map>& published,
                    LoopStages& stages);

}  // namespace hullslam
