// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/output_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/check.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Files = std::map<std::string, std::string>;

// The content of all files of a folder, by name. A folder inside it appears with the content
// "folder".
Files ReadFolder(const fs::path& folder) {
  Files files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename()] = entry.is_directory() ? "folder" : ReadFile(entry.path());
  }
  return files;
}

std::string Index(const std::vector<std::string>& names) {
  return nlohmann::json{{"files", names}}.dump();
}

class OutputFolderTest : public testing::Test {
 protected:
  void Write(OutputFolder& output, const Files& files) const {
    for (const auto& [name, content] : files) {
      output.Write({name, content});
    }
    output.Write({"summary.json", Index(output.names())});
  }

  // Does what a run does: writes the files and the index, and commits them.
  void Run(const Files& files) const {
    OutputFolder output(out_, "summary.json", {});
    Write(output, files);
    output.Commit();
  }

  void Refuse(const std::vector<std::string>& parts,
              const std::vector<fs::path>& inputs = {}) const {
    ExpectInputError([&] { OutputFolder(out_, "summary.json", inputs); }, parts);
  }

  const TemporaryFolder folder_;
  fs::path out_ = folder_.path() / "a" / "out";
};

TEST_F(OutputFolderTest, IsCreatedWithItsParentsAndLeftEmptyByAFailedRun) {
  { const OutputFolder output(out_, "summary.json", {}); }
  EXPECT_TRUE(fs::is_directory(out_));
  EXPECT_TRUE(fs::is_empty(out_));
}

TEST_F(OutputFolderTest, NothingIsChangedBeforeCommit) {
  Run({{"a.txt", "1"}});
  const Files former = ReadFolder(out_);
  {
    OutputFolder output(out_, "summary.json", {});
    Write(output, {{"a.txt", "2"}, {"b.txt", "2"}});
    EXPECT_EQ(ReadFile(out_ / "a.txt"), "1");
    EXPECT_FALSE(fs::exists(out_ / "b.txt"));
  }
  EXPECT_EQ(ReadFolder(out_), former);
}

TEST_F(OutputFolderTest, AFolderNeverMixesTwoRuns) {
  Run({{"a.txt", "1"}, {"objects.json", "1"}});
  fs::copy_file(out_ / "a.txt", out_ / "run.png");  // drawn by plot_run.py
  fs::copy_file(out_ / "a.txt", out_ / "report.html");
  fs::copy_file(out_ / "a.txt", out_ / "mesh.ply");  // made by hullslam mesh
  Run({{"a.txt", "2"}, {"b.txt", "2"}});
  EXPECT_EQ(ReadFolder(out_),
            (Files{{"a.txt", "2"}, {"b.txt", "2"}, {"summary.json", Index({"a.txt", "b.txt"})}}));
}

TEST_F(OutputFolderTest, FilesOfTheUserAreNeverTouched) {
  folder_.Write("a/out/trajectory.txt", "my ground truth");
  Refuse({out_.string(), "'trajectory.txt'", "not from a former run"});
  folder_.Write("a/out/summary.json", "{broken");
  Refuse({out_.string(), "not from a former run"});
  folder_.Write("a/out/summary.json", R"({"title": "thesis"})");
  Refuse({out_.string(), "not from a former run"});
  EXPECT_EQ(ReadFile(out_ / "trajectory.txt"), "my ground truth");
  EXPECT_EQ(ReadFolder(out_).size(), 2U);
}

TEST_F(OutputFolderTest, AUsersFileBesideAFormerRunIsRefused) {
  Run({{"a.txt", "1"}});
  folder_.Write("a/out/thesis.txt", "precious");
  Refuse({"'thesis.txt'"});
}

TEST_F(OutputFolderTest, AnIndexCannotNameFilesOfOtherFolders) {
  const fs::path file = folder_.Write("a/precious.txt", "precious");
  folder_.Write("a/out/summary.json", Index({"../precious.txt", "..", ""}));
  Run({{"a.txt", "1"}});
  EXPECT_EQ(ReadFile(file), "precious");
}

TEST_F(OutputFolderTest, AFormerRunOfAnotherKindIsRefused) {
  Run({{"a.txt", "1"}});
  ExpectInputError([&] { OutputFolder(out_, "pictures.json", {}); }, {out_.string(), "former run"});
}

TEST_F(OutputFolderTest, ARunOfAnotherProgramIsOnlyReplacedOnDemand) {
  const auto open = [&](const std::string& program, bool may_replace) {
    const OutputFolder output(out_, "summary.json", {}, {program, may_replace});
  };
  const std::string index = R"({"files": ["a.txt"], "provenance": {"program": "mono_tum"}})";
  folder_.Write("a/out/summary.json", index);
  folder_.Write("a/out/a.txt", "1");
  ExpectInputError([&] { open("rgbd_tum", false); },
                   {out_.string(), "a run of mono_tum", "this run of rgbd_tum", "--overwrite"});
  EXPECT_EQ(ReadFolder(out_), (Files{{"a.txt", "1"}, {"summary.json", index}}));
  EXPECT_NO_THROW(open("mono_tum", false));
  EXPECT_NO_THROW(open("rgbd_tum", true));
  folder_.Write("a/out/summary.json", R"({"files": ["a.txt"], "provenance": {"seed": 0}})");
  EXPECT_NO_THROW(open("rgbd_tum", false)) << "a version that did not say its program";
}

TEST_F(OutputFolderTest, TheLogOfARunMayLieBesideIt) {
  folder_.Write("a/out/log.txt", "log");
  Run({{"a.txt", "1"}});
  Run({{"b.txt", "2"}});
  EXPECT_EQ(ReadFile(out_ / "log.txt"), "log");
}

TEST_F(OutputFolderTest, InputsAreApart) {
  const fs::path sequence = folder_.path() / "a";
  folder_.Write("a/rgb.txt", "");
  Refuse({out_.string(), "inside", sequence.string()}, {"", sequence});
  out_ = sequence;
  Refuse({"contains", sequence.string()}, {sequence});
  out_ = sequence / "";
  Refuse({"contains", sequence.string()}, {sequence});
  out_ = sequence / "none" / ".." / ".." / "a" / "out";
  Refuse({"inside"}, {sequence / "rgb" / ".."});
  out_ = folder_.path() / "b";
  Run({{"trajectory.txt", "1"}});
  Refuse({"contains", "trajectory.txt", "reads"}, {sequence, out_ / "trajectory.txt"});
  fs::create_directory_symlink(sequence, folder_.path() / "link");
  out_ = folder_.path() / "link" / "out";
  Refuse({"inside"}, {sequence});
  EXPECT_FALSE(fs::exists(sequence / "out")) << "a refused run must not create its output folder";
  out_ = folder_.path() / "a-run";
  EXPECT_NO_THROW(OutputFolder(out_, "summary.json", std::vector<fs::path>{sequence}));
}

TEST_F(OutputFolderTest, AnExistingFileIsReported) {
  const fs::path file = folder_.Write("file", "x");
  for (const fs::path& out : {file, file / "below", fs::path("/proc/none")}) {
    out_ = out;
    Refuse({out.string()});
  }
  EXPECT_EQ(ReadFile(file), "x");
}

TEST_F(OutputFolderTest, AFolderWithTheNameOfAFileIsNoticedAtOnce) {
  fs::create_directories(out_ / "summary.json");
  Refuse({out_.string(), "summary.json"});
  fs::remove(out_ / "summary.json");
  Run({{"a.txt", "1"}});
  fs::remove(out_ / "a.txt");
  fs::create_directory(out_ / "a.txt");
  Refuse({(out_ / "a.txt").string(), "not a regular file"});
}

TEST_F(OutputFolderTest, AFullDiskLeavesTheFormerRun) {
  Run({{"a.txt", "1"}});
  const Files former = ReadFolder(out_);
  {
    const FileSizeLimit limit(4096);
    OutputFolder output(out_, "summary.json", {});
    output.Write({"a.txt", "2"});
    ExpectInputError(
        [&] {
          output.Write({"b.txt", std::string(100'000, 'x')});
        },
        {(out_ / "b.txt").string(), "cannot be written", "File too large"});
  }
  EXPECT_EQ(ReadFolder(out_), former);
}

TEST_F(OutputFolderTest, TheIndexIsNecessary) {
  OutputFolder output(out_, "summary.json", {});
  output.Write({"a.txt", "1"});
  EXPECT_THROW(output.Commit(), CheckError);
  EXPECT_THROW(output.Write({"../a.txt", "1"}), CheckError);
  EXPECT_THROW(OutputFolder(out_, "thesis.json", {}), CheckError);
}

TEST_F(OutputFolderTest, OfTwoRunsAtOnceTheLastOneLeavesItsFiles) {
  OutputFolder first(out_, "summary.json", {});
  OutputFolder second(out_, "summary.json", {});
  Write(first, {{"a.txt", "first"}, {"objects.json", "first"}});
  Write(second, {{"a.txt", "second"}});
  first.Commit();
  EXPECT_EQ(ReadFile(out_ / "objects.json"), "first");
  second.Commit();
  EXPECT_EQ(ReadFolder(out_), (Files{{"a.txt", "second"}, {"summary.json", Index({"a.txt"})}}));
}

TEST_F(OutputFolderTest, ManyRunsAtOnceDoNotMix) {
  constexpr int kRuns = 8;
  std::vector<std::thread> runs;
  for (int run = 0; run < kRuns; ++run) {
    runs.emplace_back([&, run] {
      for (int i = 0; i < 10; ++i) {
        Run({{"a.txt", std::to_string(run)}, {"only" + std::to_string(run), std::to_string(run)}});
      }
    });
  }
  for (std::thread& run : runs) {
    run.join();
  }
  const Files files = ReadFolder(out_);
  EXPECT_EQ(files.size(), 3U);
  EXPECT_TRUE(files.contains("only" + files.at("a.txt")));
}

// Runs `work` in a process that kills itself at its end.
template <typename Work>
void RunAndKill(const Work& work) {
  const pid_t process = ::fork();
  if (process == 0) {
    work();
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(process, &status, 0);
}

TEST_F(OutputFolderTest, WhatAKilledRunLeavesIsRemovedByTheNextRun) {
  Run({{"a.txt", "1"}});
  RunAndKill([&] {
    OutputFolder output(out_, "summary.json", {});
    Write(output, {{"a.txt", "2"}});
    ::raise(SIGKILL);
  });
  EXPECT_EQ(ReadFolder(out_).size(), 3U)
      << "the staging folder of the killed run is the third entry";
  { const OutputFolder next(out_, "summary.json", {}); }
  EXPECT_EQ(ReadFolder(out_), (Files{{"a.txt", "1"}, {"summary.json", Index({"a.txt"})}}));
}

// Makes each state in which a run can be killed while it moves its files to the output folder.
TEST_F(OutputFolderTest, TheNextRunFinishesWhatAKilledRunBegan) {
  const Files expected = {
      {"a.txt", "2"}, {"b.txt", "2"}, {"summary.json", Index({"a.txt", "b.txt"})}};
  for (const std::vector<std::string>& moved :
       {std::vector<std::string>{}, {"a.txt"}, {"a.txt", "b.txt"}}) {
    fs::remove_all(out_);
    Run({{"a.txt", "1"}, {"objects.json", "1"}});
    RunAndKill([&] {
      OutputFolder output(out_, "summary.json", {});
      Write(output, {{"a.txt", "2"}, {"b.txt", "2"}});
      fs::path staging;
      for (const fs::directory_entry& entry : fs::directory_iterator(out_)) {
        staging = entry.is_directory() ? entry.path() : staging;
      }
      fs::rename(staging / "content", staging / "ready");
      if (!moved.empty()) {
        fs::remove(out_ / "objects.json");
        fs::remove(out_ / "summary.json");
      }
      for (const std::string& name : moved) {
        fs::rename(staging / "ready" / name, out_ / name);
      }
      ::raise(SIGKILL);
    });
    { const OutputFolder next(out_, "summary.json", {}); }
    EXPECT_EQ(ReadFolder(out_), expected) << moved.size() << " files had been moved";
  }
}

// A folder from a stranger may have links to files of others in what looks like a staging folder.
TEST_F(OutputFolderTest, LinksInAStagingFolderAreNotFollowed) {
  const Files foreign = {{"a.txt", "1"}, {"summary.json", Index({"a.txt"})}};
  const fs::path elsewhere = folder_.path() / "elsewhere";
  for (const auto& [name, content] : foreign) {
    folder_.Write("elsewhere/" + name, content);
  }
  for (const bool is_folder_linked : {true, false}) {
    folder_.Write("a/out/.hullslam-000000/lock", "");
    const fs::path ready = out_ / ".hullslam-000000" / "ready";
    if (is_folder_linked) {
      fs::create_directory_symlink(elsewhere, ready);
    } else {
      fs::create_directory(ready);
      fs::create_symlink(elsewhere / "a.txt", ready / "a.txt");
      fs::create_symlink(elsewhere / "summary.json", ready / "summary.json");
    }
    { const OutputFolder next(out_, "summary.json", {}); }
    EXPECT_EQ(ReadFolder(elsewhere), foreign);
    EXPECT_TRUE(fs::is_empty(out_));
  }
}

}  // namespace
}  // namespace hullslam
