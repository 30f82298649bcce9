// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/named_lens.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hullslam {
namespace {

struct Set {
  std::string expected;
  PinholeCamera camera;
};

Set SetLens(const char* model, const std::vector<double>& coefficients) {
  Set set;
  set.camera.k6 = 7.0;  // of an earlier lens
  set.expected = SetNamedLens(model, coefficients, set.camera);
  return set;
}

TEST(NamedLens, BrownsCoefficientsAreInTheOrderOfOpenCv) {
  for (const char* const model : {"plumb_bob", "radtan", "radtan5", "radial-tangential",
                                  "Brown Conrady", "rational_polynomial", "opencv"}) {
    const Set set = SetLens(model, {0.1, 0.2, 0.3, 0.4, 0.5});
    EXPECT_EQ(set.expected, "") << model;
    EXPECT_EQ(set.camera.k1, 0.1);
    EXPECT_EQ(set.camera.k2, 0.2);
    EXPECT_EQ(set.camera.p1, 0.3);
    EXPECT_EQ(set.camera.p2, 0.4);
    EXPECT_EQ(set.camera.k3, 0.5);
    EXPECT_EQ(set.camera.k6, 0.0);
    EXPECT_EQ(DescribeLens(set.camera), "with radial-tangential distortion");
  }
  const Set rational =
      SetLens("rational_polynomial", {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.0, 0.0});
  EXPECT_EQ(rational.expected, "");
  EXPECT_EQ(rational.camera.k4, 0.6);
  EXPECT_EQ(rational.camera.k5, 0.7);
  EXPECT_EQ(rational.camera.k6, 0.8);
  EXPECT_EQ(DescribeLens(rational.camera), "with rational distortion");
}

TEST(NamedLens, FisheyeHasManyNames) {
  for (const char* const model : {"equidistant", "FISHEYE", "kannala_brandt", "KannalaBrandt8"}) {
    const Set set = SetLens(model, {0.1, 0.2, 0.3, 0.4});
    EXPECT_EQ(set.expected, "") << model;
    EXPECT_TRUE(set.camera.IsFisheye());
    EXPECT_EQ(set.camera.k3, 0.3);
    EXPECT_EQ(set.camera.k4, 0.4);
    EXPECT_EQ(set.camera.p1, 0.0);
  }
  // Without distortion it still is no pinhole.
  EXPECT_TRUE(SetLens("equidistant", {0.0, 0.0, 0.0, 0.0}).camera.IsFisheye());
  EXPECT_EQ(DescribeLens(SetLens("fisheye", {0, 0, 0, 0}).camera),
            "with a fisheye lens (Kannala-Brandt)");
}

TEST(NamedLens, TheOtherWideLensesHaveTwoCoefficients) {
  const Set sphere = SetLens("DS", {-0.2, 0.6});
  EXPECT_EQ(sphere.expected, "");
  EXPECT_EQ(sphere.camera.lens, LensModel::kDoubleSphere);
  EXPECT_EQ(sphere.camera.xi, -0.2);
  EXPECT_EQ(sphere.camera.alpha, 0.6);
  EXPECT_EQ(sphere.camera.k6, 0.0);
  const Set unified = SetLens("eucm", {0.6, 1.1});
  EXPECT_EQ(unified.camera.lens, LensModel::kExtendedUnified);
  EXPECT_EQ(unified.camera.alpha, 0.6);
  EXPECT_EQ(unified.camera.beta, 1.1);
  EXPECT_EQ(DescribeLens(unified.camera), "with a fisheye lens (extended unified model)");
  EXPECT_EQ(SetLens("ds", {0.1}).expected, "expected 2 coefficients: xi alpha");
}

TEST(NamedLens, KalibrsFocalLengthOfADoubleSphereBecomesThatOnTheAxis) {
  PinholeCamera camera{.fx = 160.0, .fy = 80.0};
  EXPECT_EQ(SetLensOfKalibr("ds", std::vector{-0.2, 0.6}, camera), "");
  EXPECT_DOUBLE_EQ(camera.fx, 200.0);
  EXPECT_DOUBLE_EQ(camera.fy, 100.0);
  EXPECT_EQ(SetLensOfKalibr("eucm", std::vector{0.6, 1.0}, camera), "");
  EXPECT_DOUBLE_EQ(camera.fx, 200.0);
}

TEST(NamedLens, WhatIsMissingOrUnknownIsSaid) {
  EXPECT_EQ(SetLens("equidistant", {0.1, 0.2}).expected, "expected 4 coefficients: k1 k2 k3 k4");
  EXPECT_NE(SetLens("radtan", {0.1, 0.2}).expected.find("expected 4 to 5 coefficients"),
            std::string::npos);
  EXPECT_NE(SetLens("rational_polynomial", {0.1, 0, 0, 0, 0, 0, 0, 0, 0.2}).expected, "");
  EXPECT_NE(SetLens("rational_polynomial", {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}).expected, "");
  EXPECT_NE(SetLens("opencv", {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}).expected, "");
  EXPECT_NE(SetLens("plumb_bob", {0.1, 0, 0, 0, 0, 0.3}).expected, "");
  EXPECT_NE(SetLens("omnidirectional", {0.1, 0, 0, 0}).expected.find("expected plumb_bob"),
            std::string::npos);
  EXPECT_EQ(SetLens("omnidirectional", {0.0, 0.0}).expected, "");
  EXPECT_EQ(SetLens("", {}).expected, "");
}

}  // namespace
}  // namespace hullslam
