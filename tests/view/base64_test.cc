// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/base64.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace hullslam {
namespace {

// The test vectors of RFC 4648, section 10.
TEST(Base64, AgreesWithTheStandard) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    EXPECT_EQ(EncodeBase64(bytes), text);
    EXPECT_EQ(Base64Size(std::string(bytes).size()), std::string(text).size());
  }
}

TEST(Base64, TakesAllBytes) { EXPECT_EQ(EncodeBase64(std::string("\xff\xfe\x00", 3)), "//4A"); }

}  // namespace
}  // namespace hullslam
