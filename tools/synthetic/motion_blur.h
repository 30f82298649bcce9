// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

#include "hullslam/camera/pinhole.h"
#include "synthetic/renderer.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// When the rows of an image collect light. Seconds.
struct Exposure {
  double time = 0.0;          // the middle of the exposure of the middle row
  double readout_time = 0.0;  // from the top to the bottom row (rolling shutter)
  double duration = 0.0;      // of each row; 0 for an image without motion blur
};

// The colours of a rendered frame as a camera sees them that moves, together with moving objects,
// while its rows are exposed: each pixel gets the mean of the colours along the line on which its
// surface moves through the image. A pixel beside the silhouette of something that moves otherwise
// is only roughly right, because what is hidden in the middle of the exposure is not known.
// Returns CV_32FC3 like RenderedFrame::colour; the frame must be that of `exposure.time`.
cv::Mat BlurByMotion(const RenderedFrame& frame, const Scene& scene, const PinholeCamera& camera,
                     const Exposure& exposure);

}  // namespace hullslam::synthetic
