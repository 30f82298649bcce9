// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/sensor.h"
#include "hullslam/system/options.h"
#include "system/pipeline.h"

namespace hullslam {

// The behaviour of Track with a keyframe while the mapper is still busy with an earlier one.
enum class Pace {
  kWaitForMapper,  // waits, so that no keyframe is dropped
  kNeverWait,      // drops the keyframe, or if it is urgent, hurries the mapper, as in ORB-SLAM2
};

// Mapping runs in a thread of its own, so Track returns as soon as the frame has its pose. Results
// depend on timing. `sensor` must outlive the pipeline.
std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options,
                                               Pace pace);

}  // namespace hullslam
