// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/stereo_rectifier.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "camera/brown.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

cv::Matx33d IntrinsicsOf(const PinholeCamera& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

bool HaveSameIntrinsics(const PinholeCamera& a, const PinholeCamera& b) {
  constexpr double kSame = 1e-6;  // px
  return std::abs(a.fx - b.fx) < kSame && std::abs(a.fy - b.fy) < kSame &&
         std::abs(a.cx - b.cx) < kSame && std::abs(a.cy - b.cy) < kSame;
}

// Whether the images of the pair are rectified as they are.
bool IsRectified(const StereoCalibration& pair) {
  constexpr double kAngle = 1e-6;   // radians
  constexpr double kLength = 1e-6;  // m
  const Eigen::Vector3d& t = pair.right_from_left.translation;
  return HaveSameIntrinsics(pair.left, pair.right) && !pair.left.IsDistorted() &&
         !pair.right.IsDistorted() && std::hypot(t.y(), t.z()) < kLength &&
         pair.right_from_left.rotation.angularDistance(Eigen::Quaterniond::Identity()) < kAngle;
}

void CheckCamera(PinholeCamera camera, const std::string& name, const std::string& origin) {
  constexpr int64_t kMostPixels = 64'000'000;  // the maps of an image take 8 bytes per pixel
  if (const int64_t pixels = int64_t{camera.width} * camera.height; pixels > kMostPixels) {
    throw InputError(fmt::format("{}: the {} camera has images of {}x{} px, expected at most {} px",
                                 origin, name, camera.width, camera.height, kMostPixels));
  }
  camera.bf = PinholeCamera().bf;  // is not used
  if (const std::string fault = camera.FindFault(); !fault.empty()) {
    throw InputError(fmt::format("{}: the {} camera: {}", origin, name, fault));
  }
}

void CheckPair(const StereoCalibration& pair, const std::string& origin) {
  constexpr double kLeastBaseline = 1e-4;  // m
  CheckCamera(pair.left, "left", origin);
  CheckCamera(pair.right, "right", origin);
  if (pair.left.width != pair.right.width || pair.left.height != pair.right.height) {
    throw InputError(fmt::format(
        "{}: the left camera has images of {}x{} px and the right one of {}x{} px, expected equal "
        "sizes",
        origin, pair.left.width, pair.left.height, pair.right.width, pair.right.height));
  }
  // The centre of the right camera in the frame of the left one.
  const Eigen::Vector3d centre = Inverse(pair.right_from_left).translation;
  if (!(centre.norm() > kLeastBaseline)) {
    throw InputError(fmt::format("{}: the baseline is {:g} m, expected two cameras that are apart",
                                 origin, centre.norm()));
  }
  if (std::abs(centre.x()) < std::hypot(centre.y(), centre.z())) {
    throw InputError(fmt::format(
        "{}: the second camera is at ({:.3f}, {:.3f}, {:.3f}) m from the first one, expected it "
        "beside the first one, along x",
        origin, centre.x(), centre.y(), centre.z()));
  }
  if (centre.x() < 0.0) {
    throw InputError(fmt::format(
        "{}: the second camera is {:.3f} m to the left of the first one: left and right are "
        "swapped",
        origin, -centre.x()));
  }
}

}  // namespace

StereoRectifier::StereoRectifier(const StereoCalibration& calibration, const std::string& origin)
    : calibration_(calibration),
      left_{calibration.left},
      right_{calibration.right},
      camera_(calibration.left) {
  CheckPair(calibration, origin);
  if (IsRectified(calibration)) {
    camera_.bf = -calibration.right_from_left.translation.x() * camera_.fx;
    return;
  }
  cv::Mat rotation;
  cv::eigen2cv(calibration.right_from_left.rotation.toRotationMatrix(), rotation);
  const Eigen::Vector3d& t = calibration.right_from_left.translation;
  const cv::Size size(left_.read.width, left_.read.height);
  cv::Matx33d left_rotation;
  cv::Matx33d right_rotation;
  cv::Matx34d left_projection;
  cv::Matx34d right_projection;
  cv::Matx44d to_depth;
  // For the size of the rectified image. A wide lens keeps the focal length: all of its field of
  // view would not fit.
  const auto distortion = [](const PinholeCamera& camera) {
    return cv::Vec<double, 8>(BrownCoefficients(camera).data());
  };
  cv::stereoRectify(IntrinsicsOf(calibration.left), distortion(calibration.left),
                    IntrinsicsOf(calibration.right), distortion(calibration.right), size, rotation,
                    cv::Vec3d(t.x(), t.y(), t.z()), left_rotation, right_rotation, left_projection,
                    right_projection, to_depth, cv::CALIB_ZERO_DISPARITY, 0.0, size);
  camera_ = {.fx = left_projection(0, 0),
             .fy = left_projection(1, 1),
             .cx = left_projection(0, 2),
             .cy = left_projection(1, 2),
             .width = left_.read.width,
             .height = left_.read.height,
             .bf = -right_projection(0, 3)};
  Eigen::Matrix3d left;
  Eigen::Matrix3d right;
  cv::cv2eigen(left_rotation, left);
  cv::cv2eigen(right_rotation, right);
  Turn(left, left_);
  Turn(right, right_);
}

void StereoRectifier::Turn(const Eigen::Matrix3d& rotation, Eye& eye) const {
  eye.rectified_from_read.rotation = Eigen::Quaterniond(rotation).normalized();
  eye.maps = MakeMaps(eye.read, rotation, camera_);
}

StereoRectifier::Maps StereoRectifier::MakeMaps(const PinholeCamera& read,
                                                const Eigen::Matrix3d& rotation,
                                                const PinholeCamera& rectified) {
  Maps maps{cv::Mat(read.height, read.width, CV_32FC1), cv::Mat(read.height, read.width, CV_32FC1)};
  for (int y = 0; y < read.height; ++y) {
    for (int x = 0; x < read.width; ++x) {
      const Eigen::Vector3d ray =
          rotation.transpose() * rectified.Unproject(Eigen::Vector2d(x, y), 1.0);
      const Eigen::Vector2d pixel = read.Distort(read.Project(ray));
      maps.columns.at<float>(y, x) = static_cast<float>(pixel.x());
      maps.rows.at<float>(y, x) = static_cast<float>(pixel.y());
    }
  }
  return maps;
}

cv::Mat StereoRectifier::Rectify(const cv::Mat& image, ImageSide side) const {
  const Maps& maps = EyeOf(side).maps;
  if (maps.columns.empty()) {
    return image;
  }
  cv::Mat rectified;
  cv::remap(image, rectified, maps.columns, maps.rows, cv::INTER_LINEAR);
  return rectified;
}

Eigen::Vector2d StereoRectifier::Rectify(const Eigen::Vector2d& pixel, ImageSide side) const {
  const Eye& eye = EyeOf(side);
  if (eye.maps.columns.empty()) {
    return pixel;
  }
  const Eigen::Vector3d ray =
      eye.rectified_from_read.rotation * eye.read.Unproject(eye.read.Undistort(pixel), 1.0);
  return camera_.Project(ray);
}

}  // namespace hullslam
