// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "hullslam/geometry/rigid3.h"
#include "settings/yaml_map.h"

namespace hullslam {

enum class RigidRows { kThree, kFour };  // without and with the last row, 0 0 0 1

// The rigid transform of a 4x4 matrix in one of the forms of YamlMap::Matrix(), or of its first
// three rows. Throws InputError with file, line and key if it is none.
Rigid3 ReadRigid3(const YamlMap& map, std::string_view key, RigidRows rows = RigidRows::kFour);

}  // namespace hullslam
