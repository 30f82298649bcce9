// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/rolling_shutter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <vector>

#include "frame/keypoint_grid.h"
#include "hullslam/util/check.h"
#include "util/median.h"

namespace hullslam {
namespace {

// An affine map of the image.
struct AffineMap {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Identity();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  // px

  Eigen::Vector2d operator*(const Eigen::Vector2d& point) const { return matrix * point + shift; }
};

// The axis of the image along which the exposure proceeds, and the size of the image along it, px.
struct ReadoutAxis {
  Eigen::Index index = 1;
  int size = 0;
};

ReadoutAxis AxisOf(const Sensor& sensor) {
  return sensor.readout_direction == ReadoutDirection::kRows ? ReadoutAxis{1, sensor.camera.height}
                                                             : ReadoutAxis{0, sensor.camera.width};
}

// Undoes an image velocity (px/s) that is the same for a whole object. The rows (or columns) of the
// undistorted image are used as an approximation of those as read.
AffineMap UndoVelocity(const Sensor& sensor, const Eigen::Vector2d& velocity) {
  const ReadoutAxis axis = AxisOf(sensor);
  const Eigen::Vector2d per_pixel = velocity * sensor.readout_time / axis.size;
  AffineMap map;
  map.matrix.col(axis.index) -= per_pixel;
  map.shift = 0.5 * axis.size * per_pixel;
  return map;
}

Line2 Transform(const AffineMap& map, const Line2& line) {
  const Eigen::Vector2d normal = map.matrix.inverse().transpose() * line.normal;
  const double offset = line.offset - normal.dot(map.shift);
  return {normal.normalized(), offset / normal.norm()};
}

void Transform(const AffineMap& map, Detection& detection) {
  std::vector<Eigen::Vector2d> contour = detection.contour.Unpack();
  for (Eigen::Vector2d& point : contour) {
    point = map * point;
  }
  detection.contour = PackedPoints<2>(contour);
  detection.box.setEmpty();
  for (Eigen::Vector2d& point : detection.hull) {
    point = map * point;
    detection.box.extend(point);
  }
  for (SilhouetteLine& line : detection.lines) {
    line.line = Transform(map, line.line);
  }
  for (SilhouetteLine& line : detection.right_lines) {
    line.line = Transform(map, line.line);
  }
  if (detection.ellipse) {
    Ellipse& ellipse = *detection.ellipse;
    ellipse.center = map * ellipse.center;
    ellipse.shape = map.matrix * ellipse.shape * map.matrix.transpose();
  }
}

// The median of the known ones; 0 if none is known.
double MedianOfKnown(std::vector<double> inverse_depths) {
  std::erase(inverse_depths, 0.0);
  return inverse_depths.empty() ? 0.0 : Median(std::move(inverse_depths));
}

// The inverse depth of a detection; `of_image`, that of the whole image, if none of its keypoints
// has a known depth.
double InverseDepthOf(const Detection& detection, std::span<const double> inverse_depths,
                      double of_image) {
  std::vector<double> on_object;
  for (const uint32_t keypoint : detection.keypoints) {
    on_object.push_back(inverse_depths[keypoint]);
  }
  const double median = MedianOfKnown(std::move(on_object));
  return median > 0.0 ? median : of_image;
}

}  // namespace

PointVelocity MeanVelocity(const Rigid3& cam_from_last_cam, double duration) {
  return {LogSo3(cam_from_last_cam.rotation) / duration, cam_from_last_cam.translation / duration};
}

Eigen::Vector2d ImageVelocity(const PinholeCamera& camera, const PointVelocity& velocity,
                              const Eigen::Vector2d& pixel, double inverse_depth) {
  const Eigen::Vector3d ray = camera.Unproject(pixel, 1.0);
  const Eigen::Vector3d moved = velocity.angular.cross(ray) + inverse_depth * velocity.linear;
  return {camera.fx * (moved.x() - ray.x() * moved.z()),
          camera.fy * (moved.y() - ray.y() * moved.z())};
}

std::shared_ptr<const Frame> WithGlobalShutter(const Frame& frame, const Sensor& sensor,
                                               const PointVelocity& velocity,
                                               std::span<const double> inverse_depths) {
  Check(inverse_depths.size() == frame.features.size(), "there must be one depth per keypoint");
  const PinholeCamera& camera = sensor.camera;
  const ReadoutAxis axis = AxisOf(sensor);
  auto corrected = std::make_shared<Frame>(frame);
  FrameFeatures& features = corrected->features;
  for (size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d pixel = features.keypoints[i].undistorted.cast<double>();
    const double time = (camera.Distort(pixel)[axis.index] / axis.size - 0.5) * sensor.readout_time;
    const Eigen::Vector2f moved =
        (time * ImageVelocity(camera, velocity, pixel, inverse_depths[i])).cast<float>();
    features.keypoints[i].undistorted -= moved;
    if (features.depth[i] > 0.0F && !camera.IsFisheye()) {
      features.right_u[i] -= moved.x();
    }
  }
  features.grid = MakeKeypointGrid(features.keypoints, camera, sensor.bounds);
  const double of_image = MedianOfKnown({inverse_depths.begin(), inverse_depths.end()});
  for (Detection& detection : corrected->detections) {
    const double inverse_depth = InverseDepthOf(detection, inverse_depths, of_image);
    Transform(UndoVelocity(sensor,
                           ImageVelocity(camera, velocity, detection.box.center(), inverse_depth)),
              detection);
  }
  return corrected;
}

}  // namespace hullslam
