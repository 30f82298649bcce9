// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/calibrate_pair.h"
#include "calibration/recorded_camera.h"

namespace hullslam {

// A table of all numbers of a camera: before and after its calibration from so many recordings,
// their standard deviations, and which motion would determine the others. `pair` is absent for a
// single camera.
std::string CalibrationText(const RecordedCalibration& calibration,
                            const std::optional<PairCalibration>& pair, size_t recordings);

// Where the numbers of a calibrated camera come from, one line each, for a settings file.
// `recordings` are their names.
std::vector<std::string> OriginOf(const RecordedCalibration& calibration,
                                  const std::optional<PairCalibration>& pair,
                                  std::span<const std::string> recordings);

}  // namespace hullslam
