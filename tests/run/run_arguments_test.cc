// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/run_arguments.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/map_files/vocabulary_file.h"
#include "support/expect_error.h"
#include "support/made_vocabulary.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class FinishArgumentsTest : public testing::Test {
 protected:
  FinishArgumentsTest() {
    WriteVocabulary(vocabulary_, MadeVocabulary(), VocabularyForm::kText);
    std::filesystem::create_directory(sequence_);
  }

  static void Refuse(const std::vector<std::string>& positional, const std::string& part) {
    RunArguments arguments;
    ExpectInputError([&] { FinishArguments(positional, arguments); },
                     {part, "; the order is VOCABULARY SETTINGS SEQUENCE ASSOCIATIONS"});
  }

  TemporaryFolder folder_;
  std::string vocabulary_ = (folder_.path() / "ORBvoc.txt").string();
  std::string settings_ = folder_.Write("camera.yaml", "%YAML:1.0\n").string();
  std::string sequence_ = (folder_.path() / "desk").string();
  std::string pairs_ = folder_.Write("pairs.txt", "").string();
};

TEST_F(FinishArgumentsTest, TheOrderOfOrbSlam2IsAccepted) {
  for (const std::string& vocabulary : {vocabulary_, std::string("none")}) {
    RunArguments arguments;
    FinishArguments({vocabulary, settings_, sequence_, pairs_}, arguments);
    EXPECT_EQ(arguments.vocabulary, vocabulary);
    EXPECT_EQ(arguments.settings, settings_);
    EXPECT_EQ(arguments.sequence, sequence_);
    EXPECT_EQ(arguments.associations, pairs_);
  }
}

TEST_F(FinishArgumentsTest, AnotherOrderIsRefused) {
  Refuse({settings_, vocabulary_, sequence_, pairs_}, vocabulary_ + " is a vocabulary");
  Refuse({sequence_, settings_, vocabulary_, pairs_}, vocabulary_ + " is a vocabulary");
  Refuse({vocabulary_, sequence_, settings_, pairs_}, sequence_ + " is a folder");
  Refuse({vocabulary_, settings_, pairs_, sequence_}, sequence_ + " is a folder");
  Refuse({vocabulary_, pairs_, sequence_, settings_}, settings_ + " is a settings file");
  Refuse({pairs_, settings_, sequence_, vocabulary_}, vocabulary_ + " is a vocabulary");
  Refuse({settings_, "none", sequence_, pairs_}, settings_ + " is a settings file");
  Refuse({"none", sequence_, settings_, pairs_}, sequence_ + " is a folder");
}

}  // namespace
}  // namespace hullslam
