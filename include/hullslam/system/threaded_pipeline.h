// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/map/sensor.h"
#include "hullslam/system/options.h"
#include "hullslam/system/pipeline.h"

namespace hullslam {

// Mapping in a thread of its own, as in ORB-SLAM2: Track returns once the frame has its pose.
// Results depend on timing. `sensor` must outlive the pipeline.
std::unique_ptr<Pipeline> MakeThreadedPipeline(const Sensor& sensor, const SystemOptions& options);

}  // namespace hullslam
