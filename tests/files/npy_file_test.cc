// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/npy_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/made_npy.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

std::string Bytes(const std::vector<float>& values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

class NpyFileTest : public ::testing::Test {
 protected:
  FloatRows Read(const std::string& bytes) const {
    return ReadNpy(folder_.Write("vectors.npy", bytes));
  }
  void ExpectRefused(const std::string& bytes, std::vector<std::string> parts) const {
    parts.emplace_back("vectors.npy");
    ExpectInputError([&] { Read(bytes); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(NpyFileTest, ReadsRows) {
  const FloatRows rows = Read(NpyHeader("<f4", "(2, 3)") + Bytes({1, 2, 3, 4, 5, 6.5}));
  EXPECT_EQ(rows.rows, 2U);
  EXPECT_EQ(rows.columns, 3U);
  EXPECT_EQ(rows.Row(1)[2], 6.5f);
}

TEST_F(NpyFileTest, ReadsOneRowAndOtherNumbers) {
  const FloatRows row = Read(NpyHeader("<f4", "(2,)") + Bytes({1, -2}));
  EXPECT_EQ(row.rows, 1U);
  EXPECT_EQ(row.values, (std::vector<float>{1, -2}));
  EXPECT_EQ(Read(NpyHeader("<f2", "(1, 2)") + std::string("\x00\x3c\x00\xc0", 4)).values,
            (std::vector<float>{1, -2}));
  std::string wide(8, '\0');
  const double value = -0.25;
  std::memcpy(wide.data(), &value, wide.size());
  EXPECT_EQ(Read(NpyHeader("<f8", "(1, 1)") + wide).values, std::vector<float>{-0.25f});
}

TEST_F(NpyFileTest, ReadsNoRows) {
  EXPECT_EQ(Read(NpyHeader("<f4", "(0, 512)")).rows, 0U);
  EXPECT_EQ(Read(NpyHeader("<f4", "(0,)")).rows, 0U);
}

TEST_F(NpyFileTest, RefusesWhatItCannotRead) {
  const std::string two = Bytes({1, 2});
  ExpectRefused("", {"is no array"});
  ExpectRefused("\x93NUMPY\x01", {"is no array"});
  ExpectRefused("\x93NUMPY\x09" + std::string(9, '\0'), {"unknown version"});
  ExpectRefused(NpyHeader("<f4", "(1, 2)").substr(0, 40), {"cut off"});
  ExpectRefused(NpyHeader("<i4", "(1, 2)") + two, {"'descr'", "'<f4'"});
  ExpectRefused(NpyHeader(">f4", "(1, 2)") + two, {"'descr'"});
  ExpectRefused(NpyHeader("<f4", "(1, 2)", "True") + two, {"'fortran_order'"});
  ExpectRefused(NpyHeader("<f4", "(1, 1, 2)") + two, {"'shape'"});
  ExpectRefused(NpyHeader("<f4", "(-1, 2)") + two, {"'shape'"});
  ExpectRefused(NpyHeader("<f4", "()") + two, {"'shape'"});
  ExpectRefused(NpyHeader("<f4", "(1, 3)") + two, {"its shape"});
  ExpectRefused(NpyHeader("<f4", "(4611686018427387904, 2)") + two, {"its shape"});
  ExpectRefused(NpyHeader("<f4", "(1, 2)") + two + "x", {"its shape"});
  ExpectRefused(NpyHeader("<f4", "(1, 1)") + Bytes({std::numeric_limits<float>::quiet_NaN()}),
                {"not finite"});
}

}  // namespace
}  // namespace hullslam
