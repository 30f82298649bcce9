// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/stereo_settings.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "camera/named_lens.h"
#include "camera/wide_lens.h"
#include "settings/calibration_file.h"
#include "settings/tool_calibration.h"
#include "settings/yaml_map.h"
#include "settings/yaml_pose.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPose = "Stereo.T_c1_c2";
constexpr std::string_view kFormerPose = "Tlr";  // before format 1.0, without the last row

Eigen::Quaterniond RotationIn(const YamlMap& file, const std::string& key,
                              const Eigen::Matrix3d& matrix) {
  const auto rotation = RotationOf(matrix);
  if (!rotation) {
    file.Fail(key, "is no rotation");
  }
  return *rotation;
}

// ---- ORB-SLAM2

bool IsOrb2Pair(const YamlMap& file) { return file.Has("LEFT.K") || file.Has("RIGHT.K"); }

PinholeCamera CameraOf(const YamlMap& file, const std::string& side) {
  const std::vector<double> k = file.Matrix(side + ".K", 9);
  PinholeCamera camera{.fx = k[0],
                       .fy = k[4],
                       .cx = k[2],
                       .cy = k[5],
                       .width = file.Pixels(side + ".width", file.Number(side + ".width")),
                       .height = file.Pixels(side + ".height", file.Number(side + ".height"))};
  const std::vector<double> d = file.Map(side + ".D").Numbers("data");
  if (const std::string expected = SetNamedLens("opencv", d, camera); !expected.empty()) {
    file.Fail(side + ".D", fmt::format("has {} number(s), {}", d.size(), expected));
  }
  return camera;
}

Eigen::Quaterniond RectifyingRotation(const YamlMap& file, const std::string& key) {
  const std::vector<double> r = file.Matrix(key, 9);
  return RotationIn(file, key,
                    Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data()));
}

// The motion between two cameras from the rotations that rectify them and the projection matrix of
// the right one, whose fourth column is minus the baseline times the focal length.
Rigid3 RightFromLeft(const Eigen::Quaterniond& left, const Eigen::Quaterniond& right,
                     const YamlMap& file, const std::string& projection) {
  const std::vector<double> p = file.Matrix(projection, 12);
  if (!(p[0] > 0.0)) {
    file.Fail(projection, "has no focal length");
  }
  return {right.inverse() * left, right.inverse() * Eigen::Vector3d(p[3] / p[0], 0.0, 0.0)};
}

StereoCalibration PairOfOrb2(const YamlMap& file) {
  return {CameraOf(file, "LEFT"), CameraOf(file, "RIGHT"),
          RightFromLeft(RectifyingRotation(file, "LEFT.R"), RectifyingRotation(file, "RIGHT.R"),
                        file, "RIGHT.P")};
}

// ---- camera_info of ROS, a file for each camera

constexpr const char* kRectification = "rectification_matrix";
constexpr const char* kProjection = "projection_matrix";

// The file of the right camera, whose name has "right" where the left one's has "left"; empty
// if it has not.
fs::path RightOf(const fs::path& left) {
  std::string name = left.filename().string();
  const size_t side = name.rfind("left");
  return side == std::string::npos ? fs::path()
                                   : left.parent_path() / name.replace(side, 4, "right");
}

bool IsInfoPair(const fs::path& path, const YamlMap& file) {
  return file.Has(kRectification) && file.Has(kProjection) && !RightOf(path).empty();
}

StereoCalibration PairOfInfos(const fs::path& path, const YamlMap& left,
                              const PinholeCamera& camera) {
  const fs::path other = RightOf(path);
  if (!fs::is_regular_file(other)) {
    left.Fail(kProjection, fmt::format("is of the left camera, expected {} with the right one",
                                       ShowText(other.string())));
  }
  const YAML::Node root = ReadYaml(other);
  const YamlMap right(other, "a camera_info of ROS", root);
  const std::optional<RecognisedCalibration> found = RecogniseCalibration(other, root);
  if (!found) {
    right.Fail("camera_matrix", "is not given");
  }
  return {camera, found->calibration.camera,
          RightFromLeft(RectifyingRotation(left, kRectification),
                        RectifyingRotation(right, kRectification), right, kProjection)};
}

// ---- ORB-SLAM3

bool IsOrb3Pair(const YamlMap& file) {
  return file.Has("Camera2.fx") || file.Has(kPose) || file.Has(kFormerPose);
}

StereoCalibration PairOfOrb3(const YamlMap& file, const PinholeCamera& camera) {
  StereoCalibration pair{camera, camera, {}};
  pair.right.fx = file.Number("Camera2.fx");
  pair.right.fy = file.Number("Camera2.fy");
  pair.right.cx = file.Number("Camera2.cx");
  pair.right.cy = file.Number("Camera2.cy");
  for (const LensCoefficient& one : CoefficientsOf(camera.lens)) {
    const std::string key = fmt::format("Camera2.{}", one.name);
    if (file.Has(key)) {
      pair.right.*one.field = file.Number(key);
    } else if (one.name.front() != 'x' && one.name != "alpha" && one.name != "beta") {
      pair.right.*one.field = 0.0;  // the shape of a wide lens is that of the left one
    }
  }
  pair.right_from_left =
      Inverse(file.Has(kFormerPose) ? ReadRigid3(file, kFormerPose, RigidRows::kThree)
                                    : ReadRigid3(file, kPose));
  return pair;
}

// ---- one camera with Camera.bf

// Two cameras with the same lens that look in the same direction.
StereoCalibration TwinsOf(const PinholeCamera& camera) {
  return {camera, camera, {Eigen::Quaterniond::Identity(), {-camera.bf / camera.fx, 0.0, 0.0}}};
}

}  // namespace

bool IsStereoKey(std::string_view key) {
  return key.starts_with("LEFT.") || key.starts_with("RIGHT.") || key.starts_with("Camera2.") ||
         key == kPose || key == kFormerPose;
}

bool HasRightCamera(const fs::path& file) {
  const YAML::Node root = ReadYaml(file);
  const YamlMap settings(file, "settings", root);
  return IsOrb2Pair(settings) || IsOrb3Pair(settings) || IsCamchain(settings) || IsBasalt(root) ||
         IsInfoPair(file, settings);
}

std::optional<StereoCalibration> ReadStereoPair(const fs::path& file, const PinholeCamera& camera) {
  const YAML::Node root = ReadYaml(file);
  if (IsBasalt(root)) {
    return ReadBasaltPair(file, root);
  }
  const YamlMap settings(file, "settings", root);
  if (IsOrb2Pair(settings)) {
    return PairOfOrb2(settings);
  }
  if (IsOrb3Pair(settings)) {
    return PairOfOrb3(settings, camera);
  }
  if (IsCamchain(settings)) {
    return ReadCamchainPair(settings);
  }
  if (IsInfoPair(file, settings)) {
    return PairOfInfos(file, settings, camera);
  }
  return camera.IsDistorted() ? std::optional(TwinsOf(camera)) : std::nullopt;
}

std::shared_ptr<const StereoRectifier> MakeRectifier(const fs::path& file,
                                                     const PinholeCamera& camera) {
  const std::optional<StereoCalibration> pair = ReadStereoPair(file, camera);
  return pair ? std::make_shared<const StereoRectifier>(*pair, file.string()) : nullptr;
}

std::shared_ptr<const StereoRectifier> MakePairRectifier(const fs::path& file,
                                                         const PinholeCamera& camera) {
  return std::make_shared<const StereoRectifier>(
      ReadStereoPair(file, camera).value_or(TwinsOf(camera)), file.string());
}

}  // namespace hullslam
