// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/content_hash.h"

#include <gtest/gtest.h>

#include <string>

namespace hullslam {
namespace {

TEST(ContentHash, IsXxh3InHexadecimalDigits) {
  EXPECT_EQ(ContentHash("", 0), "2d06800538d394c2");  // of xxHash's own tests
  const std::string bytes(100'000, 'a');
  EXPECT_EQ(ContentHash(bytes.data(), bytes.size()), ContentHash(bytes.data(), bytes.size()));
  std::string other = bytes;
  other[77'777] = 'b';
  EXPECT_NE(ContentHash(bytes.data(), bytes.size()), ContentHash(other.data(), other.size()));
}

}  // namespace
}  // namespace hullslam
