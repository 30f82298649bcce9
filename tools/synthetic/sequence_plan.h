// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "synthetic/scene.h"
#include "synthetic/sensor.h"
#include "synthetic/sequence_layout.h"

namespace hullslam::synthetic {

// Everything that determines the files of a sequence.
struct SequencePlan {
  std::string name;   // of the scene, or of the sequence of the suite
  uint64_t seed = 0;  // what the user gave, for groundtruth_objects.json
  std::optional<uint64_t> rearranged = std::nullopt;  // likewise
  Scene scene;
  int frames = 0;
  PinholeCamera camera;
  double stereo_baseline = 0.0;  // m, to the right camera of a stereo pair; 0 for none
  double readout_time = 0.0;     // s, from the top to the bottom row of an image (rolling shutter)
  double exposure_time = 0.0;    // s, of each row; 0 for images without motion blur
  Sensor::Options sensor;
  uint64_t sensor_seed = 0;
  SequenceLayout layout;
};

}  // namespace hullslam::synthetic
