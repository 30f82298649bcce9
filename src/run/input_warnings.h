// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/options.h"
#include "run/mask_arguments.h"

namespace hullslam {

// Like ReadSettings() and MakeSettings(), but prints their warnings on stderr.
SystemOptions LoadSettings(const std::filesystem::path& file,
                           std::span<const std::string> overrides,
                           NegativeFy negative_fy = NegativeFy::kError);
SystemOptions LoadSettings(const CameraCalibration& calibration, const std::string& source,
                           std::span<const std::string> overrides);

// Each function below prints a warning on stderr if the input can be used but is probably not what
// the user meant.

// Warns if the median depth of an image is outside the range of indoor sensors (0.2 to 20 m).
// DepthMapFactor may then be wrong.
void WarnOfImplausibleDepth(const std::filesystem::path& file, const cv::Mat& depth,
                            const DepthOptions& options);
// Warns if no mask has a class that tracking.dynamic_classes or objects.sizes names. Classes that
// are there by default are not reported.
void WarnOfUnknownClasses(const TrackingOptions& tracking, const ObjectOptions& objects,
                          const SequenceMasks& masks);
// Warns if --last is beyond the end of the sequence.
void WarnOfLastFrame(const FrameSelection& selection, const ImageSequence& sequence);

}  // namespace hullslam
