// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/output_swap.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "hullslam/util/error.h"
#include "support/temporary_folder.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

class OutputSwapTest : public testing::Test {
 protected:
  static void Put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string Get(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void PutFormerSequence(const fs::path& folder) {
    fs::create_directories(folder);
    Put(folder / "groundtruth_objects.json", R"({"generator": "make_synthetic"})");
    Put(folder / "rgb.txt", "old");
  }
  int Entries() const {
    return static_cast<int>(std::distance(fs::directory_iterator(root_), fs::directory_iterator()));
  }

  const TemporaryFolder folder_;
  const fs::path& root_ = folder_.path();
};

TEST_F(OutputSwapTest, TheFolderIsUntouchedBeforeCommit) {
  {
    OutputSwap swap(root_ / "a" / "out", false);
    swap.WriteFile("rgb.txt", "new");
    EXPECT_FALSE(fs::exists(root_ / "a" / "out"));
    swap.Commit();
    EXPECT_EQ(Get(root_ / "a" / "out" / "rgb.txt"), "new");
  }
  EXPECT_EQ(Get(root_ / "a" / "out" / "rgb.txt"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "a"), fs::directory_iterator()), 1);
}

TEST_F(OutputSwapTest, CancellingLeavesNothing) {
  { OutputSwap(root_ / "out", false).WriteFile("rgb.txt", "new"); }
  EXPECT_EQ(Entries(), 0);
}

TEST_F(OutputSwapTest, AnEmptyFolderIsFilledAlsoWithATrailingSlash) {
  fs::create_directory(root_ / "out");
  OutputSwap swap(root_ / "out/", false);
  swap.WriteFile("rgb.txt", "new");
  swap.Commit();
  EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), "new");
}

TEST_F(OutputSwapTest, ForeignFilesAreNeverReplaced) {
  fs::create_directory(root_ / "out");
  Put(root_ / "out" / "thesis.txt", "precious");
  EXPECT_THROW(OutputSwap(root_ / "out", false), InputError);
  EXPECT_THROW(OutputSwap(root_ / "out", true), InputError);
  PutFormerSequence(root_ / "out");  // next to the foreign file
  EXPECT_THROW(OutputSwap(root_ / "out", true), InputError);
  EXPECT_EQ(Get(root_ / "out" / "thesis.txt"), "precious");
}

TEST_F(OutputSwapTest, AFolderWithoutSyntheticGroundTruthIsNotReplaced) {
  fs::create_directory(root_ / "out");
  Put(root_ / "out" / "rgb.txt", "a real sequence");
  EXPECT_THROW(OutputSwap(root_ / "out", true), InputError);
  Put(root_ / "out" / "groundtruth_objects.json", "{broken");
  EXPECT_THROW(OutputSwap(root_ / "out", true), InputError);
  EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), "a real sequence");
}

TEST_F(OutputSwapTest, AnEarlierSequenceIsOnlyReplacedWithForce) {
  PutFormerSequence(root_ / "out");
  EXPECT_THROW(OutputSwap(root_ / "out", false), InputError);
  { OutputSwap(root_ / "out", true).WriteFile("rgb.txt", "given up"); }
  EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), "old");
  OutputSwap swap(root_ / "out", true);
  swap.WriteFile("rgb.txt", "new");
  swap.Commit();
  EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), "new");
  EXPECT_FALSE(fs::exists(root_ / "out" / "groundtruth_objects.json"));
  EXPECT_EQ(Entries(), 1);
}

TEST_F(OutputSwapTest, TwoAtOnceDoNotDisturbEachOther) {
  OutputSwap first(root_ / "out", true);
  OutputSwap second(root_ / "out", true);
  first.WriteFile("groundtruth_objects.json", R"({"generator": "make_synthetic"})");
  second.WriteFile("groundtruth_objects.json", R"({"generator": "make_synthetic"})");
  first.WriteFile("rgb.txt", "first");
  second.WriteFile("rgb.txt", "second");
  first.Commit();
  EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), "first");
  second.Commit();
  EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), "second");
  EXPECT_EQ(Entries(), 1);
}

TEST_F(OutputSwapTest, WhatAKilledProcessLeavesIsCleanedUp) {
  for (const bool is_moving : {false, true}) {
    PutFormerSequence(root_ / "out");
    const pid_t process = ::fork();
    if (process == 0) {
      OutputSwap swap(root_ / "out", true);
      swap.WriteFile("groundtruth_objects.json", R"({"generator": "make_synthetic"})");
      swap.WriteFile("rgb.txt", "new");
      if (is_moving) {  // killed between the two moves of Commit()
        fs::rename(root_ / "out", swap.working_folder().parent_path() / "former");
      }
      ::raise(SIGKILL);
    }
    int status = 0;
    ::waitpid(process, &status, 0);
    EXPECT_EQ(Entries(), is_moving ? 1 : 2);
    { const OutputSwap next(root_ / "out", true); }
    EXPECT_EQ(Get(root_ / "out" / "rgb.txt"), is_moving ? "new" : "old");
    EXPECT_EQ(Entries(), 1);
  }
}

TEST_F(OutputSwapTest, AnExistingFileIsAnError) {
  Put(root_ / "file", "x");
  EXPECT_THROW(OutputSwap(root_ / "file", true), InputError);
  EXPECT_THROW(OutputSwap(root_ / "file" / "below", true), InputError);
  OutputSwap swap(root_ / "out", false);
  EXPECT_THROW(swap.WriteFile("no_such_folder/rgb.txt", "x"), InputError);
}

}  // namespace
}  // namespace hullslam::synthetic
