// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/loop_stages.h"

#include <optional>
#include <variant>

namespace hullslam {

void StartNextStage(const MapMessage& message, bool is_applied, const SystemOptions& options,
                    Mapper& mapper, const std::shared_ptr<const Map>& published,
                    LoopStages& stages) {
  const auto* const correction = std::get_if<MapCorrection>(&message);
  const bool is_adjustment = correction != nullptr && !correction->loop;
  const bool has_no_loop = is_adjustment || std::holds_alternative<LateDetections>(message);
  if (!options.loop.enabled || options.vocabulary == nullptr || has_no_loop) {
    return;
  }
  if (correction != nullptr && is_applied) {
    if (options.loop.global_adjustment) {
      stages.Adjust(published);
    }
  } else if (const std::optional<KeyframeId> keyframe = mapper.NewestKeyframe()) {
    stages.Seek({mapper.Snapshot(), *keyframe});
  }
}

}  // namespace hullslam
