// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/published.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace hullslam {
namespace {

TEST(Published, IsNullBeforeTheFirstPublish) { EXPECT_EQ(Published<int>().Get(), nullptr); }

TEST(Published, GivesTheNewest) {
  Published<int> published;
  published.Publish(std::make_shared<const int>(1));
  published.Publish(std::make_shared<const int>(2));
  EXPECT_EQ(*published.Get(), 2);
}

TEST(Published, ReadersKeepTheirVersionAndOldOnesAreFreed) {
  Published<int> published;
  published.Publish(std::make_shared<const int>(1));
  std::shared_ptr<const int> kept = published.Get();
  const std::weak_ptr<const int> watched = kept;
  published.Publish(std::make_shared<const int>(2));
  EXPECT_EQ(*kept, 1);
  kept.reset();
  EXPECT_TRUE(watched.expired());
}

// A reader only sees complete values, and never an older value after a newer one.
TEST(Published, ReadersSeeCompleteValuesInOrder) {
  constexpr int kVersions = 3000;
  Published<std::array<int, 16>> published;
  std::thread writer([&] {
    for (int version = 1; version <= kVersions; ++version) {
      std::array<int, 16> value{};
      value.fill(version);
      published.Publish(std::make_shared<const std::array<int, 16>>(value));
    }
  });
  int last = 0;
  while (last < kVersions) {
    const auto value = published.Get();
    if (value == nullptr) {
      continue;
    }
    EXPECT_GE(value->front(), last);
    EXPECT_EQ(value->front(), value->back());
    last = value->front();
  }
  writer.join();
}

}  // namespace
}  // namespace hullslam
