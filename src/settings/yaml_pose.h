// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "settings/yaml_map.h"

namespace hullslam {

// The rotation of a matrix in a file, whose numbers are rounded; nothing if it is none.
inline std::optional<Eigen::Quaterniond> RotationOf(const Eigen::Matrix3d& matrix) {
  constexpr double kTolerance = 1e-3;
  const bool is_rotation =
      (matrix * matrix.transpose()).isApprox(Eigen::Matrix3d::Identity(), kTolerance) &&
      matrix.determinant() > 0.0;
  return is_rotation ? std::optional(Eigen::Quaterniond(matrix).normalized()) : std::nullopt;
}

enum class RigidRows { kThree, kFour };  // without and with the last row, 0 0 0 1

// The rigid transform of a 4x4 matrix in one of the forms of YamlMap::Matrix(), or of its first
// three rows. Throws InputError with file, line and key if it is none.
Rigid3 ReadRigid3(const YamlMap& map, std::string_view key, RigidRows rows = RigidRows::kFour);

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
