// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <set>
#include <string>
#include <vector>

#include "exports/export_camera.h"
#include "exports/export_folder.h"
#include "exports/export_input.h"
#include "exports/keyframe_images.h"
#include "exports/nerfstudio.h"

namespace hullslam {

// The functions here need ExportInput::map and ::sequence.

// The keyframes with their images. Notes how many keyframes have none. Throws InputError if there
// are none at all.
std::vector<KeyframeImage> FindImages(ExportInput& input);

// Gives the points of the model the colours of the images, if it is not already known from the
// notes that there are no images. Images that cannot be read are left out, with a note.
void ColourPoints(ExportInput& input);

// Writes the undistorted images "images/NAME.png" and gives the points of the model their colours.
// Throws InputError if an image cannot be read.
void WriteImages(const std::vector<KeyframeImage>& images, const ExportCamera& view,
                 ExportInput& input, ExportFolder& folder);

// Writes the undistorted right images "images/NAME_right.png" of a stereo camera, in grey.
void WriteRightImages(const std::vector<KeyframeImage>& images, const ExportCamera& view,
                      const ExportInput& input, ExportFolder& folder);

// Writes "depths/NAME.png" for each image of an RGB-D run, and "masks/NAME.png", which is 0 where
// things of these classes are and 255 elsewhere, if the run had masks of them. nerfstudio expects
// depths and masks for all images or for none. Returns the frames for transforms.json.
std::vector<NerfstudioFrame> WriteDepthsAndMasks(const std::vector<KeyframeImage>& images,
                                                 const ExportCamera& view,
                                                 const std::set<std::string>& masked_classes,
                                                 ExportInput& input, ExportFolder& folder);

}  // namespace hullslam
