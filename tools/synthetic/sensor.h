// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "synthetic/hash_noise.h"
#include "synthetic/renderer.h"

namespace hullslam::synthetic {

// How the depth images come about. kKinect: as of the first Kinect. kIclNuim: as in the data set
// ICL-NUIM, whose depth is rendered and then disturbed.
enum class DepthModel { kKinect, kIclNuim };

// Simulates an RGB-D camera on rendered frames. The random errors depend only on seed, frame number
// and pixel.
class Sensor {
 public:
  struct Options {
    DepthModel model = DepthModel::kKinect;
    // Standard deviation of the blur of the lens (px); 0 for none.
    double lens_blur = 0.0;
    // Whether each pixel has one colour filter (Bayer's pattern), so that the other two colours are
    // interpolated: the noise of neighbours is then alike, and edges are softer.
    bool bayer = false;
    bool noise = true;  // false: exact colours and depths, only rounded to integers
    double units_per_metre = 5000.0;
    double min_depth = 0.5;  // metres; depths outside these limits are unknown
    double max_depth = 8.0;
    // Size of one step of the measured disparity, as a change of inverse depth (1/m): an eighth of
    // a pixel at a focal length of 580 px and a baseline of 7.5 cm (Khoshelham and Elberink 2012).
    // One step of depth is this times z^2. (In kIclNuim the step is 1/351.30, see sensor.cc.)
    double disparity_step = 2.87e-3;
  };

  Sensor(const Options& options, uint64_t seed) : options_(options), seed_(seed) {}

  // The colour image, CV_8UC3, BGR, with vignetting, slow changes of exposure, and noise. A part of
  // the noise grows with the brightness.
  cv::Mat Colour(const RenderedFrame& frame, uint32_t number) const;
  // The depth image (along z), CV_16UC1, 0 where unknown. The disparity gets noise of half a step,
  // which neighbours partly share as in block matching, and is then rounded, so that the error of
  // the depth grows with z^2. The depth is unknown if it is out of range, if the surface is seen at
  // a grazing angle, and if the projector (to the right of the camera) does not reach the surface.
  // Many pixels at depth edges are unknown too; other pixels there take the depth of a neighbour.
  // With kIclNuim, each pixel takes the depth at a point beside it, whose disparity gets a little
  // noise and is rounded; all pixels within the range are known (Barron and Malik 2013).
  cv::Mat Depth(const RenderedFrame& frame, uint32_t number) const;

 private:
  cv::Mat IclNuimDepth(const RenderedFrame& frame, uint32_t number) const;

  Options options_;
  uint64_t seed_;
  NormalTable normal_;
};

}  // namespace hullslam::synthetic
