// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "hullslam/map_files/vocabulary_file.h"
#include "support/run_program.h"
#include "support/running_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

class TrainVocabularyProgram : public ::testing::Test {
 protected:
  // Writes images of random blocks.
  void WriteImages(const std::string& folder, int count) {
    fs::create_directories(folder_.path() / folder);
    for (int i = 0; i < count; ++i) {
      cv::Mat small(30, 40, CV_8UC1);
      cv::RNG(static_cast<uint64_t>(i + 1)).fill(small, cv::RNG::UNIFORM, 0, 256);
      cv::Mat image;
      cv::resize(small, image, {320, 240}, 0, 0, cv::INTER_NEAREST);
      cv::imwrite(Path(folder + '/' + std::to_string(i) + ".png"), image);
    }
  }

  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  ProgramResult Train(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--branching", "5", "--levels", "3", "--features", "300"});
    return RunProgram("hullslam train-vocabulary", arguments);
  }

  void ExpectRefused(const std::vector<std::string>& arguments, const std::string& why) const {
    const ProgramResult result = RunProgram("hullslam train-vocabulary", arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(why), std::string::npos) << result.errors;
    EXPECT_FALSE(fs::exists(Path("v.bow")));
  }

  const TemporaryFolder folder_;
};

TEST_F(TrainVocabularyProgram, TrainsOnFilesAndFolders) {
  WriteImages("a", 4);
  WriteImages("b", 3);
  folder_.Write("a/notes.txt", "no image");
  const ProgramResult result = Train({Path("a"), Path("b/2.png"), "--output", Path("v.bow")});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find(" words, branching 5, 3 levels"), std::string::npos);
  EXPECT_NE(result.errors.find("features in 5 images"), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("level 3 of 3"), std::string::npos) << result.errors;
  const Vocabulary vocabulary = ReadVocabulary(Path("v.bow"));
  EXPECT_GT(vocabulary.word_count(), 100u);
  EXPECT_LE(vocabulary.word_count(), 125u);
}

TEST_F(TrainVocabularyProgram, ThreadsDoNotChangeTheResultButSeedsDo) {
  WriteImages("a", 6);
  const auto train = [&](const std::string& name, const std::string& threads,
                         const std::string& seed) {
    EXPECT_EQ(
        Train({Path("a"), "--output", Path(name), "--quiet", "--threads", threads, "--seed", seed})
            .exit_code,
        0);
    return ReadVocabulary(Path(name)).hash();
  };
  const uint64_t hash = train("1.bow", "1", "7");
  EXPECT_EQ(train("2.bow", "2", "7"), hash);
  EXPECT_EQ(train("text.txt", "2", "7"), hash);
  EXPECT_NE(train("3.bow", "2", "8"), hash);
}

TEST_F(TrainVocabularyProgram, BadInputIsRefused) {
  WriteImages("a", 1);
  fs::create_directory(Path("empty"));
  const std::string out = Path("v.bow");
  ExpectRefused({}, "IMAGES");
  ExpectRefused({Path("a")}, "--output");
  ExpectRefused({Path("none.png"), "--output", out}, "none.png");
  ExpectRefused({Path("empty"), "--output", out}, "has no PNG or JPEG images");
  ExpectRefused({folder_.Write("text.png", "text").string(), "--output", out}, "text.png");
  ExpectRefused({Path("a"), "--output", Path("v.dat")}, "expected .bow or .txt");
  ExpectRefused({Path("a"), "--output", out, "--branching", "1"}, "--branching");
  ExpectRefused({Path("a"), "--output", out, "--levels", "11"}, "--levels");
  ExpectRefused({Path("a"), "--output", out, "--seed", "-1"}, "--seed");
  cv::imwrite(Path("tiny.png"), cv::Mat(20, 20, CV_8UC1, cv::Scalar(9)));
  ExpectRefused({Path("tiny.png"), "--output", out}, "20x20 px, expected at least 64x64");
  cv::imwrite(Path("plain.png"), cv::Mat(200, 200, CV_8UC1, cv::Scalar(9)));
  ExpectRefused({Path("plain.png"), "--output", out}, "no features");
}

TEST_F(TrainVocabularyProgram, AnInterruptWritesNothing) {
  WriteImages("a", 300);
  RunningProgram program("hullslam train-vocabulary",
                         {Path("a"), "--output", Path("v.bow"), "--threads", "1"});
  EXPECT_NE(program.ReadLine().find("/300"), std::string::npos);  // a tenth is done
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait(), 1);
  EXPECT_FALSE(fs::exists(Path("v.bow")));
}

}  // namespace
}  // namespace hullslam
