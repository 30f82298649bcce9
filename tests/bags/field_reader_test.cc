// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/field_reader.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "bags/cdr_writer.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

using namespace std::string_literals;

// One byte, a gap of three, a number of four bytes, a text, and a double at a multiple of eight.
const std::string kLittleEndian = "\0\1\0\0\7\0\0\0\1\2\0\0\3\0\0\0ab\0\0\0\0\0\0\0\0\x20\x40"s;
const std::string kBigEndian = "\0\0\0\0\7\0\0\0\0\0\2\1\0\0\0\3ab\0\0\x40\x20\0\0\0\0\0\0"s;

TEST(FieldReaderTest, CdrIsReadInBothOrdersOfBytes) {
  for (const std::string& bytes : {kLittleEndian, kBigEndian}) {
    FieldReader reader(MessageCoding::kCdr, bytes, "message");
    EXPECT_EQ(reader.Get<uint8_t>(), 7);
    EXPECT_EQ(reader.Get<uint32_t>(), 0x201u);
    EXPECT_EQ(reader.GetText(), "ab");
    EXPECT_EQ(reader.Get<double>(), 8.0);
  }
}

TEST(FieldReaderTest, Ros1HasNoGaps) {
  const std::string bytes = "\7\1\2\0\0\2\0\0\0ab\0\0\0\0\0\0\x20\x40"s;
  FieldReader reader(MessageCoding::kRos1, bytes, "message");
  EXPECT_EQ(reader.Get<uint8_t>(), 7);
  EXPECT_EQ(reader.Get<uint32_t>(), 0x201u);
  EXPECT_EQ(reader.GetText(), "ab");
  EXPECT_EQ(reader.Get<double>(), 8.0);
}

TEST(FieldReaderTest, EveryCutIsRefused) {
  for (size_t kept = 0; kept < kLittleEndian.size(); ++kept) {
    ExpectInputError(
        [&] {
          FieldReader reader(MessageCoding::kCdr, std::string_view(kLittleEndian).substr(0, kept),
                             "a.mcap: message 3");
          reader.Get<uint8_t>();
          reader.Get<uint32_t>();
          reader.GetText();
          reader.Get<double>();
        },
        {"a.mcap: message 3 "});
  }
}

TEST(FieldReaderTest, AbsurdLengthsAreRefused) {
  const std::string bytes = "\0\1\0\0\xff\xff\xff\xff"s;
  ExpectInputError([&] { FieldReader(MessageCoding::kCdr, bytes, "m").GetText(); },
                   {"m has more elements than bytes"});
  ExpectInputError([&] { FieldReader(MessageCoding::kCdr, bytes, "m").GetCount(8); },
                   {"m has more elements than bytes"});
}

TEST(FieldReaderTest, OtherRepresentationsThanPlainCdrAreRefused) {
  for (const char kind : {'\2', '\3', '\7'}) {
    const std::string bytes = {'\0', kind, '\0', '\0'};
    ExpectInputError([&] { FieldReader(MessageCoding::kCdr, bytes, "m"); },
                     {"m has the representation 000", "plain CDR"});
  }
  ExpectInputError([] { FieldReader(MessageCoding::kCdr, "\x28\xb5\x2f\xfd", "m"); }, {"28b5"});
}

}  // namespace
}  // namespace hullslam
