// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_pose.h"

#include <fmt/format.h>

#include <span>
#include <string>
#include <vector>

#include "camera/named_lens.h"
#include "camera/wide_lens.h"
#include "util/text.h"

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

void ReadLens(const YamlMap& map, const char* model_key, const char* coefficients_key,
              PinholeCamera& camera) {
  const std::string model = map.Text(model_key);
  const std::vector<double> coefficients = map.Numbers(coefficients_key);
  if (const std::string expected = SetNamedLens(model, coefficients, camera); !expected.empty()) {
    map.Fail(model_key, fmt::format("is '{}' and {} has {} number(s), {}", ShowText(model),
                                    coefficients_key, coefficients.size(), expected));
  }
}

PinholeCamera ReadPinhole(const YamlMap& map, const char* coefficients_key) {
  const std::string model = map.Text("camera_model");
  const WideModel* const wide = FindWideModel(model);
  if (wide == nullptr && model != "pinhole") {
    map.Fail("camera_model", fmt::format("is '{}', expected 'pinhole', 'ds' or 'eucm'; HullSLAM "
                                         "has no other projection",
                                         ShowText(model)));
  }
  const size_t own = wide != nullptr ? wide->coefficients.size() : 0;
  const std::vector<double> numbers = map.Numbers(
      "intrinsics", own + 4, wide != nullptr ? "the coefficients and fu fv cu cv" : "fu fv cu cv");
  const std::span<const double> focal = std::span(numbers).subspan(own);
  const std::vector<double> size = map.Numbers("resolution", 2, "width height");
  PinholeCamera camera{.fx = focal[0],
                       .fy = focal[1],
                       .cx = focal[2],
                       .cy = focal[3],
                       .width = map.Pixels("resolution", size[0]),
                       .height = map.Pixels("resolution", size[1])};
  if (wide == nullptr) {
    ReadLens(map, "distortion_model", coefficients_key, camera);
  } else {
    SetLensOfKalibr(model, std::span(numbers).first(own), camera);
  }
  return camera;
}

}  // namespace hullslam
