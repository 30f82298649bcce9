// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"

namespace hullslam {

// Each function below returns a warning, one line, for input that can be used but is probably not
// what the user meant.

// Depth images that are not registered to their colour images: where the depth has a step, the
// colour then changes no more than elsewhere. Uses seven images. Nothing if they have too few
// steps.
std::vector<std::string> CheckDepth(const ImageSequence& sequence, const PinholeCamera& camera);

// Masks whose outlines do not run along borders in the images: they may be masks of the images as
// EXIF data turn them. Uses seven images of the beginning. Nothing if there are too few contours.
// `read` gives the masks of the frame with an index, as they are in the files. Throws InputError
// for masks that belong to the rectified images of a stereo camera and not to the images as read.
std::vector<std::string> CheckMaskPlaces(
    const ImageSequence& sequence, const PinholeCamera& camera,
    const std::function<std::vector<InstanceMask>(size_t)>& read);

// Classes in tracking.dynamic_classes or objects.sizes, other than the default ones, that no mask
// has, and sizes above 3 m, which may be in another unit. `labels` gives the classes of all masks.
std::vector<std::string> CheckClasses(const SystemOptions& options,
                                      const std::function<std::set<std::string>()>& labels);

// A last frame that is beyond the end of the sequence.
std::vector<std::string> CheckLastFrame(const FrameSelection& selection,
                                        const ImageSequence& sequence);

}  // namespace hullslam
