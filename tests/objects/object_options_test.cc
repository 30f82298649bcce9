// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/objects/object_options.h"

#include <gtest/gtest.h>

#include "hullslam/util/error.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(ObjectOptions, AreBoundByTheirNames) {
  ObjectOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("objects.enabled", "0", "test");
  table.Set("objects.guided_matching", "0", "test");
  table.Set("objects.residual", "algebraic_plane", "test");
  table.Set("objects.detection.primitive", "hull", "test");
  table.Set("objects.sigma", "2.5", "test");
  EXPECT_FALSE(options.enabled);
  EXPECT_FALSE(options.guided_matching);
  EXPECT_EQ(options.refinement.constraint.residual, ObjectResidual::kAlgebraicPlane);
  EXPECT_EQ(options.pose.constraint.residual, ObjectResidual::kAlgebraicPlane);
  EXPECT_EQ(options.bundle.constraint.residual, ObjectResidual::kAlgebraicPlane);
  EXPECT_EQ(options.detection.primitive, ObjectPrimitive::kHull);
  EXPECT_EQ(options.pose.constraint.sigma_px, 2.5);
  EXPECT_EQ(options.bundle.constraint.sigma_px, 2.5);
}

TEST(ObjectOptions, EachUseHasItsOwnResidualAndLoss) {
  ObjectOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("objects.residual", "algebraic_plane", "test");
  table.Set("objects.pose.residual", "tangent", "test");
  table.Set("objects.bundle.loss", "huber", "test");
  table.Set("objects.max_effective_lines", "5", "test");
  table.Set("objects.pose.max_effective_lines", "6", "test");
  EXPECT_EQ(options.refinement.constraint.residual, ObjectResidual::kAlgebraicPlane);
  EXPECT_EQ(options.pose.constraint.residual, ObjectResidual::kTangent);
  EXPECT_EQ(options.bundle.constraint.residual, ObjectResidual::kAlgebraicPlane);
  EXPECT_EQ(options.bundle.constraint.loss, RobustLoss::kHuber);
  EXPECT_EQ(options.refinement.constraint.max_effective_lines, 4.0);
  EXPECT_EQ(options.pose.constraint.max_effective_lines, 6.0);
  EXPECT_EQ(options.bundle.constraint.max_effective_lines, 5.0);
}

TEST(ObjectOptions, RefuseAResidualThatThePrimitiveHasNot) {
  for (const char* const use : {"refinement", "pose", "bundle"}) {
    ObjectOptions options;
    OptionTable table;
    options.Bind(table);
    EXPECT_NO_THROW(options.Validate());
    const std::string key = "objects." + std::string(use) + ".residual";
    table.Set(key, "distribution", "test");
    ExpectInputError([&] { options.Validate(); }, {key, "'distribution'", "'support'"});
    table.Set("objects.detection.primitive", "conic", "test");
    EXPECT_NO_THROW(options.Validate());
  }
}

TEST(ObjectOptions, KeysFollowTheStructs) {
  ObjectOptions options;
  OptionTable table;
  options.Bind(table);
  table.Set("objects.detection.min_keypoints", "3", "test");
  table.Set("objects.start.min_parallax_without_depth", "20", "test");
  table.Set("objects.validity.min_overlap", "0.4", "test");
  table.Set("objects.refinement.max_misfit_px", "9", "test");
  table.Set("objects.prior_sigma_without_depth", "0.3", "test");
  EXPECT_EQ(options.detection.min_keypoints, 3);
  EXPECT_EQ(options.start.min_parallax_without_depth, 20.0);
  EXPECT_EQ(options.validity.min_overlap, 0.4);
  EXPECT_EQ(options.refinement.max_misfit_px, 9.0);
  EXPECT_EQ(options.refinement.constraint.prior_without_depth.log_axes, 0.3);
  EXPECT_EQ(options.bundle.constraint.prior_without_depth.log_axes, 0.3);
}

TEST(ObjectOptions, RefuseWhatIsOutOfRange) {
  ObjectOptions options;
  OptionTable table;
  options.Bind(table);
  EXPECT_THROW(table.Set("objects.residual", "tangents", "test"), InputError);
  EXPECT_THROW(table.Set("objects.sigma", "0", "test"), InputError);
  EXPECT_THROW(table.Set("objects.start.min_views", "0", "test"), InputError);
  EXPECT_THROW(table.Set("objects.culling.min_found_ratio", "1.5", "test"), InputError);
  EXPECT_THROW(table.Set("objects.fusion.min_overlap", "-1", "test"), InputError);
  EXPECT_THROW(table.Set("objects.validity.max_stretch", "0.5", "test"), InputError);
  EXPECT_THROW(table.Set("objects.pose.loss", "l2", "test"), InputError);
  EXPECT_THROW(table.Set("objects.bundle.loss_scale", "0", "test"), InputError);
  EXPECT_THROW(table.Set("objects.refinement.depth_points", "-1", "test"), InputError);
}

}  // namespace
}  // namespace hullslam
