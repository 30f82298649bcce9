// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/lens_fault.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

void ExpectFault(const PinholeCamera& camera, const std::string& part) {
  const std::string fault = camera.FindFault();
  EXPECT_NE(fault.find(part), std::string::npos) << "'" << fault << "' lacks '" << part << "'";
}

// r (1 - r^2) folds at 500 px times 0.3849; the corners are 400 px from the principal point.
TEST(LensFault, AFoldInTheImageIsNamedWithItsRadius) {
  PinholeCamera camera{.fx = 500, .fy = 500, .cx = 320, .cy = 240, .k1 = -1.0};
  ExpectFault(camera,
              "Camera.k1 is '-1': the distortion cannot be undone at pixel (0, 0), because "
              "it folds 192.4");
  camera.fx = camera.fy = 1200.0;  // then it folds beyond the corners
  EXPECT_EQ(camera.FindFault(), "");
  camera.k1 = 0.0;
  camera.k4 = 20.0;  // r / (1 + 20 r^2) folds at r = 0.22
  ExpectFault(camera, "Camera.k4 is '20': the distortion cannot be undone");
}

TEST(LensFault, AFisheyeThatFoldsInTheImageIsNamedWithItsRadius) {
  PinholeCamera camera = FisheyeCamera();
  EXPECT_EQ(camera.FindFault(), "");
  camera.k1 = -1.0 / 3.0;
  camera.k2 = camera.k3 = camera.k4 = 0.0;
  ExpectFault(camera, "Camera.k1 is '-0.333333': the distortion cannot be undone at pixel");
  ExpectFault(camera, "it folds 162.6");
  camera.fx = camera.fy = 800.0;  // the corners are at 30 degrees
  EXPECT_EQ(camera.FindFault(), "");
  camera.k1 = std::numeric_limits<double>::quiet_NaN();
  ExpectFault(camera, "Camera.k1 is 'nan'");
}

TEST(LensFault, AnImageThatGoesOnBehindTheCameraIsNoFisheye) {
  PinholeCamera camera{.fx = 60.0, .fy = 60.0, .cx = 320.0, .cy = 240.0};
  camera.lens = LensModel::kKannalaBrandt;
  ExpectFault(camera, "Camera.fx is '60': the field of view is larger than 360 degrees");
  ExpectFault(camera, "188.496 px from the principal point");
  camera.fx = camera.fy = 80.0;  // the rays to the upper border are at 172 degrees
  EXPECT_EQ(camera.FindFault(), "");
}

TEST(LensFault, AFisheyeHasFourCoefficients) {
  for (const auto field :
       {&PinholeCamera::p1, &PinholeCamera::p2, &PinholeCamera::k5, &PinholeCamera::k6}) {
    PinholeCamera camera = FisheyeCamera();
    camera.*field = 0.001;
    ExpectFault(camera,
                "is '0.001', expected 0: a fisheye lens (KannalaBrandt8) has only k1 to k4");
  }
}

TEST(LensFault, CoefficientsOfOtherLensesAreNamed) {
  PinholeCamera camera = DoubleSphereCamera();
  camera.k1 = 0.1;
  ExpectFault(camera,
              "Camera.k1 is '0.1', expected 0: a fisheye lens (DoubleSphere) has only xi "
              "to alpha");
  camera = ExtendedUnifiedCamera();
  camera.alpha = 1.5;
  ExpectFault(camera, "Camera.alpha is '1.5', expected a number from 0 to 1");
  camera = {.fx = 500, .fy = 500, .cx = 320, .cy = 240};
  camera.alpha = 0.6;
  ExpectFault(camera, "Camera.alpha is '0.6', expected 0: a PinHole has no such coefficient");
}

}  // namespace
}  // namespace hullslam
