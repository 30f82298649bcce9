// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/components.h"

#include <gtest/gtest.h>

#include <string>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

std::string FaultOf(std::string_view component) {
  try {
    RequireComponent(component, "--mcap is given");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// Tests are built with all components (the folder tests/components builds without them).
TEST(Components, AllOfThisBuildAreThere) {
  for (const char* name : {"VIDEO", "BAGS", "LIVE", "EXPORTS", "SCENE", "SEGMENTATION"}) {
    EXPECT_EQ(FaultOf(name), "") << name;
  }
}

TEST(Components, AMissingOneIsNamedWithTheOptionThatAddsIt) {
  EXPECT_EQ(FaultOf("RADAR"),
            "--mcap is given, but this HullSLAM was built without the component RADAR (expected: "
            "cmake -D HULLSLAM_WITH_RADAR=ON)");
  EXPECT_NE(FaultOf("BAG"), "") << "a part of a name is no name";
}

}  // namespace
}  // namespace hullslam
