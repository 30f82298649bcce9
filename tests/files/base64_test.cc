// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/base64.h"

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
    EXPECT_EQ(DecodeBase64(text), bytes);
    EXPECT_EQ(Base64Size(std::string(bytes).size()), std::string(text).size());
  }
}

TEST(Base64, TakesAllBytes) { EXPECT_EQ(EncodeBase64(std::string("\xff\xfe\x00", 3)), "//4A"); }

TEST(Base64, AllBytesComeBack) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) {
    bytes += static_cast<char>(i);
    EXPECT_EQ(DecodeBase64(EncodeBase64(bytes)), bytes);
  }
}

TEST(Base64, LinesAndMissingPaddingAreRead) {
  EXPECT_EQ(DecodeBase64("Zm9v\r\nYm Fy\n"), "foobar");
  EXPECT_EQ(DecodeBase64("Zm9vYg"), "foob");
  EXPECT_EQ(DecodeBase64("Zm9vYmE"), "fooba");
}

TEST(Base64, OtherTextIsRefused) {
  for (const char* const text :
       {"Z", "Zm9vY", "Zm9*", "Zm9vYg=", "Zm9vYg===", "Zg==Zg==", "=", "Zm9v====", "Zm-_"}) {
    EXPECT_FALSE(DecodeBase64(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace hullslam
