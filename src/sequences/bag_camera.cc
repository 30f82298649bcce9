// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_camera.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

#include "camera/named_lens.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "settings/yaml_pose.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailInfo(const fs::path& path, const IndexedTopic& info,
                           const std::string& fault) {
  throw InputError(fmt::format("{}: {}: {}; expected --settings FILE", path.string(),
                               ShowText(info.name), fault));
}

// The camera with the focal lengths and the centre of K or P, whose rows have `columns` numbers.
PinholeCamera CameraOf(std::span<const double> matrix, size_t columns,
                       const CameraInfoMessage& info) {
  PinholeCamera camera;
  camera.fx = matrix[0];
  camera.fy = matrix[columns + 1];
  camera.cx = matrix[2];
  camera.cy = matrix[columns + 2];
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  return camera;
}

// The camera of raw images: K and the distortion.
InfoCamera RawCameraOf(const fs::path& path, const IndexedTopic& topic) {
  const CameraInfoMessage& info = *topic.camera;
  InfoCamera read{CameraOf(info.k, 3, info), "raw images: K and D"};
  if (const std::string expected =
          SetNamedLens(info.distortion_model, info.distortion, read.camera);
      !expected.empty()) {
    FailInfo(path, topic,
             fmt::format("the distortion is '{}' with {} coefficients, {}",
                         ShowText(info.distortion_model, 40), info.distortion.size(), expected));
  }
  if (info.k[0] == 0.0) {
    FailInfo(path, topic, "the camera is not calibrated, its matrix K is 0");
  }
  return read;
}

// The camera of rectified images: the left half of the projection P. Drivers of cameras that need
// no rectification leave P empty; then K belongs to the images.
InfoCamera RectifiedCameraOf(const fs::path& path, const IndexedTopic& topic) {
  const CameraInfoMessage& info = *topic.camera;
  if (info.p[0] > 0.0) {
    return {CameraOf(info.p, 4, info), "rectified images by the name of their topic: P"};
  }
  const bool is_distorted =
      std::ranges::any_of(info.distortion, [](double number) { return number != 0.0; });
  if (!(info.k[0] > 0.0) || is_distorted) {
    FailInfo(path, topic,
             "the images are rectified by the name of their topic, but its matrix P is 0");
  }
  return {CameraOf(info.k, 3, info), "rectified images by the name of their topic: K, as P is 0"};
}

// The rotation that rectifies the images of a topic; none if they are rectified.
Eigen::Quaterniond RectifyingRotation(const fs::path& path, const IndexedTopic& info,
                                      const IndexedTopic& images) {
  if (IsRectifiedTopic(images)) {
    return Eigen::Quaterniond::Identity();
  }
  const Eigen::Matrix3d matrix =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(info.camera->r.data());
  const auto rotation = RotationOf(matrix);
  if (!rotation) {
    FailInfo(path, info, "its matrix R is no rotation");
  }
  return *rotation;
}

}  // namespace

InfoCamera CameraOfInfo(const fs::path& path, const IndexedTopic& info,
                        const IndexedTopic& images) {
  if (info.camera->width > kMostImagePixels || info.camera->height > kMostImagePixels) {
    FailInfo(path, info,
             fmt::format("the camera has {}x{} px", info.camera->width, info.camera->height));
  }
  return IsRectifiedTopic(images) ? RectifiedCameraOf(path, info) : RawCameraOf(path, info);
}

StereoCalibration PairOfInfos(const fs::path& path, const std::array<const IndexedTopic*, 2>& infos,
                              const std::array<const IndexedTopic*, 2>& images,
                              std::vector<std::string>& notes) {
  const InfoCamera left = CameraOfInfo(path, *infos[0], *images[0]);
  const InfoCamera right = CameraOfInfo(path, *infos[1], *images[1]);
  notes.push_back(fmt::format("cameras: {} ({}) and {} ({})", ShowText(infos[0]->name), left.note,
                              ShowText(infos[1]->name), right.note));
  StereoCalibration pair;
  pair.left = left.camera;
  pair.right = right.camera;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  const std::array<double, 12>& left_p = infos[0]->camera->p;
  const std::array<double, 12>& right_p = infos[1]->camera->p;
  if (left_p[0] > 0.0 && right_p[0] > 0.0) {
    translation.x() = right_p[3] / right_p[0] - left_p[3] / left_p[0];
  }
  pair.right_from_left =
      Rigid3{RectifyingRotation(path, *infos[1], *images[1]).inverse(), Eigen::Vector3d::Zero()} *
      Rigid3{RectifyingRotation(path, *infos[0], *images[0]), translation};
  return pair;
}

}  // namespace hullslam
