// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/eigen_alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace hullslam {
namespace {

// The flags of the compiler do not matter, see tests/consumer for programs with -mavx2.
TEST(EigenAlignment, TypesHaveTheAlignmentOfTheLibrary) {
  EXPECT_EQ(alignof(Eigen::Vector4d), 16U);
  EXPECT_EQ(alignof(Eigen::Matrix4d), 16U);
  EXPECT_EQ(alignof(Eigen::Quaterniond), 16U);
}

}  // namespace
}  // namespace hullslam
