// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// A fisheye lens of 150 degrees across 640 px, with coefficients like those of TUM-VI.
inline PinholeCamera FisheyeCamera() {
  return {.fx = 244.0,
          .fy = 245.0,
          .cx = 318.0,
          .cy = 243.0,
          .k1 = 0.0035,
          .k2 = 0.0007,
          .k3 = -0.002,
          .bf = 19.0,
          .k4 = 0.0002,
          .lens = LensModel::kKannalaBrandt};
}

// The same field of view through a double sphere and through the extended unified model.
inline PinholeCamera DoubleSphereCamera() {
  return {.fx = 250.0,
          .fy = 251.0,
          .cx = 318.0,
          .cy = 243.0,
          .bf = 19.5,
          .lens = LensModel::kDoubleSphere,
          .xi = -0.2,
          .alpha = 0.6};
}
inline PinholeCamera ExtendedUnifiedCamera() {
  return {.fx = 243.0,
          .fy = 244.0,
          .cx = 318.0,
          .cy = 243.0,
          .bf = 19.0,
          .lens = LensModel::kExtendedUnified,
          .alpha = 0.62,
          .beta = 1.05};
}

// The pinhole camera of freiburg3 as a fisheye: the first terms of the series of tan(t). Within its
// field of view of 2 x 37 degrees they differ from the pinhole by less than 0.05 px.
inline PinholeCamera PinholeAsFisheye() {
  return {.fx = 535.4,
          .fy = 539.2,
          .cx = 320.1,
          .cy = 247.6,
          .k1 = 1.0 / 3.0,
          .k2 = 2.0 / 15.0,
          .k3 = 17.0 / 315.0,
          .k4 = 62.0 / 2835.0,
          .lens = LensModel::kKannalaBrandt};
}

}  // namespace hullslam
