// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/loop_stages.h"

#include <optional>
#include <variant>

namespace hullslam {

void StartNextStage(const MapMessage& message, const SystemOptions& options, Mapper& mapper,
                    const std::shared_ptr<const Map>& published, LoopStages& stages) {
  if (!options.loop.enabled || options.vocabulary == nullptr) {
    return;
  }
  if (const auto* correction = std::get_if<MapCorrection>(&message)) {
    if (correction->loop && options.loop.global_adjustment) {
      stages.Adjust(published);
    }
  } else if (const std::optional<KeyframeId> keyframe = mapper.NewestKeyframe()) {
    stages.Seek({mapper.Snapshot(), *keyframe});
  }
}

}  // namespace hullslam
