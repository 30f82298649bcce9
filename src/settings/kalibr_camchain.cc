// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/kalibr_camchain.h"

#include "settings/yaml_pose.h"

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

}  // namespace hullslam
