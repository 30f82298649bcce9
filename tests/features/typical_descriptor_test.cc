// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/typical_descriptor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace hullslam {
namespace {

// A descriptor with the first `count` bits set.
Descriptor FirstBits(int count) {
  Descriptor descriptor{};
  for (int i = 0; i < count; ++i) {
    descriptor[static_cast<size_t>(i / 64)] |= uint64_t{1} << (i % 64);
  }
  return descriptor;
}

size_t MostTypicalOf(const std::vector<int>& counts) {
  std::vector<Descriptor> descriptors;
  for (const int count : counts) {
    descriptors.push_back(FirstBits(count));
  }
  return MostTypicalDescriptor(descriptors);
}

TEST(MostTypicalDescriptor, HasTheLeastMedianDistanceToTheOthers) {
  EXPECT_EQ(MostTypicalOf({0, 10, 12, 14, 100}), 2u);
  EXPECT_EQ(MostTypicalOf({200, 10, 11}), 1u);
}

TEST(MostTypicalDescriptor, TiesGoToTheFirst) {
  EXPECT_EQ(MostTypicalOf({5, 9}), 0u);
  EXPECT_EQ(MostTypicalOf({3, 3, 3}), 0u);
  EXPECT_EQ(MostTypicalOf({}), 0u);
}

}  // namespace
}  // namespace hullslam
