// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/rolling_shutter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <utility>
#include <vector>

#include "frame/keypoint_grid.h"
#include "frame/measure_point.h"
#include "hullslam/util/check.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// The axis of the image along which the exposure proceeds, and the size of the image along it, px.
struct ReadoutAxis {
  Eigen::Index index = 1;
  int size = 0;
};

ReadoutAxis AxisOf(const Sensor& sensor) {
  return sensor.readout_direction == ReadoutDirection::kRows ? ReadoutAxis{1, sensor.camera.height}
                                                             : ReadoutAxis{0, sensor.camera.width};
}

// Maps undistorted pixels of the image as read to those that a global shutter would have taken.
//
// A row at the share p of the image was exposed at the time t = (p - 1/2) readout_time after the
// middle one. A point at the ray r (z = 1) and the inverse depth q is at x(t) = r / q then, and
// x(t) = Exp(t w) x(0) + t v with the angular and linear velocity w and v. So the middle row sees
// the ray Exp(-t w) (r - t q v).
class UndoMotion {
 public:
  UndoMotion(const Sensor& sensor, const PointVelocity& velocity)
      : camera_(sensor.camera),
        axis_(AxisOf(sensor)),
        readout_time_(sensor.readout_time),
        velocity_(velocity),
        speed_(velocity.angular.norm()),
        axis_of_turn_(velocity.angular.normalized()) {}

  // A time t, s after the exposure of the middle row, and the rotation Exp(t w) until then.
  struct Moment {
    double time;
    Eigen::Matrix3d turn;
  };
  Moment After(double time) const {
    return {time, Eigen::AngleAxisd(time * speed_, axis_of_turn_).toRotationMatrix()};
  }
  Moment ExposureOf(const Eigen::Vector2d& raw_pixel) const {
    return After((raw_pixel[axis_.index] / axis_.size - 0.5) * readout_time_);
  }

  Eigen::Vector2d Move(const Eigen::Vector2d& pixel, double inverse_depth) const {
    return Move(pixel, ExposureOf(camera_.Distort(pixel)), inverse_depth);
  }

  Eigen::Vector2d Move(const Eigen::Vector2d& pixel, const Moment& exposure,
                       double inverse_depth) const {
    const Eigen::Vector3d ray =
        camera_.Unproject(pixel, 1.0) - exposure.time * inverse_depth * velocity_.linear;
    const Eigen::Vector3d moved = exposure.turn.transpose() * ray;
    // A point that the middle row could not see: its depth or the velocity is wrong.
    return moved.z() > kLeastDepth ? camera_.Project(moved) : pixel;
  }

  // The depth (m) of a point at the exposure of the middle row. It was measured (`depth`) `delay`
  // after the row of its pixel was exposed, and the disparity of its surface changes by `slope` per
  // undistorted pixel. The pixel of the depth image then shows a neighbour of the point on the
  // surface, since the point has moved on.
  double DepthAt(const Eigen::Vector2d& pixel, const Moment& exposure, double depth, double delay,
                 const Eigen::Vector2d& slope) const {
    constexpr int kSteps = 2;  // the second one changes less than 0.1 mm
    const Moment measured = After(exposure.time + delay);
    const Eigen::Vector3d ray = camera_.Unproject(pixel, 1.0);
    const auto point_at = [&](double inverse) -> Eigen::Vector3d {
      return exposure.turn.transpose() * (ray / inverse - exposure.time * velocity_.linear);
    };
    double inverse = 1.0 / depth;
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d point = point_at(inverse);
      const Eigen::Vector3d when_measured =
          measured.turn * point + measured.time * velocity_.linear;
      if (when_measured.z() < kLeastDepth * depth || point.z() < kLeastDepth * depth) {
        return depth;
      }
      const double expected =
          1.0 / when_measured.z() + slope.dot(pixel - camera_.Project(when_measured)) / camera_.bf;
      inverse = std::max(inverse + 1.0 / depth - expected, kLeastDepth / depth);
    }
    return point_at(inverse).z();
  }

  // The derivative of Move() at a pixel.
  Eigen::Matrix2d Derivative(const Eigen::Vector2d& pixel, double inverse_depth) const {
    constexpr double kStep = 0.5;  // px
    Eigen::Matrix2d derivative;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
      derivative.col(i) =
          (Move(pixel + step, inverse_depth) - Move(pixel - step, inverse_depth)) / (2.0 * kStep);
    }
    return derivative;
  }

 private:
  static constexpr double kLeastDepth = 0.05;  // of that in the image as read

  const PinholeCamera& camera_;
  const ReadoutAxis axis_;
  const double readout_time_;
  const PointVelocity velocity_;
  const double speed_;                  // rad/s
  const Eigen::Vector3d axis_of_turn_;  // zero without a turn
};

// The line after the motion of its points near `near`.
Line2 Move(const UndoMotion& undo, double inverse_depth, const Line2& line,
           const Eigen::Vector2d& near) {
  const Eigen::Vector2d on_line = near - line.SignedDistance(near) * line.normal;
  const Eigen::Vector2d normal =
      (undo.Derivative(on_line, inverse_depth).inverse().transpose() * line.normal).normalized();
  return {normal, -normal.dot(undo.Move(on_line, inverse_depth))};
}

// The corner of the hull that a line with this outward normal touches.
Eigen::Vector2d TouchingCorner(const Detection& detection, const Eigen::Vector2d& normal) {
  const auto touching =
      std::max_element(detection.hull.begin(), detection.hull.end(),
                       [&](const auto& a, const auto& b) { return normal.dot(a) < normal.dot(b); });
  return touching != detection.hull.end() ? *touching : detection.box.center();
}

// The velocity in the frame of the right camera of a pair, which has moved by the baseline to the
// side: the points are the same, so a point x of it moves as x + (baseline, 0, 0) does.
PointVelocity OfRightCamera(const Sensor& sensor, const PointVelocity& velocity) {
  return {velocity.angular,
          velocity.linear + velocity.angular.cross(sensor.baseline() * Eigen::Vector3d::UnitX())};
}

// The points of the detection are at one depth.
void Correct(const Sensor& sensor, const PointVelocity& velocity, double inverse_depth,
             Detection& detection) {
  const UndoMotion undo(sensor, velocity);
  const UndoMotion undo_right(sensor, OfRightCamera(sensor, velocity));
  const Eigen::Vector2d disparity(
      sensor.kind == SensorKind::kStereo ? sensor.camera.bf * inverse_depth : 0.0, 0.0);
  for (SilhouetteLine& line : detection.lines) {
    line.line = Move(undo, inverse_depth, line.line, TouchingCorner(detection, line.line.normal));
  }
  for (SilhouetteLine& line : detection.right_lines) {
    line.line = Move(undo_right, inverse_depth, line.line,
                     TouchingCorner(detection, line.line.normal) - disparity);
  }
  if (detection.ellipse) {
    Ellipse& ellipse = *detection.ellipse;
    const Eigen::Matrix2d derivative = undo.Derivative(ellipse.center, inverse_depth);
    ellipse.center = undo.Move(ellipse.center, inverse_depth);
    ellipse.shape = derivative * ellipse.shape * derivative.transpose();
  }
  std::vector<Eigen::Vector2d> contour = detection.contour.Unpack();
  for (Eigen::Vector2d& point : contour) {
    point = undo.Move(point, inverse_depth);
  }
  detection.contour = PackedPoints<2>(contour);
  detection.box.setEmpty();
  for (Eigen::Vector2d& corner : detection.hull) {
    corner = undo.Move(corner, inverse_depth);
    detection.box.extend(corner);
  }
}

// The median of the known ones; 0 if none is known.
double MedianOfKnown(std::vector<double> inverse_depths) {
  std::erase(inverse_depths, 0.0);
  return inverse_depths.empty() ? 0.0 : Median(std::move(inverse_depths));
}

// The inverse depth of a detection; that of the whole image if none of its keypoints has a known
// depth.
double InverseDepthOf(const Detection& detection, const std::vector<double>& inverse_depths) {
  std::vector<double> on_object;
  for (const uint32_t keypoint : detection.keypoints) {
    on_object.push_back(inverse_depths[keypoint]);
  }
  const double median = MedianOfKnown(std::move(on_object));
  return median > 0.0 ? median : MedianOfKnown(inverse_depths);
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
  const UndoMotion undo(sensor, velocity);
  auto corrected = std::make_shared<Frame>(frame);
  FrameFeatures& features = corrected->features;
  const bool has_delay = sensor.kind == SensorKind::kRgbd;
  const Eigen::Vector2d no_slope = Eigen::Vector2d::Zero();
  const double delay = has_delay ? frame.depth_delay + sensor.depth_time : 0.0;
  for (size_t i = 0; i < features.size(); ++i) {
    Eigen::Vector2f& pixel = features.keypoints[i].undistorted;
    const Eigen::Vector2d as_read = pixel.cast<double>();
    const Eigen::Vector2d raw = camera.Distort(as_read);
    const UndoMotion::Moment exposure = undo.ExposureOf(raw);
    if (float& depth = features.depth[i]; depth > 0.0F) {
      const Eigen::Vector2d slope =
          has_delay ? DisparitySlope(camera, frame.depth, as_read, raw).value_or(no_slope)
                    : no_slope;
      depth = static_cast<float>(
          undo.DepthAt(as_read, exposure, static_cast<double>(depth), delay, slope));
    }
    pixel = undo.Move(as_read, exposure, inverse_depths[i]).cast<float>();
  }
  features.grid = MakeKeypointGrid(features.keypoints, camera);
  auto motion = std::make_shared<ShutterMotion>();
  motion->velocity = velocity;
  motion->inverse_depths.assign(inverse_depths.begin(), inverse_depths.end());
  motion->depths = frame.features.depth;
  CorrectDetections(sensor, *motion, corrected->detections);
  if (corrected->detections.empty()) {
    corrected->shutter = std::move(motion);
  }
  return corrected;
}

// The correction is a few pixels and changes slowly over the image, so repeating it with the last
// result converges in a few steps.
Eigen::Vector2d BeforeCorrection(const Sensor& sensor, const ShutterMotion& motion,
                                 const Eigen::Vector2d& corrected, size_t index) {
  constexpr int kSteps = 6;
  const UndoMotion undo(sensor, motion.velocity);
  Eigen::Vector2d read = corrected;
  for (int i = 0; i < kSteps; ++i) {
    read += corrected - undo.Move(read, motion.inverse_depths[index]);
  }
  return read;
}

void CorrectDetections(const Sensor& sensor, const ShutterMotion& motion,
                       std::vector<Detection>& detections) {
  for (Detection& detection : detections) {
    Correct(sensor, motion.velocity, InverseDepthOf(detection, motion.inverse_depths), detection);
  }
}

}  // namespace hullslam
