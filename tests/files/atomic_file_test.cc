// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <thread>

#include "files/text_rows.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

long CountFiles(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(AtomicFile, WritesAndReplacesCompleteFiles) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "out.txt";
  WriteFileAtomically(path, "first, and longer than the second");
  const std::string second("second\0\n", 8);
  WriteFileAtomically(path, second);
  EXPECT_EQ(ReadFile(path), second);
  EXPECT_EQ(CountFiles(folder.path()), 1);
}

TEST(AtomicFile, AFullDiskLeavesTheOldFile) {
  const TemporaryFolder folder;
  const auto path = folder.Write("out.txt", "good");
  {
    const FileSizeLimit limit(4096);
    ExpectInputError([&] { WriteFileAtomically(path, std::string(100000, 'x')); },
                     {path.string(), "cannot be written", "File too large"});
  }
  EXPECT_EQ(ReadFile(path), "good");
  EXPECT_EQ(CountFiles(folder.path()), 1);
}

TEST(AtomicFile, TwoWritersDoNotDisturbEachOther) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "out.txt";
  const auto write = [&](char letter) {
    for (int i = 0; i < 50; ++i) {
      WriteFileAtomically(path, std::string(10'000, letter));
    }
  };
  std::thread other([&] { write('a'); });  // has the same process id
  write('b');
  other.join();
  const std::string content = ReadFile(path);
  EXPECT_TRUE(content == std::string(10'000, 'a') || content == std::string(10'000, 'b'));
  EXPECT_EQ(CountFiles(folder.path()), 1);
}

TEST(AtomicFile, UnusableFoldersAreReported) {
  const TemporaryFolder folder;
  const auto file = folder.Write("file", "x");
  ExpectInputError([&] { WriteFileAtomically(file / "out.txt", "y"); },
                   {"file/out.txt", "Not a directory"});
  ExpectInputError([&] { WriteFileAtomically(folder.path() / "none" / "out.txt", "y"); },
                   {"none/out.txt", "No such file or directory"});
  EXPECT_EQ(ReadFile(file), "x");
}

TEST(AtomicFile, ALinkStaysAndItsTargetIsWritten) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  folder.Write("below/target", "old");
  fs::create_symlink("below/target", folder.path() / "link");
  fs::create_symlink(folder.path() / "link", folder.path() / "link to link");
  WriteFileAtomically(folder.path() / "link to link", "new");
  EXPECT_EQ(ReadFile(folder.path() / "below" / "target"), "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link to link"));
  fs::create_symlink("below/not yet", folder.path() / "dangling");
  WriteFileAtomically(folder.path() / "dangling", "made");
  EXPECT_EQ(ReadFile(folder.path() / "below" / "not yet"), "made");
  fs::create_symlink("circle", folder.path() / "circle");
  ExpectInputError([&] { WriteFileAtomically(folder.path() / "circle", "y"); },
                   {"circle", "symbolic links"});
}

TEST(AtomicFile, OnlyRegularFilesAreReplaced) {
  const TemporaryFolder folder;
  ExpectInputError([&] { WriteFileAtomically(folder.path(), "y"); }, {"not a regular file"});
  ExpectInputError([&] { WriteFileAtomically("/dev/full", "y"); }, {"not a regular file"});
}

}  // namespace
}  // namespace hullslam
