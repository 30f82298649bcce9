// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/options.h"

#include <cmath>
#include <string>

#include "hullslam/util/error.h"

namespace hullslam {

void RunOptions::Bind(OptionTable& options) {
  const OptionScope scope(options, "run");
  scope.Add("max_lost_share", &max_lost_share, Range::Share(),
            "the run fails (exit code 1) if a larger share of its frames has no pose");
  scope.Add("max_lost_at_end", &max_lost_at_end, Range::AtLeast(0.0),
            "the run fails (exit code 1) if no frame of a longer time at its end has a pose, s");
}

OptionTable SystemOptions::Bind() {
  OptionTable table;
  camera.Bind(table);
  const OptionScope scope(table, "Camera");
  scope.Add("fps", &frames_per_second, Range::Positive(), "frame rate of the camera, 1/s");
  scope.Add(
      "readout_time", &readout_time, Range::Between(-0.1, 0.1),
      "rolling shutter: time from the top row of an image to the bottom row (columns: from left "
      "to right), s; negative: the other way round; 0: all at once");
  scope.AddEnum("readout_direction", &readout_direction, {"rows", "columns"},
                "rolling shutter: an image is exposed row after row or column after column");
  scope.Add("RGB", &rgb_order,
            "colour images that the library receives from memory are RGB (else BGR)");
  depth.Bind(table);
  features.Bind(table);
  tracking.Bind(table);
  mapping.Bind(table);
  objects.Bind(table);
  loop.Bind(table);
  run.Bind(table);
  for (const char* name :
       {"KeyFrameSize", "KeyFrameLineWidth", "GraphLineWidth", "PointSize", "CameraSize",
        "CameraLineWidth", "ViewpointX", "ViewpointY", "ViewpointZ", "ViewpointF"}) {
    table.AddIgnored(std::string("Viewer.") + name);
  }
  return table;
}

void SystemOptions::Validate() const {
  if (camera.fx <= 0.0 || camera.fy <= 0.0) {
    throw InputError("settings: Camera.fx and Camera.fy are not given, expected numbers > 0");
  }
  if (const std::string fault = camera.FindFault(); !fault.empty()) {
    throw InputError("settings: " + fault);
  }
  const double top_scale = std::pow(features.scale_factor, features.level_count - 1);
  const double smallest_side = std::min(camera.width, camera.height) / top_scale;
  if (smallest_side < 64.0) {
    throw InputError("settings: ORBextractor.nLevels is '" + std::to_string(features.level_count) +
                     "', its smallest image would be " + std::to_string(smallest_side) +
                     " px, expected at least 64 px");
  }
  objects.Validate();
}

}  // namespace hullslam
