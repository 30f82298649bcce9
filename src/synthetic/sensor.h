// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "synthetic/hash_noise.h"
#include "synthetic/renderer.h"

namespace hullslam::synthetic {

// An RGB-D camera of the first Kinect's kind that looks at rendered frames. What is random depends
// on seed, frame number and pixel alone.
class Sensor {
 public:
  struct Options {
    bool noise = true;  // false: exact colours and depths, only rounded to the image's units
    double units_per_metre = 5000.0;
    double min_depth = 0.5;  // metres; nearer and further ones are unknown
    double max_depth = 8.0;
    // Width of a step of the measured disparity, as a change of inverse depth (1/m): an eighth of
    // a pixel at a focal length of 580 px and a baseline of 7.5 cm (Khoshelham and Elberink 2012).
    // A step of depth is this times z^2.
    double disparity_step = 2.87e-3;
  };

  Sensor(const Options& options, uint64_t seed) : options_(options), seed_(seed) {}

  // CV_8UC3, BGR: vignette, slow changes of exposure, and noise with a part that grows with the
  // signal.
  cv::Mat Colour(const RenderedFrame& frame, uint32_t number) const;
  // CV_16UC1, 0 where unknown. Disparity has half a step of noise, partly common to neighbours as
  // in block matching, and is then rounded, so that the error grows with z^2. Unknown are depths
  // out of range, surfaces seen at a grazing angle, what the pattern's projector (to the right of
  // the camera) does not reach, and many pixels at depth edges; others there take their
  // neighbour's depth.
  cv::Mat Depth(const RenderedFrame& frame, uint32_t number) const;

 private:
  Options options_;
  uint64_t seed_;
  NormalTable normal_;
};

}  // namespace hullslam::synthetic
