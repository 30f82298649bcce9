// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/nerfstudio.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hullslam/camera/depth.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

// The 4 x 4 matrix of the camera with OpenGL's axes.
Json TransformOf(const Rigid3& world_from_cam) {
  Eigen::Matrix<double, 3, 4> matrix = world_from_cam.ToMatrix();
  matrix.col(1) *= -1.0;
  matrix.col(2) *= -1.0;
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3)});
  }
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

}  // namespace

std::string FormatTransforms(const PinholeCamera& camera, std::span<const NerfstudioFrame> frames,
                             const std::string& points) {
  constexpr double kHalfPixel = 0.5;  // the corner of the first pixel is (0, 0)
  Json list = Json::array();
  bool has_depth = false;
  for (const NerfstudioFrame& frame : frames) {
    Json& entry = list.emplace_back(Json{{"file_path", frame.image}});
    if (!frame.depth.empty()) {
      entry["depth_file_path"] = frame.depth;
      has_depth = true;
    }
    if (!frame.mask.empty()) {
      entry["mask_path"] = frame.mask;
    }
    entry["transform_matrix"] = TransformOf(frame.world_from_cam);
  }
  Json json = {{"camera_model", "OPENCV"},
               {"w", camera.width},
               {"h", camera.height},
               {"fl_x", camera.fx},
               {"fl_y", camera.fy},
               {"cx", camera.cx + kHalfPixel},
               {"cy", camera.cy + kHalfPixel},
               {"k1", 0.0},
               {"k2", 0.0},
               {"p1", 0.0},
               {"p2", 0.0},
               {"ply_file_path", points}};
  if (has_depth) {
    json["depth_unit_scale_factor"] = kNerfstudioDepthUnit;
  }
  json["frames"] = list;
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<double> MeasureDepthUnits(const FrameFeatures& features, const PinholeCamera& camera,
                                        const cv::Mat& depth) {
  constexpr size_t kLeast = 10;
  std::vector<double> ratios;
  for (size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d raw = camera.Distort(features.keypoints[i].undistorted.cast<double>());
    const double units = SampleDepth(depth, raw.cast<float>(), 1.0);
    if (features.depth[i] > 0.0f && units > 0.0) {
      ratios.push_back(units / static_cast<double>(features.depth[i]));
    }
  }
  return ratios.size() < kLeast ? std::nullopt : std::optional(Median(ratios));
}

cv::Mat MakeDepthImage(const cv::Mat& depth, double units_per_metre, const ExportCamera& view) {
  const bool is_metres = depth.type() == CV_32FC1;
  const double scale = 1.0 / (kNerfstudioDepthUnit * (is_metres ? 1.0 : units_per_metre));
  const cv::Mat raw = view.Undistort(depth, cv::INTER_NEAREST);
  cv::Mat image = cv::Mat::zeros(raw.size(), CV_16UC1);
  for (int y = 0; y < raw.rows; ++y) {
    for (int x = 0; x < raw.cols; ++x) {
      const double units =
          scale * (is_metres ? static_cast<double>(raw.at<float>(y, x)) : raw.at<uint16_t>(y, x));
      if (units > 0.0 && units < std::numeric_limits<uint16_t>::max()) {
        image.at<uint16_t>(y, x) = static_cast<uint16_t>(std::lround(units));
      }
    }
  }
  return image;
}

}  // namespace hullslam
