// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/map_files/vocabulary_file.h"
#include "support/made_vocabulary.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class ConvertVocabulary : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  void ExpectRefused(const std::vector<std::string>& arguments, const std::string& why) const {
    const ProgramResult result = RunProgram("hullslam convert-vocabulary", arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(why), std::string::npos) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(Path("out.txt")));
  }

  const TemporaryFolder folder_;
  const Vocabulary vocabulary_ = MadeVocabulary();
};

TEST_F(ConvertVocabulary, ThereAndBackGivesTheSameBytes) {
  const std::string binary = folder_.Write("a.bow", BytesOf(vocabulary_)).string();
  const ProgramResult to_text = RunProgram("hullslam convert-vocabulary", {binary, Path("b.txt")});
  ASSERT_EQ(to_text.exit_code, 0) << to_text.errors;
  EXPECT_NE(to_text.output.find("64 words, branching 4, 3 levels, hash "), std::string::npos);
  const ProgramResult back = RunProgram("hullslam convert-vocabulary",
                                        {Path("b.txt"), Path("c"), "--form", "binary", "--quiet"});
  ASSERT_EQ(back.exit_code, 0) << back.errors;
  EXPECT_EQ(back.output + back.errors, "");
  EXPECT_EQ(RunShell("cmp '" + binary + "' '" + Path("c") + "'"), 0);
  EXPECT_EQ(RunShell("head -n 1 '" + Path("b.txt") + "' | grep -qx '4 3 0 0'"), 0);
}

TEST_F(ConvertVocabulary, BadInputIsRefused) {
  const std::string binary = folder_.Write("a.bow", BytesOf(vocabulary_)).string();
  const std::string out = Path("out.txt");
  ExpectRefused({binary}, "OUT");
  ExpectRefused({binary, Path("out.dat")}, "expected .bow or .txt");
  ExpectRefused({binary, out, "--form", "xml"}, "--form");
  ExpectRefused({binary, Path("none/out.txt")}, "cannot be written");
  ExpectRefused({Path("none.bow"), out}, "none.bow: No such file");
  ExpectRefused({folder_.Write("empty", "").string(), out}, "is empty");
  ExpectRefused({folder_.Write("cut.bow", BytesOf(vocabulary_).substr(0, 500)).string(), out},
                "cut off");
  ExpectRefused({folder_.Write("line.txt", "10 6 0 0\n0 1 7\n").string(), out}, "line.txt:2: ");
  ExpectRefused({folder_.Write("scoring.txt", "10 6 3 0\n").string(), out}, "scoring 3");
}

}  // namespace
}  // namespace hullslam
