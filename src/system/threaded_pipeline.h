// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/sensor.h"
#include "hullslam/system/options.h"
#include "system/pipeline.h"

namespace hullslam {

// What Track does with a keyframe while the mapper is still busy with the one before.
enum class Pace {
  kWaitForMapper,  // waits: no keyframe is left out, however fast the frames come
  kNeverWait,      // leaves it out, or cuts the mapper short if it is urgent, as ORB-SLAM2 does
};

// Mapping in a thread of its own, so that Track returns once the frame has its pose. Results depend
// on timing. `sensor` must outlive the pipeline.
std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options,
                                               Pace pace);

}  // namespace hullslam
