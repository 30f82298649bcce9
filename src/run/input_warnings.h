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

// As ReadSettings() and MakeSettings(). Their warnings are printed on stderr.
SystemOptions LoadSettings(const std::filesystem::path& file,
                           std::span<const std::string> overrides,
                           NegativeFy negative_fy = NegativeFy::kError);
SystemOptions LoadSettings(const CameraCalibration& calibration, const std::string& source,
                           std::span<const std::string> overrides);

// Each prints a warning on stderr about input that can be used but is probably not what the user
// meant.

// The median depth of an image is not what indoor sensors measure (0.2 to 20 m), so DepthMapFactor
// may be wrong.
void WarnOfImplausibleDepth(const std::filesystem::path& file, const cv::Mat& depth,
                            const DepthOptions& options);
// A class in tracking.dynamic_classes or objects.sizes is in no mask. Classes of the default are
// not reported.
void WarnOfUnknownClasses(const TrackingOptions& tracking, const ObjectOptions& objects,
                          const SequenceMasks& masks);
// --last is beyond the end of the sequence.
void WarnOfLastFrame(const FrameSelection& selection, const ImageSequence& sequence);

}  // namespace hullslam
