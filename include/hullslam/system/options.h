// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/features/extractor.h"
#include "hullslam/mapping/mapping_options.h"
#include "hullslam/objects/object_options.h"
#include "hullslam/tracking/tracking_options.h"
#include "hullslam/util/option_table.h"

namespace hullslam {

// All that can be set for a run. The defaults are those of the structs; the camera has none.
struct SystemOptions {
  PinholeCamera camera;
  double frames_per_second = 30.0;  // of the camera
  bool rgb_order = true;            // channels of colour images fed from memory: RGB, else BGR
  DepthOptions depth;
  FeatureOptions features;
  TrackingOptions tracking;
  MappingOptions mapping;
  ObjectOptions objects;

  // Names every option once; the struct must outlive the table. `Viewer.*` keys of ORB-SLAM2 are
  // accepted and ignored.
  OptionTable Bind();
  // Throws InputError where options that are each in range do not fit together: a camera without
  // focal length, levels smaller than a patch.
  void Validate() const;
};

}  // namespace hullslam
