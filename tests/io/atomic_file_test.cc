// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <iterator>
#include <string>

#include "io/text_rows.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// Simulates a full disk: as long as the object exists, writing more than `bytes` to a file fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : former_handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    ::signal(SIGXFSZ, former_handler_);
  }

 private:
  sighandler_t former_handler_;
  rlimit former_{};
};

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

TEST(AtomicFile, FilesThatBelongTogetherAreAllReplacedOrAllUnchanged) {
  const TemporaryFolder folder;
  const auto first = folder.Write("first.txt", "good");
  const auto second = folder.Write("second.txt", "good too");
  std::array<FileContent, 2> files = {{{first, "new"}, {second, std::string(100000, 'x')}}};
  {
    const FileSizeLimit limit(4096);
    ExpectInputError([&] { WriteFilesAtomically(files); }, {second.string(), "File too large"});
  }
  EXPECT_EQ(ReadFile(first), "good");
  EXPECT_EQ(ReadFile(second), "good too");
  EXPECT_EQ(CountFiles(folder.path()), 2);
  WriteFilesAtomically(files);
  EXPECT_EQ(ReadFile(first), "new");
  EXPECT_EQ(ReadFile(second), files[1].content);
  files[1].path = folder.path();
  ExpectInputError([&] { WriteFilesAtomically(files); }, {"not a regular file"});
  EXPECT_EQ(CountFiles(folder.path()), 2);
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

TEST(AtomicFile, OnlyRegularFilesAreReplaced) {
  const TemporaryFolder folder;
  ExpectInputError([&] { WriteFileAtomically(folder.path(), "y"); }, {"not a regular file"});
  ExpectInputError([&] { WriteFileAtomically("/dev/full", "y"); }, {"not a regular file"});
}

}  // namespace
}  // namespace hullslam
