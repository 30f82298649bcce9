// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/settings/settings.h"

namespace hullslam {

// The camera of a sensor.yaml.
struct EurocCamera {
  CameraCalibration calibration;
  Rigid3 body_from_cam;  // T_BS
};

// Reads a sensor.yaml of EuRoC: the keys `intrinsics` (fu fv cu cv, px), `distortion_coefficients`
// (k1 k2 p1 p2), `resolution`, `rate_hz` and `T_BS`, for the models `pinhole` and
// `radial-tangential`. Throws InputError with file, line and key.
EurocCamera ReadEurocCamera(const std::filesystem::path& file);

struct EurocSequence {
  ImageSequence images;  // without depth
  EurocCamera camera;
};

// Opens the left camera of a sequence of EuRoC (Burri et al., IJRR 2016) in the format ASL: a
// folder with `mav0`, or `mav0` itself, in which `cam0/data.csv` lists the images of `cam0/data` by
// nanoseconds, and `cam0/sensor.yaml` has the calibration. The ground truth of the body,
// `state_groundtruth_estimate0/data.csv`, becomes that of the camera. Throws InputError with file
// and line for malformed lines and stamps that do not increase, and for a missing file with its
// name.
EurocSequence OpenEurocSequence(const std::filesystem::path& folder,
                                const FrameSelection& selection = {});

// Opens both cameras of a sequence of EuRoC (OpenEurocSequence() has the format): cam0 is the left
// one, cam1 the right one. Images are pairs if their stamps differ by at most a twentieth of the
// time between two images; others are left out with a warning. The ground truth becomes that of the
// rectified left camera. Throws InputError as OpenEurocSequence() and StereoRectifier do, and if
// less than half of the images have a partner.
StereoSequence OpenEurocPairs(const std::filesystem::path& folder,
                              const FrameSelection& selection = {});

}  // namespace hullslam
