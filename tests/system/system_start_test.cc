// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/system_start.h"

#include <gtest/gtest.h>

#include "hullslam/system/system.h"
#include "hullslam/util/check.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

TEST(SystemStart, LocalizationNeedsAMap) {
  SystemOptions options;
  options.camera = SyntheticSensor().camera;
  EXPECT_THROW(System(options, PipelineKind::kSequential, {.localization_only = true}), CheckError);
  EXPECT_EQ(System(options, PipelineKind::kSequential, {.session_name = "a"}).map(), nullptr);
}

}  // namespace
}  // namespace hullslam
