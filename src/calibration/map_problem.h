// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "calibration/camera_problem.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"

namespace hullslam {

// The raw pixels of keypoints that were corrected for a rolling shutter. Frames in the map only
// have the corrected pixels.
class RawKeypoints {
 public:
  explicit RawKeypoints(const Sensor& sensor) : sensor_(sensor) {}

  // Notes the keypoints of a frame that show landmarks. For System::SetFrameCallback.
  void Note(const FrameReport& report);
  // The raw pixel of a keypoint of a frame in the map.
  Eigen::Vector2d RawOf(const Frame& frame, size_t keypoint) const;

 private:
  using Key = std::pair<float, float>;  // the corrected, undistorted pixel
  struct Hash {
    size_t operator()(const Key& key) const {
      return std::hash<float>()(key.first) * 31 + std::hash<float>()(key.second);
    }
  };

  Sensor sensor_;
  std::unordered_map<uint32_t, std::unordered_map<Key, Eigen::Vector2f, Hash>> of_frame_;
};

// The camera of a sensor.
CameraModel ModelOf(const Sensor& sensor);

// The calibration of the camera of a finished run: its keyframes in the largest part of the map and
// the landmarks that enough of them see. Velocities are those of `trajectory`, which has the poses
// of all frames. Long runs give at most 150 keyframes, evenly chosen, and 6000 landmarks.
CalibrationProblem MakeProblem(const Map& map, const Sensor& sensor, const Trajectory& trajectory,
                               const RawKeypoints& raw);

}  // namespace hullslam
