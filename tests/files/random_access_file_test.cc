// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/random_access_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(RandomAccessFileTest, ReadsAnyPartOfTheFile) {
  const TemporaryFolder folder;
  const RandomAccessFile file(folder.Write("a", std::string("01\0003456789", 10)));
  EXPECT_EQ(file.size(), 10u);
  EXPECT_EQ(file.Read(7, 2), "78");
  EXPECT_EQ(file.Read(1, 3), std::string("1\0003", 3));
  EXPECT_EQ(file.Read(8, 100), "89");
  EXPECT_EQ(file.Read(10, 1), "");
  EXPECT_EQ(file.Read(uint64_t{1} << 63U, 1), "");
}

TEST(RandomAccessFileTest, OtherThingsThanFilesAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { RandomAccessFile(folder.path() / "none"); }, {"none: No such file"});
  ExpectInputError([&] { RandomAccessFile{folder.path()}; }, {"not a regular file"});
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ExpectInputError([&] { RandomAccessFile{pipe}; }, {"pipe: is not a regular file"});
}

}  // namespace
}  // namespace hullslam
