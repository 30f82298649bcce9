// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace hullslam {

// The version of the format of objects.json and objects_observations.json.
inline constexpr uint32_t kObjectFileVersion = 2;

}  // namespace hullslam
