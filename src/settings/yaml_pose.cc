// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_pose.h"

#include <vector>

#include "settings/rotation_matrix.h"

namespace hullslam {

Rigid3 ReadRigid3(const YamlMap& map, std::string_view key, RigidRows rows) {
  std::vector<double> numbers = map.Matrix(key, rows == RigidRows::kFour ? 16 : 12);
  if (rows == RigidRows::kThree) {
    numbers.insert(numbers.end(), {0.0, 0.0, 0.0, 1.0});
  }
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const auto rotation = RotationOf(matrix.topLeftCorner<3, 3>());
  if (!rotation || matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    map.Fail(key, "is not a rigid transform, expected a rotation, a translation and 0 0 0 1");
  }
  return {*rotation, matrix.topRightCorner<3, 1>()};
}

}  // namespace hullslam
