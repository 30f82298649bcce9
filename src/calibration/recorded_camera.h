// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "calibration/calibrate_camera.h"
#include "calibration/camera_problem.h"
#include "hullslam/frame/frame.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"

namespace hullslam {

// A recording of the camera that is calibrated.
struct CameraRecording {
  size_t frames = 0;
  // Reads the frame with this number for a camera. Throws InputError if it cannot be read; such
  // frames are left out.
  std::function<ImageInput(size_t frame, const PinholeCamera& camera)> load;
};

struct RecordedCalibrationOptions {
  CameraCalibrationOptions camera;
  int max_passes = 4;
  const Cancellation* cancellation = nullptr;  // may be null
  // Called after each frame, with the number of the pass, that of the frame and that of all frames
  // of the pass, from 1 on. May be empty.
  std::function<void(int pass, size_t frame, size_t frames)> on_frame = {};
};

// The result of all passes.
struct RecordedCalibration {
  // Of the last pass; `given` and its median error are those of the camera of the options.
  CameraCalibrationResult result;
  CalibrationProblem problem;  // of the last pass
  int passes = 0;
};

// Calibrates the camera of `options` from recordings: runs SLAM on them, calibrates, and begins
// again with the camera that was found, until it does not change any more, because a better camera
// finds more landmarks. Without a result if it is cancelled. Throws InputError if no recording
// gives enough views or if its pieces contradict each other, and for what System::Track refuses.
RecordedCalibration CalibrateFromRecordings(SystemOptions options,
                                            std::span<const CameraRecording> recordings,
                                            const RecordedCalibrationOptions& calibration);

// SLAM without objects on the first `frames` frames of a recording. Empty if there is no map.
// Throws the error of the first image if no image can be read.
CalibrationProblem RecordedProblem(SystemOptions options, const CameraRecording& recording,
                                   size_t frames, const Cancellation* cancellation,
                                   const std::function<void()>& on_frame);
bool IsEnoughToCalibrate(const CalibrationProblem& problem);

// Sets the camera of a run.
void ApplyModel(const CameraModel& model, SystemOptions& options);

// The camera of a run, in whose map depths are corrected as `depth` says.
CameraModel ModelOf(const Sensor& sensor, const DepthOptions& depth);

// An image of a run, and the landmarks that it shows.
struct SeenView {
  CalibrationView view;
  std::vector<std::pair<LandmarkId, CalibrationObservation>> landmarks;
};
// With the time stamp of the frame. It has one landmark per keypoint, invalid where it shows none.
SeenView SeenViewOf(const Frame& frame, std::span<const LandmarkId> landmarks, const Sensor& sensor,
                    const CameraModel& model);

// The calibration of the camera of a finished run without objects: its keyframes, the images of
// `frames`, and the landmarks that enough of them see. Poses and velocities of frames are those of
// `trajectory`; if most images have no neighbours in it, all velocities are zero. Long runs give at
// most 150 images, evenly chosen, and 6000 landmarks.
CalibrationProblem MakeProblem(const Map& map, const Sensor& sensor, const CameraModel& model,
                               const Trajectory& trajectory, std::vector<SeenView> frames = {});

}  // namespace hullslam
