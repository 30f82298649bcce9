// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/error.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(InputError, KeepsItsMessage) {
  const InputError error("a.txt:3: expected 4 numbers");
  EXPECT_STREQ(error.what(), "a.txt:3: expected 4 numbers");
}

// Programs exit with code 2 for InputError only, so neither error may be caught as the other.
TEST(InputError, IsNoCheckError) {
  EXPECT_TRUE((std::is_base_of_v<std::runtime_error, InputError>));
  EXPECT_FALSE((std::is_base_of_v<CheckError, InputError>));
  EXPECT_FALSE((std::is_base_of_v<InputError, CheckError>));
}

}  // namespace
}  // namespace hullslam
