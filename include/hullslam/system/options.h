// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "hullslam/bow/vocabulary.h"
#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/features/feature_options.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/loop/loop_options.h"
#include "hullslam/mapping/mapping_options.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/tracking/tracking_options.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// The conditions for a run to count as failed because too many frames were lost.
struct RunOptions {
  double max_lost_share = 0.1;   // largest share of the frames without a pose
  double max_lost_at_end = 1.0;  // s, longest time without a pose at the end

  // Binds the keys `run.max_lost_share` and `run.max_lost_at_end`.
  void Bind(OptionTable& options);
};

// The error of the odometry of a sequence (PriorBetween).
struct OdometryOptions {
  double sigma_way = 0.02;   // standard deviation of a step, as a share of its length
  double sigma_turn = 0.02;  // the same of its rotation

  // Binds the keys `odometry.sigma_way` and `odometry.sigma_turn`.
  void Bind(OptionTable& options);
};

// All options of a run. The defaults are in the structs. The camera has no default.
struct SystemOptions {
  SensorKind sensor = SensorKind::kRgbd;  // not a setting of the table: each program has its own
  PinholeCamera camera;
  double frames_per_second = 30.0;  // frame rate of the camera
  double readout_time = 0.0;        // s, see Sensor::readout_time
  ReadoutDirection readout_direction = ReadoutDirection::kRows;
  bool rgb_order = false;  // order of channels of colour images from memory: RGB, else BGR
  DepthOptions depth;
  FeatureOptions features;
  TrackingOptions tracking;
  MappingOptions mapping;
  ObjectOptions objects;
  LoopOptions loop;
  OdometryOptions odometry;
  RunOptions run;
  // The vocabulary for the words of frames and the index of the map. Null: frames have no words. It
  // is not a setting of the table; see ReadVocabulary() and FindDefaultVocabulary().
  std::shared_ptr<const Vocabulary> vocabulary;
  uint64_t seed = 0;  // seed of all random choices
  // One mask for all images (Sensor::mask_all), and one for all right images of a stereo camera;
  // empty: all pixels are used. No settings of the table.
  cv::Mat mask_all;
  cv::Mat mask_all_right;

  // Binds every option once. The struct must outlive the table. `Viewer.*` keys of ORB-SLAM2 are
  // accepted and ignored.
  OptionTable Bind();
  // Throws InputError if the options are in their ranges but cannot be used: a camera without focal
  // length, pyramid levels that are smaller than a patch, or a mask of all images that does not
  // have their size or ignores all pixels.
  void Validate() const;
};

}  // namespace hullslam
