// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/fnv1a.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

// Values of the authors' test vectors.
TEST(Fnv1a, HasThePublishedValues) {
  EXPECT_EQ(Fnv1a<uint32_t>(""), 0x811c9dc5U);
  EXPECT_EQ(Fnv1a<uint32_t>("foobar"), 0xbf9cf968U);
  EXPECT_EQ(Fnv1a<uint64_t>(""), 0xcbf29ce484222325U);
  EXPECT_EQ(Fnv1a<uint64_t>("foobar"), 0x85944171f73967e8U);
}

}  // namespace
}  // namespace hullslam
