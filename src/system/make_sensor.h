// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/frame/sensor.h"
#include "hullslam/system/options.h"

namespace hullslam {

// The properties of the camera of a run. Throws InputError if an option is not valid.
Sensor MakeSensor(const SystemOptions& options);

}  // namespace hullslam
