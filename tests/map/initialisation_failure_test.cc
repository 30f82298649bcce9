// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/initialisation_failure.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(InitialisationFailure, NamesAreDifferent) {
  for (const InitialisationFailure a : kInitialisationFailures) {
    EXPECT_FALSE(ToString(a).empty());
    for (const InitialisationFailure b : kInitialisationFailures) {
      EXPECT_EQ(ToString(a) == ToString(b), a == b);
    }
  }
}

}  // namespace
}  // namespace hullslam
