// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/camera/pinhole.h"
#include "live/live_inbox.h"
#include "view/view_model.h"

namespace hullslam {

// The image of a frame as browsers see it.
struct LivePicture {
  // With the outlines of all detections and the ellipses of their objects. In a frame without
  // detections, with the ellipses of all mapped objects in the image.
  ViewPicture picture;
  std::vector<float> matched;    // x, y of the keypoints that show a landmark, px of the picture
  std::vector<float> unmatched;  // x, y of the others
};

// Makes pictures whose JPEG files have about the wanted size: a picture that is larger makes the
// next ones smaller.
class LivePictures {
 public:
  // `jpeg_bytes` is the wanted size of a file.
  LivePictures(const PinholeCamera& camera, size_t jpeg_bytes)
      : camera_(camera), jpeg_bytes_(jpeg_bytes) {}

  // An empty image gives a picture of size 0.
  LivePicture Make(const LiveFrame& frame);

 private:
  void AddShapes(const LiveFrame& frame, double scale, ViewPicture& picture) const;
  void AddMappedObjects(const LiveFrame& frame, double scale, ViewPicture& picture) const;
  void AddKeypoints(const LiveFrame& frame, double scale, LivePicture& picture) const;

  const PinholeCamera camera_;
  const size_t jpeg_bytes_;
  double width_ = 480.0;  // px, of the next picture
};

}  // namespace hullslam
