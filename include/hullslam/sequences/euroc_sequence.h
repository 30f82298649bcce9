// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

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

// Reads a sensor.yaml of EuRoC: `camera_model` (pinhole), `intrinsics` (fu fv cu cv, px),
// `distortion_model` with `distortion_coefficients`, `resolution`, `rate_hz` and `T_BS`. Throws
// InputError with file, line and key.
EurocCamera ReadEurocCamera(const std::filesystem::path& file);

struct EurocSequence {
  ImageSequence images;  // without depth
  // Nothing if the folder has no calibration. Then there is no ground truth of the camera either.
  std::optional<EurocCamera> camera;
  std::string calibration = {};  // the file of the calibration
};

// Opens the left camera of a sequence of EuRoC (Burri et al., IJRR 2016) or TUM-VI (Schubert et
// al., IROS 2018) in the format ASL: a folder with `mav0`, or `mav0` itself, in which
// `cam0/data.csv` lists the images of `cam0/data` by nanoseconds. Images may have 16 bits. The
// calibration is in `cam0/sensor.yaml`, or else in a camchain of Kalibr: a YAML file whose
// name contains `camchain`, in `mav0`, above it, or in the folder `dso` of one of these. The ground
// truth of the body, `state_groundtruth_estimate0/data.csv` or `mocap0/data.csv`, is converted to
// the camera. Throws InputError with file and line for malformed lines and stamps that do not
// increase, and for a missing list with its name.
EurocSequence OpenEurocSequence(const std::filesystem::path& folder,
                                const FrameSelection& selection = {});

// Opens both cameras of a sequence of EuRoC (OpenEurocSequence() has the format): cam0 is the left
// one, cam1 the right one. Images are pairs if their stamps differ by at most a twentieth of the
// time between two images; others are left out with a warning. The ground truth is converted to the
// rectified left camera. A `rectifier` replaces the calibration in the folder. Throws
// InputError as OpenEurocSequence() and StereoRectifier do, without any calibration, and if less
// than half of the images have a partner.
StereoSequence OpenEurocPairs(const std::filesystem::path& folder,
                              const FrameSelection& selection = {},
                              std::shared_ptr<const StereoRectifier> rectifier = nullptr);

}  // namespace hullslam
