// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "view/point_colours.h"
#include "view/view_model.h"

namespace hullslam {

// A visitor of the image of a moment. The image is in colour with blue first, CV_8UC3, in raw
// pixels, and has the size of the camera.
struct ImageTask {
  double timestamp = 0.0;  // s
  std::function<void(const cv::Mat& image)> use;
};

// The tasks that were left out.
struct LeftOutTasks {
  size_t absent = 0;      // the sequence has no image of this moment: it is of another session
  size_t unreadable = 0;  // the image cannot be read, or has not the size of the camera
};

// Loads the images of the tasks, each once, in order of time.
LeftOutTasks RunImageTasks(const ImageSequence& sequence, const PinholeCamera& camera,
                           std::vector<ImageTask> tasks);

// The tasks that add the images of all keyframes to `colours`. `camera` and `colours` must outlive
// the tasks.
std::vector<ImageTask> ColourTasks(const Map& map, const PinholeCamera& camera,
                                   PointColours& colours);

// The tasks that add pictures of at most `most` keyframes, evenly chosen, with the outlines of the
// objects' masks and the projected ellipsoids, and up to three cut-outs of each object: of the best
// views from different directions. `model.camera` must be set.
std::vector<ImageTask> PictureTasks(size_t most, ViewModel& model);

}  // namespace hullslam
