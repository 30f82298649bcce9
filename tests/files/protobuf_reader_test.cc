// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/protobuf_reader.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"

namespace hullslam {
namespace {

using namespace std::string_literals;

// Field 1: the number 300, as two bytes. Field 2: a text. Field 3 and 4: numbers of a fixed size.
const std::string kMessage = "\x08\xac\x02\x12\x03"s + "abc" + "\x1d\x01\x02\x00\x00"s +
                             "\x21\x05\x00\x00\x00\x00\x00\x00\x01"s;

TEST(ProtobufReaderTest, FieldsOfEveryKindAreRead) {
  ProtobufReader reader(kMessage, "message");
  ASSERT_TRUE(reader.Next());
  EXPECT_EQ(reader.field(), 1u);
  EXPECT_EQ(reader.number(), 300u);
  ASSERT_TRUE(reader.Next());
  EXPECT_EQ(reader.field(), 2u);
  EXPECT_EQ(reader.bytes(), "abc");
  ASSERT_TRUE(reader.Next());
  EXPECT_EQ(reader.number(), 0x0201u);
  EXPECT_TRUE(reader.bytes().empty());
  ASSERT_TRUE(reader.Next());
  EXPECT_EQ(reader.number(), (uint64_t{1} << 56U) + 5);
  EXPECT_FALSE(reader.Next());
}

TEST(ProtobufReaderTest, CutAndBrokenMessagesAreRefused) {
  const auto read = [](const std::string& bytes) {
    ProtobufReader reader(bytes, "message 7");
    while (reader.Next()) {
    }
  };
  for (const size_t kept : {1u, 2u, 4u, 6u, 10u, 20u}) {
    ExpectInputError([&] { read(kMessage.substr(0, kept)); }, {"message 7 is cut off"});
  }
  ExpectInputError([&] { read("\x12\xff\xff\xff\xff\x7f"); }, {"message 7 is cut off"});
  ExpectInputError([&] { read("\x08" + std::string(11, '\xff')); }, {"more than ten bytes"});
  ExpectInputError([&] { read("\x0b"); }, {"message 7 has a field of no known kind"});
}

}  // namespace
}  // namespace hullslam
