// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/tool_calibration.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "camera/named_lens.h"
#include "hullslam/util/error.h"
#include "settings/yaml_map.h"
#include "settings/yaml_pose.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr const char* kRightFromLeft = "T_cn_cnm1";
constexpr const char* kCamFromImu = "T_cam_imu";

Rigid3 RightFromLeft(const YamlMap& left, const YamlMap& right) {
  if (right.Has(kRightFromLeft) || !right.Has(kCamFromImu)) {
    return ReadRigid3(right, kRightFromLeft);
  }
  return ReadRigid3(right, kCamFromImu) * Inverse(ReadRigid3(left, kCamFromImu));
}

}  // namespace

bool IsCamchain(const YamlMap& file) { return file.Has("cam0"); }

StereoCalibration ReadCamchainPair(const YamlMap& file) {
  const YamlMap left = file.Map("cam0");
  const YamlMap right = file.Map("cam1");
  return {.left = ReadPinhole(left, "distortion_coeffs"),
          .right = ReadPinhole(right, "distortion_coeffs"),
          .right_from_left = RightFromLeft(left, right)};
}

Rigid3 ReadImuFromCam0(const YamlMap& file) {
  const YamlMap left = file.Map("cam0");
  return left.Has(kCamFromImu) ? Inverse(ReadRigid3(left, kCamFromImu)) : Rigid3();
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kRoot = "value0";

// Its names of models. `ucm` is eucm with a beta of 1.
struct BasaltModel {
  const char* name;
  const char* lens;  // of SetLensOfKalibr()
  std::vector<const char*> coefficients;
};

const std::array<BasaltModel, 6>& Models() {
  static const std::array<BasaltModel, 6> models = {
      {{"ds", "ds", {"xi", "alpha"}},
       {"eucm", "eucm", {"alpha", "beta"}},
       {"ucm", "eucm", {"alpha"}},
       {"kb4", "equidistant", {"k1", "k2", "k3", "k4"}},
       {"pinhole", "", {}},
       {"pinhole-radtan8", "opencv", {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}}}};
  return models;
}

// The element of a list of the file.
YAML::Node ElementOf(const fs::path& file, const YAML::Node& root, const char* list, size_t index) {
  const YAML::Node& value = root[kRoot];
  const YAML::Node elements = value.IsMap() ? value[list] : YAML::Node();
  if (!elements.IsDefined() || !elements.IsSequence() || elements.size() <= index) {
    throw InputError(fmt::format("{}: {}.{} has no camera {}, expected a calibration of Basalt",
                                 OriginOf(file, value), kRoot, list, index));
  }
  return elements[index];
}

Rigid3 ImuFromCam(const fs::path& file, const YAML::Node& root, size_t index) {
  const YamlMap pose(file, "T_imu_cam of Basalt", ElementOf(file, root, "T_imu_cam", index));
  const Eigen::Quaterniond rotation(pose.Number("qw"), pose.Number("qx"), pose.Number("qy"),
                                    pose.Number("qz"));
  constexpr double kMostOff = 1e-3;
  if (!(std::abs(rotation.norm() - 1.0) < kMostOff)) {
    pose.Fail("qw", "is of no rotation, expected a quaternion of length 1");
  }
  return {rotation.normalized(), {pose.Number("px"), pose.Number("py"), pose.Number("pz")}};
}

}  // namespace

bool IsBasalt(const YAML::Node& root) {
  return root.IsMap() && root[kRoot].IsDefined() && root[kRoot].IsMap();
}

PinholeCamera ReadBasaltCamera(const fs::path& file, const YAML::Node& root, size_t index) {
  const YamlMap entry(file, "a camera of Basalt", ElementOf(file, root, "intrinsics", index));
  const std::string type = entry.Text("camera_type");
  const auto* const model = std::find_if(Models().begin(), Models().end(),
                                         [&](const BasaltModel& one) { return one.name == type; });
  if (model == Models().end()) {
    entry.Fail("camera_type",
               fmt::format("is '{}', expected ds, eucm, ucm, kb4, pinhole or pinhole-radtan8; "
                           "HullSLAM has no other lens",
                           ShowText(type)));
  }
  const YamlMap lens = entry.Map("intrinsics");
  const YAML::Node size = ElementOf(file, root, "resolution", index);
  const auto side = [&](size_t i) {
    const std::optional<double> number =
        size.IsSequence() && size.size() == 2 ? NumberOf(size[i]) : std::nullopt;
    if (!number) {
      throw InputError(OriginOf(file, size) + ": resolution is no list of width and height");
    }
    return entry.Pixels("resolution", *number);
  };
  PinholeCamera camera{.fx = lens.Number("fx"),
                       .fy = lens.Number("fy"),
                       .cx = lens.Number("cx"),
                       .cy = lens.Number("cy"),
                       .width = side(0),
                       .height = side(1)};
  std::vector<double> coefficients;
  for (const char* const name : model->coefficients) {
    coefficients.push_back(lens.Number(name));
  }
  if (type == "ucm") {
    coefficients.push_back(1.0);
  }
  SetLensOfKalibr(model->lens, coefficients, camera);
  return camera;
}

StereoCalibration ReadBasaltPair(const fs::path& file, const YAML::Node& root) {
  return {ReadBasaltCamera(file, root, 0), ReadBasaltCamera(file, root, 1),
          Inverse(ImuFromCam(file, root, 1)) * ImuFromCam(file, root, 0)};
}

}  // namespace hullslam
