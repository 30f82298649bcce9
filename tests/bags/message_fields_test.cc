// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/message_fields.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

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

TEST(CdrWriterTest, NumbersAreAlignedBehindTheKind) {
  CdrWriter writer;
  writer.Put(uint8_t{7});
  writer.Put(uint32_t{1});
  writer.PutText("ab");
  writer.Put(8.0);
  const std::string message = writer.Message();
  EXPECT_EQ(message.substr(0, 4), std::string("\0\1\0\0", 4));
  EXPECT_EQ(message.size(), 4u + 8 + 4 + 3 + 1 + 8);
  EXPECT_EQ(message.substr(16, 4), std::string("ab\0\0", 4));
}

TEST(CdrWriterTest, FieldReaderReadsIt) {
  CdrWriter writer;
  writer.PutText("");
  writer.Put(int16_t{-3});
  writer.Put(0.25f);
  writer.PutBytes(std::string_view("\0x", 2));
  writer.Put(-1.5);
  writer.PutCount(2);
  writer.Put(uint64_t{1} << 63U);
  const std::string message = writer.Message();
  FieldReader reader(MessageCoding::kCdr, message, "message");
  EXPECT_EQ(reader.GetText(), "");
  EXPECT_EQ(reader.Get<int16_t>(), -3);
  EXPECT_EQ(reader.Get<float>(), 0.25f);
  EXPECT_EQ(reader.GetBytes(), std::string_view("\0x", 2));
  EXPECT_EQ(reader.Get<double>(), -1.5);
  EXPECT_EQ(reader.GetCount(4), 2u);
  EXPECT_EQ(reader.Get<uint64_t>(), uint64_t{1} << 63U);
}

}  // namespace

}  // namespace hullslam
