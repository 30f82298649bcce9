// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/staged_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <thread>

#include "files/read_file.h"
#include "files/text_rows.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

size_t CountEntries(const fs::path& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder), {}));
}

// Leaves a staging folder with one file behind, like a process that was killed.
fs::path LeaveAbandoned(const fs::path& parent) {
  const pid_t process = ::fork();
  if (process == 0) {
    const StagingFolder staging(parent, ".part-");
    std::ofstream(staging.content() / "file") << "half";
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  return fs::directory_iterator(parent)->path();
}

TEST(StagingFolder, IsUniqueAndRemovedWithItsFiles) {
  const TemporaryFolder folder;
  {
    const StagingFolder a(folder.path(), ".part-");
    const StagingFolder b(folder.path(), ".part-");
    EXPECT_NE(a.path(), b.path()) << "although both belong to the same process";
    std::ofstream(a.content() / "file") << "x";
    fs::create_directories(b.content() / "below");
    EXPECT_TRUE(a.path().filename().string().starts_with(".part-"));
    EXPECT_EQ(CountEntries(folder.path()), 2U);
  }
  EXPECT_EQ(CountEntries(folder.path()), 0U);
}

TEST(StagingFolder, ContentHasOrdinaryPermissions) {
  const TemporaryFolder folder;
  const StagingFolder staging(folder.path(), ".part-");
  fs::create_directory(folder.path() / "ordinary");
  EXPECT_EQ(fs::status(staging.content()).permissions(),
            fs::status(folder.path() / "ordinary").permissions());
}

TEST(StagingFolder, OnlyFoldersOfDeadOwnersAreAbandoned) {
  const TemporaryFolder folder;
  const fs::path dead = LeaveAbandoned(folder.path());
  const StagingFolder alive(folder.path(), ".part-");
  fs::create_directory(folder.path() / "other");
  {
    const std::vector<StagingFolder> abandoned = StagingFolder::Abandoned(folder.path(), ".part-");
    ASSERT_EQ(abandoned.size(), 1U);
    EXPECT_EQ(abandoned[0].path(), dead);
    EXPECT_TRUE(fs::exists(abandoned[0].content() / "file"));
    EXPECT_TRUE(StagingFolder::Abandoned(folder.path(), ".part-").empty())
        << "this test owns it now";
  }
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(alive.content()));
  EXPECT_TRUE(fs::exists(folder.path() / "other"));
}

TEST(StagingFolder, AKeptFolderStays) {
  const TemporaryFolder folder;
  fs::path path;
  {
    StagingFolder staging(folder.path(), ".part-");
    path = staging.path();
    staging.Keep();
  }
  EXPECT_TRUE(fs::exists(path / "content"));
}

TEST(StagingFolder, AMissingParentIsReported) {
  const TemporaryFolder folder;
  EXPECT_THROW(StagingFolder(folder.path() / "none", ".part-"), fs::filesystem_error);
  EXPECT_TRUE(StagingFolder::Abandoned(folder.path() / "none", ".part-").empty());
}

TEST(FolderLock, ASecondLockWaitsForTheFirst) {
  const TemporaryFolder folder;
  std::atomic<bool> is_locked{false};
  std::optional<FolderLock> lock(folder.path());
  std::thread other([&] {
    const FolderLock second(folder.path());
    is_locked = true;
  });
  ::usleep(50'000);  // time in which the other thread would get a lock that does not work
  EXPECT_FALSE(is_locked);
  lock.reset();
  other.join();
  EXPECT_TRUE(is_locked);
}

namespace fs = std::filesystem;

class StagedFileTest : public ::testing::Test {
 protected:
  std::string Content() const { return ReadFile(path_); }
  size_t FilesInFolder() const {
    return static_cast<size_t>(std::distance(fs::recursive_directory_iterator(folder_.path()), {}));
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_.Write("result", "earlier");
};

TEST_F(StagedFileTest, ReplacesTheEarlierFileOnlyAsAWhole) {
  StagedFile file(path_);
  file.Write("first, ");
  EXPECT_EQ(Content(), "earlier");
  file.Write("second");
  EXPECT_EQ(Content(), "earlier");
  file.Commit();
  EXPECT_EQ(Content(), "first, second");
}

TEST_F(StagedFileTest, LeavesNothingBehind) {
  {
    StagedFile file(path_);
    file.Write("half");
  }
  EXPECT_EQ(Content(), "earlier");
  EXPECT_EQ(FilesInFolder(), 1u);
  {
    StagedFile file(path_);
    file.Commit();
  }
  EXPECT_EQ(Content(), "");
  EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(StagedFileTest, AFolderThatIsMissingIsNamed) {
  ExpectInputError([&] { StagedFile(folder_.path() / "none" / "result"); }, {"none"});
}

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
