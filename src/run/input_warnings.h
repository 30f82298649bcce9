// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/options.h"
#include "run/mask_arguments.h"

namespace hullslam {

// Each function below prints a warning on stderr if the input can be used but is probably not what
// the user meant.

// Warns if the depth images are not registered to their colour images: where the depth has a step,
// the colour then changes no more than elsewhere (DepthRegistration). Uses seven images. Prints
// nothing if they have too few steps.
void WarnOfUnregisteredDepth(const ImageSequence& sequence, const PinholeCamera& camera);
// Warns if no mask has a class that tracking.dynamic_classes or objects.sizes names. Classes that
// are there by default are not reported. Also warns of sizes above 3 m, which may be in another
// unit.
void WarnOfUnknownClasses(const TrackingOptions& tracking, const ObjectOptions& objects,
                          const SequenceMasks& masks);
// Warns if the outlines of masks do not run along borders in the images (MaskRegistration): they
// may be masks of the images as EXIF data turn them. Uses seven images of the beginning. Prints
// nothing if there are too few contours.
// `read` gives the masks of the frame with an index. Throws InputError for masks that belong to the
// rectified images of a stereo camera and not to the images as read.
void WarnOfMisplacedMasks(const ImageSequence& sequence, const PinholeCamera& camera,
                          const std::function<std::vector<InstanceMask>(size_t)>& read);
// Warns if --last is beyond the end of the sequence.
void WarnOfLastFrame(const FrameSelection& selection, const ImageSequence& sequence);

// Prints the faults of the files of the sequence that do not end a run.
void PrintWarnings(const ImageSequence& sequence);

}  // namespace hullslam
