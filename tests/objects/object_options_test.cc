// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_options.h"

#include <gtest/gtest.h>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

TEST(ObjectOptions, AreBoundByTheirNames) {
  ObjectOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("objects.enabled", "0", "test");
  table.Set("objects.guided_matching", "0", "test");
  table.Set("objects.residual", "algebraic_plane", "test");
  table.Set("objects.primitive", "hull", "test");
  table.Set("objects.sigma", "2.5", "test");
  EXPECT_FALSE(options.enabled);
  EXPECT_FALSE(options.guided_matching);
  EXPECT_EQ(options.residual, ObjectResidual::kAlgebraicPlane);
  EXPECT_EQ(options.detection.primitive, ObjectPrimitive::kHull);
  EXPECT_EQ(options.sigma, 2.5);
}

TEST(ObjectOptions, RefuseWhatIsOutOfRange) {
  ObjectOptions options;
  OptionTable table;
  options.Bind(table);
  EXPECT_THROW(table.Set("objects.residual", "tangents", "test"), InputError);
  EXPECT_THROW(table.Set("objects.sigma", "0", "test"), InputError);
  EXPECT_THROW(table.Set("objects.min_views", "1", "test"), InputError);
}

}  // namespace
}  // namespace hullslam
