// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/staging_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>

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

}  // namespace
}  // namespace hullslam
