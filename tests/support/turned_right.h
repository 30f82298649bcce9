// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The image of a right camera that is turned by this rotation vector (rad), and lower by
// `row_offset` px.
inline cv::Mat TurnedRight(const cv::Mat& image, const PinholeCamera& camera,
                           const Eigen::Vector3d& turn, double row_offset = 0.0) {
  const Eigen::Matrix3d k = camera.Matrix();
  Eigen::Matrix3d homography = k * ExpSo3(turn).toRotationMatrix() * k.inverse();
  homography.row(1) += row_offset * homography.row(2);
  cv::Mat matrix;
  cv::eigen2cv(homography, matrix);
  cv::Mat turned;
  cv::warpPerspective(image, turned, matrix, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return turned;
}

// The same for all images of a folder.
inline void TurnImages(const std::filesystem::path& folder, const PinholeCamera& camera,
                       const Eigen::Vector3d& turn, double row_offset = 0.0) {
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string path = file.path().string();
    cv::imwrite(path,
                TurnedRight(cv::imread(path, cv::IMREAD_GRAYSCALE), camera, turn, row_offset));
  }
}

}  // namespace hullslam
