// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/camera_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "camera/named_lens.h"
#include "camera/wide_lens.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// In the order of calibration files. Coefficients of Brown's lens that are 0 are left out from the
// end on, down to the `least` first ones.
std::vector<double> Coefficients(const PinholeCamera& camera, size_t least) {
  std::vector<double> numbers;
  for (const LensCoefficient& one : CoefficientsOf(camera.lens)) {
    numbers.push_back(camera.*one.field);
  }
  while (camera.lens == LensModel::kBrown && numbers.size() > least && numbers.back() == 0.0) {
    numbers.pop_back();
  }
  return numbers;
}

[[noreturn]] void Refuse(const PinholeCamera& camera, const char* format) {
  throw InputError(
      fmt::format("a camera {} cannot be written for {}", DescribeLens(camera), format));
}

std::string Settings(const PinholeCamera& camera, double frames_per_second,
                     std::span<const NamedSetting> extra) {
  std::string text;
  for (const auto& [key, value] : CameraSettings(camera)) {
    text += fmt::format("{}: {}\n", key, value);
  }
  text += fmt::format("Camera.fps: {}\n", frames_per_second);
  for (const auto& [key, value] : extra) {
    text += fmt::format("{}: {}\n", key, value);
  }
  return text;
}

std::string Kalibr(const PinholeCamera& camera) {
  std::string model = "pinhole";
  std::string distortion = "radtan";
  std::vector<double> intrinsics = {camera.fx, camera.fy, camera.cx, camera.cy};
  std::vector<double> coefficients = Coefficients(camera, 4);
  if (camera.lens == LensModel::kBrown && coefficients.size() > 4) {
    Refuse(camera, "Kalibr, whose radtan has k1, k2, p1 and p2 only");
  }
  if (camera.lens == LensModel::kKannalaBrandt) {
    distortion = "equidistant";
  } else if (camera.lens != LensModel::kBrown) {
    // Kalibr's focal lengths of a double sphere are 1 + xi times as large as ours.
    const double factor = camera.lens == LensModel::kDoubleSphere ? 1.0 + camera.xi : 1.0;
    model = std::string(FindWideModel(camera.lens)->names.front());
    intrinsics = coefficients;
    intrinsics.insert(intrinsics.end(),
                      {factor * camera.fx, factor * camera.fy, camera.cx, camera.cy});
    distortion = "none";
    coefficients.clear();
  }
  return fmt::format(
      "cam0:\n  camera_model: {}\n  intrinsics: [{}]\n  distortion_model: {}\n"
      "  distortion_coeffs: [{}]\n  resolution: [{}, {}]\n",
      model, fmt::join(intrinsics, ", "), distortion, fmt::join(coefficients, ", "), camera.width,
      camera.height);
}

// COLMAP's pixel (0, 0) is the corner of the first pixel, ours is its centre.
std::string Colmap(const PinholeCamera& camera) {
  const char* model = "OPENCV";
  std::vector<double> coefficients = Coefficients(camera, 4);
  if (camera.lens == LensModel::kKannalaBrandt) {
    model = "OPENCV_FISHEYE";
  } else if (camera.lens != LensModel::kBrown) {
    Refuse(camera, "COLMAP");
  } else if (coefficients.size() > 4) {
    model = "FULL_OPENCV";
    coefficients.resize(CoefficientsOf(camera.lens).size());
  }
  return fmt::format("1 {} {} {} {} {} {} {} {}\n", model, camera.width, camera.height, camera.fx,
                     camera.fy, camera.cx + 0.5, camera.cy + 0.5, fmt::join(coefficients, " "));
}

std::string Ros(const PinholeCamera& camera) {
  const auto [model, coefficients] = LensOfRos(camera);
  return fmt::format(
      "image_width: {}\nimage_height: {}\ncamera_name: camera\n"
      "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [{}, 0, {}, 0, {}, {}, 0, 0, 1]\n"
      "distortion_model: {}\n"
      "distortion_coefficients:\n  rows: 1\n  cols: {}\n  data: [{}]\n"
      "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
      "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [{}, 0, {}, 0, 0, {}, {}, 0, 0, 0, 1, "
      "0]\n",
      camera.width, camera.height, camera.fx, camera.cx, camera.fy, camera.cy, model,
      coefficients.size(), fmt::join(coefficients, ", "), camera.fx, camera.cx, camera.fy,
      camera.cy);
}

}  // namespace

std::vector<NamedSetting> CameraSettings(const PinholeCamera& camera) {
  std::vector<NamedSetting> settings = {
      {"Camera.type", LensTypes()[static_cast<size_t>(camera.lens)]}};
  const auto add = [&](std::string_view name, double value) {
    settings.push_back({fmt::format("Camera.{}", name), fmt::format("{}", value)});
  };
  add("fx", camera.fx);
  add("fy", camera.fy);
  add("cx", camera.cx);
  add("cy", camera.cy);
  for (const LensCoefficient& one : CoefficientsOf(camera.lens)) {
    add(one.name, camera.*one.field);
  }
  add("width", camera.width);
  add("height", camera.height);
  add("bf", camera.bf);
  return settings;
}

std::vector<NamedSetting> ImageTimeSettings(const SystemOptions& options) {
  const DepthOptions& depth = options.depth;
  std::vector<NamedSetting> settings = {
      {"Camera.readout_time", fmt::format("{}", options.readout_time)},
      {"depth.disparity_offset", fmt::format("{}", depth.disparity_offset)},
      {"depth.time_offset", fmt::format("{}", depth.time_offset)}};
  for (size_t i = 0; i < depth.pose.size(); ++i) {
    settings.push_back({fmt::format("depth.{}_{}", i < 3 ? "turn" : "shift", "xyz"[i % 3]),
                        fmt::format("{}", depth.pose.at(i))});
  }
  return settings;
}

std::vector<NamedSetting> RightCameraSettings(const StereoCalibration& pair) {
  if (pair.right.lens != pair.left.lens) {
    throw InputError(
        fmt::format("the pair has a left camera {} and a right one {}, which settings "
                    "cannot say, expected the same model",
                    DescribeLens(pair.left), DescribeLens(pair.right)));
  }
  std::vector<NamedSetting> settings;
  const auto add = [&](std::string_view name, double value) {
    settings.push_back({fmt::format("Camera2.{}", name), fmt::format("{}", value)});
  };
  add("fx", pair.right.fx);
  add("fy", pair.right.fy);
  add("cx", pair.right.cx);
  add("cy", pair.right.cy);
  for (const LensCoefficient& one : CoefficientsOf(pair.right.lens)) {
    add(one.name, pair.right.*one.field);
  }
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> left_from_right = Eigen::Matrix4d::Identity();
  left_from_right.topRows<3>() = Inverse(pair.right_from_left).ToMatrix();
  settings.push_back(
      {"Stereo.T_c1_c2", fmt::format("!!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: d\n  data: [{}]",
                                     fmt::join(std::span(left_from_right.data(), 16), ", "))});
  return settings;
}

std::vector<std::string> CameraFormatNames() { return {"hullslam", "kalibr", "colmap", "ros"}; }

std::string CameraFileText(CameraFormat format, const PinholeCamera& camera,
                           double frames_per_second, std::span<const NamedSetting> extra,
                           std::span<const std::string> comments) {
  std::string text = format == CameraFormat::kSettings ? "%YAML:1.0\n" : "";
  for (const std::string& comment : comments) {
    text += "# " + comment + "\n";
  }
  switch (format) {
    case CameraFormat::kSettings:
      return text + Settings(camera, frames_per_second, extra);
    case CameraFormat::kKalibr:
      return text + Kalibr(camera);
    case CameraFormat::kColmap:
      return text + Colmap(camera);
    case CameraFormat::kRos:
      return text + Ros(camera);
  }
  return text;
}

}  // namespace hullslam
