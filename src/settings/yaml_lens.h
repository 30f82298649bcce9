// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/camera/pinhole.h"
#include "settings/yaml_map.h"

namespace hullslam {

// Sets the lens of the camera from the name of a model and its list of coefficients, as
// SetNamedLens() knows them. Throws InputError with file, line and key if there is no such model or
// if coefficients are missing.
void ReadLens(const YamlMap& map, const char* model_key, const char* coefficients_key,
              PinholeCamera& camera);

// The camera of a file of Kalibr, EuRoC or TUM-VI: camera_model, intrinsics (fu fv cu cv),
// resolution, distortion_model and the coefficients. `ds` and `eucm` have them first in the
// intrinsics. Throws likewise.
PinholeCamera ReadPinhole(const YamlMap& map, const char* coefficients_key);

}  // namespace hullslam
