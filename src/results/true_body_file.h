// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "eval/body_metrics.h"

namespace hullslam {

// Reads true bodies in any of these forms, which the content tells (docs/outputs.md):
// - a list of boxes, cylinders and ellipsoids;
// - `groundtruth_objects.json` of make_synthetic, without objects that move. An object that is
//   round but no ellipsoid counts as a cylinder, and all others as their tight boxes;
// - `scene_gt.json` of a scene of BOP, with `scene_camera.json`, which must have cam_R_w2c and
//   cam_t_w2c, and perhaps `scene_gt_info.json` beside it, and with `models_info.json` beside it or
//   in ../../models or ../../models_eval. Bodies are the boxes of the models. Annotations of one
//   model whose centres are at most half of its Size() apart in the world are one body, whose pose
//   is the one nearest to the median of their positions. Continuous symmetries about another axis
//   than x, y or z are left out. A body whose visible share is below 0.1 in all images is not
//   counted (the bound of BOP's targets). The class is the name of the model, such as obj_000002.
// - the folder obj_offline of a sequence of Cube-Diorama, in the form of RO-MAP (Han et al. 2023):
//   a text file for each object, 0.txt and so on. After a comment it has a line `class tx ty tz qx
//   qy qz qw` (world from object, m) with the half axes of the box, or with its two corners in the
//   frame of the object, xmin ymin zmin xmax ymax zmax; then a line `stamp x y height width` for
//   each image that shows the object. The class is a number, of COCO from 0.
// Throws InputError that names the file and the key or line, for missing and unknown keys, numbers
// that cannot be, rotations that are mirrored or not of unit length, repeated ids, and if there is
// no body.
std::vector<TrueBody> ReadTrueBodies(const std::filesystem::path& path);

}  // namespace hullslam
