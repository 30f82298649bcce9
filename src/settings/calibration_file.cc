// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/calibration_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <string_view>
#include <vector>

#include "camera/named_lens.h"
#include "hullslam/util/error.h"
#include "settings/tool_calibration.h"
#include "settings/yaml_map.h"
#include "settings/yaml_pose.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The first of these keys that the map has; the first one if it has none, for messages.
template <size_t kCount>
const char* KeyOf(const YamlMap& map, const std::array<const char*, kCount>& names) {
  for (const char* const name : names) {
    if (map.Has(name)) {
      return name;
    }
  }
  return names.front();
}

// The first names are used by OpenCV's own programs and ROS, the others by scripts.
constexpr std::array kMatrixKeys = {"camera_matrix", "Camera_Matrix", "cameraMatrix", "mtx", "K"};
constexpr std::array kDistortionKeys = {"distortion_coefficients", "Distortion_Coefficients",
                                        "distCoeffs", "dist", "D"};
constexpr std::array kWidthKeys = {"image_width", "image_Width"};
constexpr std::array kHeightKeys = {"image_height", "image_Height"};

// ---- OpenCV and ROS

RecognisedCalibration CalibrationOfMatrix(const YamlMap& file) {
  RecognisedCalibration result;
  PinholeCamera& camera = result.calibration.camera;
  const char* const matrix = KeyOf(file, kMatrixKeys);
  const std::vector<double> k = file.Map(matrix).Numbers("data", 9, "a 3x3 matrix by rows");
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
    file.Fail(matrix, "is no matrix fx 0 cx, 0 fy cy, 0 0 1");
  }
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  const char* const width = KeyOf(file, kWidthKeys);
  const char* const height = KeyOf(file, kHeightKeys);
  if (!file.Has(width) || !file.Has(height)) {
    file.Fail(matrix,
              "is of a calibration of OpenCV that does not tell the size of the images; add the "
              "lines 'image_width: 640' and 'image_height: 480' with theirs");
  }
  camera.width = file.Pixels(width, file.Number(width));
  camera.height = file.Pixels(height, file.Number(height));
  const char* const distortion = KeyOf(file, kDistortionKeys);
  const std::vector<double> coefficients = file.Map(distortion).Numbers("data");
  const bool is_ros = file.Has("distortion_model");
  const bool is_fisheye = file.Has("fisheye_model") && file.Number("fisheye_model") != 0.0;
  const std::string model = is_ros       ? file.Text("distortion_model")
                            : is_fisheye ? "fisheye"
                                         : "opencv";
  if (const std::string expected = SetNamedLens(model, coefficients, camera); !expected.empty()) {
    file.Fail(is_ros ? "distortion_model" : distortion,
              fmt::format("is '{}' with {} number(s), {}", ShowText(model), coefficients.size(),
                          expected));
  }
  result.program = is_ros ? "a camera_info of ROS" : "a calibration of OpenCV";
  return result;
}

// ---- Kalibr, EuRoC and TUM-VI

RecognisedCalibration CalibrationOfKalibr(const YamlMap& file) {
  int count = 1;
  while (file.Has(fmt::format("cam{}", count))) {
    ++count;
  }
  RecognisedCalibration result;
  result.calibration.camera = ReadPinhole(file.Map("cam0"), "distortion_coeffs");
  result.program = fmt::format("a camchain of Kalibr, camera cam0 of {}", count);
  return result;
}

RecognisedCalibration CalibrationOfEuroc(const YamlMap& file) {
  RecognisedCalibration result;
  result.calibration.camera = ReadPinhole(file, "distortion_coefficients");
  if (file.Has("rate_hz")) {
    result.calibration.frames_per_second = file.Number("rate_hz");
  }
  result.program = "a sensor.yaml of EuRoC";
  return result;
}

// ---- stella_vslam

// `prefix` is "Camera." for the flat keys of OpenVSLAM.
RecognisedCalibration CalibrationOfStella(const YamlMap& map, const std::string& prefix) {
  const auto number = [&](const char* name) { return map.Number(prefix + name); };
  const auto pixels = [&](const char* name) { return map.Pixels(prefix + name, number(name)); };
  const std::string model = map.Text(prefix + "model");
  const bool is_fisheye = model == "fisheye";
  if (!is_fisheye && model != "perspective") {
    map.Fail(prefix + "model", fmt::format("is '{}', expected perspective or fisheye; HullSLAM has "
                                           "no other lens",
                                           ShowText(model)));
  }
  RecognisedCalibration result;
  PinholeCamera& camera = result.calibration.camera;
  camera.fx = number("fx");
  camera.fy = number("fy");
  camera.cx = number("cx");
  camera.cy = number("cy");
  camera.width = pixels("cols");
  camera.height = pixels("rows");
  std::vector<double> coefficients;
  for (const char* const name : is_fisheye
                                    ? std::vector<const char*>{"k1", "k2", "k3", "k4"}
                                    : std::vector<const char*>{"k1", "k2", "p1", "p2", "k3"}) {
    coefficients.push_back(number(name));
  }
  SetNamedLens(is_fisheye ? "fisheye" : "radtan", coefficients, camera);
  if (map.Has(prefix + "focal_x_baseline")) {
    camera.bf = number("focal_x_baseline");
  }
  if (map.Has(prefix + "fps")) {
    result.calibration.frames_per_second = number("fps");
  }
  result.program = "a config of stella_vslam, of which only the camera is used";
  return result;
}

// ---- camodocal, whose cameras VINS-Fusion has

// Kannala-Brandt is written there with k2 to k5 as coefficients of theta^3 to theta^9, and with mu,
// mv, u0 and v0 for the focal lengths and the principal point.
RecognisedCalibration CalibrationOfCamodocal(const YamlMap& file) {
  const std::string model = file.Text("model_type");
  const bool is_fisheye = model == "KANNALA_BRANDT";
  if (!is_fisheye && model != "PINHOLE") {
    file.Fail("model_type", fmt::format("is '{}', expected PINHOLE or KANNALA_BRANDT; HullSLAM has "
                                        "no other lens",
                                        ShowText(model)));
  }
  const YamlMap lens = file.Map("projection_parameters");
  const YamlMap distortion = is_fisheye ? lens : file.Map("distortion_parameters");
  RecognisedCalibration result;
  PinholeCamera& camera = result.calibration.camera;
  camera.fx = lens.Number(is_fisheye ? "mu" : "fx");
  camera.fy = lens.Number(is_fisheye ? "mv" : "fy");
  camera.cx = lens.Number(is_fisheye ? "u0" : "cx");
  camera.cy = lens.Number(is_fisheye ? "v0" : "cy");
  camera.width = file.Pixels("image_width", file.Number("image_width"));
  camera.height = file.Pixels("image_height", file.Number("image_height"));
  std::vector<double> coefficients;
  for (const char* const name :
       is_fisheye ? std::array{"k2", "k3", "k4", "k5"} : std::array{"k1", "k2", "p1", "p2"}) {
    coefficients.push_back(distortion.Number(name));
  }
  SetNamedLens(is_fisheye ? "fisheye" : "radtan", coefficients, camera);
  result.program = "a calibration of camodocal";
  return result;
}

// ---- files that lack something

constexpr const char* kPairKeys =
    "write both cameras as LEFT.K, LEFT.D, LEFT.R, LEFT.P, LEFT.width, LEFT.height and RIGHT.* "
    "(ORB-SLAM2), or use a camchain of Kalibr";

// The calibrations of the ZED SDK are not YAML, but their first line, [LEFT_CAM_2K], is a list of
// it.
bool IsOfZed(const YAML::Node& root) {
  return root.IsSequence() && root.size() > 0 && root[0].IsScalar() &&
         root[0].Scalar().starts_with("LEFT_CAM");
}

}  // namespace

std::optional<RecognisedCalibration> RecogniseCalibration(const fs::path& file,
                                                          const YAML::Node& root) {
  if (IsOfZed(root)) {
    throw InputError(
        file.string() +
        ": is a calibration of the ZED SDK, which HullSLAM does not read. For images "
        "that the SDK has rectified, write fx, fy, cx, cy of [LEFT_CAM_*] as Camera.fx "
        "to Camera.cy, and Camera.bf: fx times Baseline in m");
  }
  if (!root.IsMap()) {
    return std::nullopt;
  }
  if (IsBasalt(root)) {
    RecognisedCalibration result;
    result.calibration.camera = ReadBasaltCamera(file, root, 0);
    result.program = "a calibration of Basalt, its first camera";
    return result;
  }
  const YamlMap map(file, "a calibration", root);
  if (map.Has(KeyOf(map, kMatrixKeys))) {
    return CalibrationOfMatrix(map);
  }
  if (map.Has("M1") && map.Has("M2")) {
    map.Fail("M1", std::string("is of a stereo calibration of OpenCV, which does not tell the size "
                               "of the images; ") +
                       kPairKeys);
  }
  if (map.Has("model_type") && map.Has("projection_parameters")) {
    return CalibrationOfCamodocal(map);
  }
  if (map.Has("cam0")) {
    return CalibrationOfKalibr(map);
  }
  if (map.Has("intrinsics") && map.Has("resolution")) {
    return CalibrationOfEuroc(map);
  }
  if (map.Has("Camera.model")) {
    return CalibrationOfStella(map, "Camera.");
  }
  if (map.Has("Camera")) {
    return CalibrationOfStella(map.Map("Camera"), "");
  }
  return std::nullopt;
}

}  // namespace hullslam
