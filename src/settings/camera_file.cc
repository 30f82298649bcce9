// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/camera_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>

#include "camera/named_lens.h"
#include "camera/wide_lens.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

struct BrownCoefficient {
  const char* name;
  double PinholeCamera::*field;
};

// In the order of OpenCV.
constexpr std::array<BrownCoefficient, 8> kBrown = {{{"k1", &PinholeCamera::k1},
                                                     {"k2", &PinholeCamera::k2},
                                                     {"p1", &PinholeCamera::p1},
                                                     {"p2", &PinholeCamera::p2},
                                                     {"k3", &PinholeCamera::k3},
                                                     {"k4", &PinholeCamera::k4},
                                                     {"k5", &PinholeCamera::k5},
                                                     {"k6", &PinholeCamera::k6}}};

// The coefficients of the lens in the order of calibration files. Those of Brown's lens that are 0
// are left out from the end on, down to `least` of them.
std::vector<double> Coefficients(const PinholeCamera& camera, size_t least) {
  std::vector<double> numbers;
  if (const WideModel* const wide = FindWideModel(camera.lens)) {
    for (const WideModel::Coefficient& one : wide->coefficients) {
      numbers.push_back(camera.*one.field);
    }
    return numbers;
  }
  for (const BrownCoefficient& one : kBrown) {
    numbers.push_back(camera.*one.field);
  }
  while (numbers.size() > least && numbers.back() == 0.0) {
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
    coefficients.resize(kBrown.size());
  }
  return fmt::format("1 {} {} {} {} {} {} {} {}\n", model, camera.width, camera.height, camera.fx,
                     camera.fy, camera.cx + 0.5, camera.cy + 0.5, fmt::join(coefficients, " "));
}

std::string Ros(const PinholeCamera& camera) {
  std::vector<double> coefficients = Coefficients(camera, 5);
  if (camera.lens == LensModel::kBrown && coefficients.size() > 5) {
    coefficients.resize(kBrown.size());
  }
  const std::string model = camera.lens != LensModel::kBrown
                                ? std::string(FindWideModel(camera.lens)->names.front())
                            : coefficients.size() > 5 ? "rational_polynomial"
                                                      : "plumb_bob";
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
  if (const WideModel* const wide = FindWideModel(camera.lens)) {
    for (const WideModel::Coefficient& one : wide->coefficients) {
      add(one.name, camera.*one.field);
    }
  } else {
    for (const BrownCoefficient& one : kBrown) {
      add(one.name, camera.*one.field);
    }
  }
  add("width", camera.width);
  add("height", camera.height);
  add("bf", camera.bf);
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
