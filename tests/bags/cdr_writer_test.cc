// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/cdr_writer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "bags/field_reader.h"

namespace hullslam {
namespace {

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
