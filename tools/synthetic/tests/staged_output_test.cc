// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/staged_output.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "files/read_file.h"
#include "hullslam/util/error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"
#include "synthetic/sequence_files.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

class StagedOutput : public ::testing::Test {
 protected:
  // A former output contains a file `mark`.
  FormerOutput Former(bool force) const {
    return {"a thing", [](const fs::path& folder) { return fs::exists(folder / "mark"); }, force};
  }
  bool Write(const std::string& text, bool force = false, bool finish = true) const {
    return WriteStaged(out_, Former(force), [&](const fs::path& folder) {
      WriteNewFile(folder / "mark", text);
      return finish;
    });
  }
  std::string Message(const std::string& text, bool force) const {
    try {
      Write(text, force);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder root_;
  fs::path out_ = root_.path() / "out";
};

TEST_F(StagedOutput, AppearsAsAWholeAlsoInAnEmptyFolder) {
  EXPECT_FALSE(Write("1", false, false));
  EXPECT_TRUE(fs::is_empty(root_.path()));
  fs::create_directory(out_);
  EXPECT_TRUE(Write("1"));
  EXPECT_EQ(ReadFile(out_ / "mark"), "1");
}

TEST_F(StagedOutput, AFormerOneIsReplacedOnlyByForce) {
  Write("1");
  EXPECT_NE(Message("2", false).find("already contains a thing; --force"), std::string::npos);
  EXPECT_EQ(ReadFile(out_ / "mark"), "1");
  EXPECT_TRUE(Write("2", true));
  EXPECT_EQ(ReadFile(out_ / "mark"), "2");
  EXPECT_FALSE(Write("3", true, false));
  EXPECT_EQ(ReadFile(out_ / "mark"), "2");
}

TEST_F(StagedOutput, OtherThingsAreNeverReplaced) {
  fs::create_directory(out_);
  std::ofstream(out_ / "thesis.txt") << "precious";
  EXPECT_NE(Message("1", true).find("is not (only) a thing"), std::string::npos);
  EXPECT_EQ(ReadFile(out_ / "thesis.txt"), "precious");
  fs::remove_all(out_);
  std::ofstream(out_.string()) << "a file";
  EXPECT_NE(Message("1", true).find("is not a folder"), std::string::npos);
}

TEST_F(StagedOutput, OnAFullDiskNothingIsLeft) {
  Write("1");
  {
    const FileSizeLimit limit(100);
    EXPECT_NE(Message(std::string(10000, 'x'), true).find("is the disk full?"), std::string::npos);
  }
  EXPECT_EQ(ReadFile(out_ / "mark"), "1");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace hullslam::synthetic
