// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/sensor.h"
#include "hullslam/system/options.h"
#include "system/pipeline.h"

namespace hullslam {

// Does everything inside Track. The same frames and options give the same bits. `sensor` must
// outlive the pipeline.
std::unique_ptr<Pipeline> MakeSequentialPipeline(const Sensor& sensor,
                                                 const SystemOptions& options);

}  // namespace hullslam
