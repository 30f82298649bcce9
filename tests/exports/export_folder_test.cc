// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "files/read_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

TEST(ExportPath, MayBeNewOrEmpty) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(CheckExportPath(folder.path() / "new", {}, false));
  EXPECT_NO_THROW(CheckExportPath(folder.path(), {}, false));
}

TEST(ExportPath, WithFilesNeedsForce) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("out/notes.txt", "mine");
  ExpectInputError([&] { CheckExportPath(folder.path() / "out", {}, false); }, {"out", "--force"});
  ExpectInputError([&] { CheckExportPath(file, {}, false); }, {"notes.txt", "--force"});
  EXPECT_NO_THROW(CheckExportPath(folder.path() / "out", {}, true));
  EXPECT_NO_THROW(CheckExportPath(file, {}, true));
}

TEST(ExportPath, IsApartFromTheInputs) {
  const TemporaryFolder folder;
  folder.Write("sequence/rgb/1.png", "");
  const std::vector<fs::path> inputs = {folder.path() / "sequence"};
  ExpectInputError([&] { CheckExportPath(folder.path() / "sequence" / "out", inputs, true); },
                   {"sequence"});
  ExpectInputError([&] { CheckExportPath(folder.path(), inputs, true); }, {"sequence"});
}

TEST(ExportFolder, WithoutCommitLeavesNothing) {
  const TemporaryFolder folder;
  {
    ExportFolder out(folder.path() / "out");
    out.Write({"images/1.png", "1"});
  }
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  folder.Write("kept/notes.txt", "mine");
  {
    ExportFolder out(folder.path() / "kept");
    out.Write({"images/1.png", "1"});
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "kept"), {}), 1);
}

TEST(ExportFolder, ReplacesEntriesOfTheSameNameAsAWhole) {
  const TemporaryFolder folder;
  folder.Write("out/images/old.png", "old");
  folder.Write("out/notes.txt", "mine");
  const fs::path path = folder.path() / "out";
  {
    ExportFolder out(path);
    out.Write({"images/1.png", "1"});
    out.Write({"sparse/0/cameras.bin", "2"});
    out.Commit();
  }
  EXPECT_FALSE(fs::exists(path / "images/old.png"));
  EXPECT_EQ(ReadFile(path / "images/1.png"), "1");
  EXPECT_EQ(ReadFile(path / "sparse/0/cameras.bin"), "2");
  EXPECT_EQ(ReadFile(path / "notes.txt"), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(path), {}), 3) << "no staging folder is left";
}

TEST(ExportFolder, ThatIsAFileIsRefused) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("out", "mine");
  ExpectInputError([&] { ExportFolder out(file); }, {"out", "cannot be written"});
  EXPECT_EQ(ReadFile(file), "mine");
}

// A process was killed when it had moved one of its three entries, and the former folder of
// another.
TEST(ExportFolder, EndsWhatAKilledProcessBegan) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out";
  const std::string staging = "out/.hullslam-killed/";
  folder.Write("out/first.txt", "new");
  folder.Write(staging + "lock", "");
  folder.Write(staging + "former/images/old.png", "old");
  folder.Write(staging + "ready/images/new.png", "new");
  folder.Write(staging + "ready/last.txt", "new");
  folder.Write("out/last.txt", "old");
  { ExportFolder out(path); }  // exports nothing itself
  EXPECT_EQ(ReadFile(path / "first.txt"), "new");
  EXPECT_EQ(ReadFile(path / "last.txt"), "new");
  EXPECT_EQ(ReadFile(path / "images/new.png"), "new");
  EXPECT_FALSE(fs::exists(path / "images/old.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(path), {}), 3) << "no staging folder is left";
}

TEST(ExportFolder, ManyAtOnceLeaveTheFilesOfOne) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out";
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      ExportFolder out(path);
      for (const std::string name : {"a/b.txt", "c/d.txt", "e.txt"}) {
        out.Write({name, std::to_string(i)});
      }
      out.Commit();
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const std::string last = ReadFile(path / "e.txt");
  EXPECT_EQ(ReadFile(path / "a/b.txt"), last);
  EXPECT_EQ(ReadFile(path / "c/d.txt"), last);
  EXPECT_EQ(std::distance(fs::directory_iterator(path), {}), 3);
}

}  // namespace
}  // namespace hullslam
