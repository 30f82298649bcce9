// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/bytes.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>

#include "support/expect_error.h"

namespace hullslam {
namespace {

const Eigen::Matrix2d kMatrix = (Eigen::Matrix2d() << 1.0, -2.0, 3.5, 0.0).finished();

std::string Written() {
  ByteWriter writer;
  writer.Put(uint8_t{200});
  writer.Put(int64_t{-7});
  writer.Put(0.1);
  writer.PutFlag(true);
  writer.PutText(std::string("a\0b", 3));
  writer.PutMatrix(kMatrix);
  writer.PutRaw("end");
  return writer.bytes();
}

void ReadAll(const std::string& bytes) {
  ByteReader reader(bytes, "file");
  EXPECT_EQ(reader.Get<uint8_t>(), 200);
  EXPECT_EQ(reader.Get<int64_t>(), -7);
  EXPECT_EQ(reader.GetFinite(1.0), 0.1);
  EXPECT_TRUE(reader.GetFlag());
  EXPECT_EQ(reader.GetText(), std::string("a\0b", 3));
  EXPECT_EQ(reader.GetMatrix<Eigen::Matrix2d>(10.0), kMatrix);
  EXPECT_EQ(reader.GetRaw(3), "end");
  reader.ExpectEnd();
}

TEST(ByteReader, ReadsBackWhatAWriterHasWritten) { ReadAll(Written()); }

TEST(ByteReader, NoPartOfAFileIsTakenForTheWhole) {
  const std::string bytes = Written();
  for (size_t size = 0; size < bytes.size(); ++size) {
    ExpectInputError([&] { ReadAll(bytes.substr(0, size)); }, {"file"});
  }
  ExpectInputError([&] { ReadAll(bytes + '\0'); }, {"file", "bytes after its end"});
}

TEST(ByteReader, ABrokenCountAsksForNoMemory) {
  ByteWriter writer;
  writer.PutCount(std::numeric_limits<uint32_t>::max());
  writer.PutRaw("12345678");
  ExpectInputError([&] { ByteReader(writer.bytes(), "file").GetCount(4); },
                   {"file", "more elements than bytes"});
  ExpectInputError([&] { ByteReader(writer.bytes(), "file").GetText(); }, {"more elements"});
  ByteWriter two;
  two.PutCount(2);
  two.PutRaw("12345678");
  EXPECT_EQ(ByteReader(two.bytes(), "file").GetCount(4), 2u);
  ExpectInputError([&] { ByteReader(two.bytes(), "file").GetCount(5); }, {"more elements"});
}

TEST(ByteReader, RefusesNumbersThatCannotBe) {
  for (const double number : {2.5, -2.5, std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()}) {
    ByteWriter writer;
    writer.Put(number);
    ExpectInputError([&] { ByteReader(writer.bytes(), "file").GetFinite(2.0); },
                     {"file", "out of range or not finite"});
  }
  ByteWriter flag;
  flag.Put(uint8_t{2});
  ExpectInputError([&] { ByteReader(flag.bytes(), "file").GetFlag(); }, {"neither 0 nor 1"});
}

}  // namespace

}  // namespace hullslam
