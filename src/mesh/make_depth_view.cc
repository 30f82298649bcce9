// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/make_depth_view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "frame/coarse_depth.h"

namespace hullslam {
namespace {

constexpr double kLeastCosine = 0.15;  // 81 degrees

// Whether the inverse depths of a surface at a pixel and at two opposite ones are linear in the
// image, as those of a plane are, up to the noise of a disparity; see KeypointDepth().
bool AreOnOneSurface(float before, float centre, float after, float most_bend) {
  return before > 0.0F && after > 0.0F && std::abs(0.5F * (before + after) - centre) <= most_bend;
}

// A row of the inverse depths without the pixels near the border of a surface and near unknown
// pixels.
void WriteInnerRow(const cv::Mat& inverse, int y, float most_bend, float* inner) {
  constexpr int kReach = 1;  // px
  if (y < kReach || y >= inverse.rows - kReach) {
    return;
  }
  const auto* const above = inverse.ptr<float>(y - kReach);
  const auto* const row = inverse.ptr<float>(y);
  const auto* const below = inverse.ptr<float>(y + kReach);
  for (int x = kReach; x < inverse.cols - kReach; ++x) {
    const auto is_plane = [&](float before, float after) {
      return AreOnOneSurface(before, row[x], after, most_bend);
    };
    if (row[x] > 0.0F && is_plane(row[x - kReach], row[x + kReach]) &&
        is_plane(above[x], below[x]) && is_plane(above[x - kReach], below[x + kReach]) &&
        is_plane(above[x + kReach], below[x - kReach])) {
      inner[x] = row[x];
    }
  }
}

// The points of a depth image (camera frame, m).
class Points {
 public:
  Points(const cv::Mat& inverse, const cv::Mat& rays, float most_bend)
      : inverse_(inverse), rays_(rays), most_bend_(most_bend) {}

  Eigen::Vector3f At(int x, int y) const {
    const auto& ray = rays_.at<cv::Vec2f>(y, x);
    return Eigen::Vector3f(ray[0], ray[1], 1.0F) / inverse_.at<float>(y, x);
  }

  // The cosine of the angle between the ray and the normal, from points on both sides of the pixel.
  // They are as far apart as the surface allows, because near ones differ by little more than their
  // noise. 0 if there are none.
  float Cosine(int x, int y) const {
    for (const int reach : {4, 2}) {
      if (IsPlane(x, y, reach, 0) && IsPlane(x, y, 0, reach)) {
        const Eigen::Vector3f across = At(x + reach, y) - At(x - reach, y);
        const Eigen::Vector3f down = At(x, y + reach) - At(x, y - reach);
        return std::abs(across.cross(down).normalized().dot(At(x, y).normalized()));
      }
    }
    return 0.0F;
  }

 private:
  bool IsPlane(int x, int y, int dx, int dy) const {
    return x >= dx && y >= dy && x + dx < inverse_.cols && y + dy < inverse_.rows &&
           AreOnOneSurface(inverse_.at<float>(y - dy, x - dx), inverse_.at<float>(y, x),
                           inverse_.at<float>(y + dy, x + dx), most_bend_);
  }

  const cv::Mat& inverse_;
  const cv::Mat& rays_;
  float most_bend_;
};

// A row of inverse depths, 1/m, 0 where the depth is unknown or beyond `max_depth`.
void WriteInverseRow(const cv::Mat& depth, int y, const DepthOptions& options, double max_depth,
                     float* inverse) {
  for (int x = 0; x < depth.cols; ++x) {
    const float metres = SampleDepth(depth, {x, y}, options.units_per_metre);
    const bool is_used = metres > 0.0F && static_cast<double>(metres) <= max_depth;
    inverse[x] = is_used ? 1.0F / metres : 0.0F;
  }
}

// Calls `task` for each row of an image.
void ForRows(int rows, TaskRunner& runner, const std::function<void(int)>& task) {
  constexpr int kPerTask = 32;
  runner.Run(static_cast<size_t>((rows + kPerTask - 1) / kPerTask), [&](size_t i) {
    const int first = kPerTask * static_cast<int>(i);
    for (int y = first; y < std::min(rows, first + kPerTask); ++y) {
      task(y);
    }
  });
}

}  // namespace

cv::Mat RaysOf(const PinholeCamera& camera, cv::Mat& is_seen) {
  cv::Mat rays = cv::Mat::zeros(camera.height, camera.width, CV_32FC2);
  is_seen = cv::Mat::zeros(rays.size(), CV_8UC1);
  for (int y = 0; y < rays.rows; ++y) {
    for (int x = 0; x < rays.cols; ++x) {
      const Eigen::Vector2d raw(x, y);
      if (camera.SeesRaw(raw)) {
        const Eigen::Vector3d ray = camera.Unproject(camera.Undistort(raw), 1.0);
        rays.at<cv::Vec2f>(y, x) = {static_cast<float>(ray.x()), static_cast<float>(ray.y())};
        is_seen.at<uint8_t>(y, x) = 255;
      }
    }
  }
  return rays;
}

std::vector<Rigid3> PosesOfRows(const SystemOptions& options, const Rigid3& cam_from_world,
                                const PointVelocity& velocity) {
  if (options.readout_time == 0.0 || !options.tracking.correct_shutter) {
    return {cam_from_world};
  }
  const int rows = options.readout_direction == ReadoutDirection::kRows ? options.camera.height
                                                                        : options.camera.width;
  std::vector<Rigid3> poses;
  for (int row = 0; row < rows; ++row) {
    // As in frame/rolling_shutter.cc: x(t) = Exp(t w) x(0) + t v.
    const double time = (static_cast<double>(row) / rows - 0.5) * options.readout_time;
    poses.push_back(Rigid3(ExpSo3(time * velocity.angular), time * velocity.linear) *
                    cam_from_world);
  }
  return poses;
}

DepthView MakeDepthView(const cv::Mat& depth, const SystemOptions& options, double max_depth,
                        const cv::Mat& rays, TaskRunner& runner) {
  constexpr double kMostBend = 0.3;  // px of disparity; see frame/depth_source.cc
  const auto most_bend = static_cast<float>(kMostBend / options.camera.bf);
  cv::Mat inverse(depth.size(), CV_32FC1);
  ForRows(depth.rows, runner, [&](int y) {
    WriteInverseRow(depth, y, options.depth, max_depth, inverse.ptr<float>(y));
  });
  DepthView view;
  view.camera = options.camera;
  view.readout = options.readout_direction;
  view.rays = rays;
  for (cv::Mat* const image : {&view.inverse_depth, &view.cosine, &view.weight}) {
    *image = cv::Mat(depth.size(), CV_32FC1, cv::Scalar(0.0));
  }
  const Points points(inverse, rays, most_bend);
  const double per_inverse = options.camera.bf / options.depth.error.disparity_sigma;
  ForRows(depth.rows, runner, [&](int y) {
    auto* const inner = view.inverse_depth.ptr<float>(y);
    WriteInnerRow(inverse, y, most_bend, inner);
    for (int x = 0; x < depth.cols; ++x) {
      const float cosine = inner[x] > 0.0F ? points.Cosine(x, y) : 0.0F;
      if (static_cast<double>(cosine) < kLeastCosine) {
        inner[x] = 0.0F;
        continue;
      }
      // The depth z has the standard deviation z^2 disparity_sigma / bf.
      const double per_sigma = per_inverse * std::pow(static_cast<double>(inner[x]), 2);
      view.cosine.at<float>(y, x) = cosine;
      view.weight.at<float>(y, x) = cosine * static_cast<float>(per_sigma * per_sigma);
    }
  });
  return view;
}

}  // namespace hullslam
