// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/sensor.h"
#include "hullslam/system/options.h"
#include "system/pipeline.h"

namespace hullslam {

// What Track does with a keyframe while the mapper is still busy with an earlier one.
enum class Pace {
  kWaitForMapper,  // waits, so no keyframe is left out
  kNeverWait,      // leaves it out, or if it is urgent, hurries the mapper, like ORB-SLAM2
};

// Mapping runs in a thread of its own, so Track returns as soon as the frame has its pose. Results
// depend on timing. `sensor` must outlive the pipeline.
std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options,
                                               Pace pace);

}  // namespace hullslam
