// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "support/plane_sequence.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

const char* const kCup = "41 0.25 0.25 0.5 0.25 0.5 0.5 0.25 0.5 0.9\n";

// A sequence of four frames, two of which have masks.
class CheckMasks : public ::testing::Test {
 protected:
  CheckMasks() {
    folder_.Write("masks/00.txt", std::string(kCup) + "0 0.6 0.6 0.8 0.6 0.7 0.9 0.8\n");
    folder_.Write("masks/02.txt", std::string(kCup) + "62 0.1 0.1 0.2 0.2 0.3 0.3 0.5\n");
  }

  ProgramResult Run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {sequence_.path(), folder_.path() / "masks"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram("hullslam check-masks", arguments);
  }

  // The number that follows a name at the start of a line.
  static std::string Count(const ProgramResult& result, const std::string& name) {
    const size_t at = result.output.find('\n' + name + ' ');
    if (at == std::string::npos) {
      return "no " + name;
    }
    const size_t number = result.output.find_first_not_of(' ', at + 1 + name.size());
    return result.output.substr(number, result.output.find_first_of(" \n", number) - number);
  }

  TemporaryFolder folder_;
  PlaneSequence sequence_ = PlaneSequence(4);
};

TEST_F(CheckMasks, CountsFramesInstancesAndClasses) {
  const ProgramResult result = Run({"--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_NE(result.output.find("(yolo-seg)"), std::string::npos) << result.output;
  EXPECT_EQ(Count(result, "frames"), "4");
  EXPECT_EQ(Count(result, "without image"), "0");
  EXPECT_EQ(Count(result, "without depth"), "0");
  EXPECT_EQ(Count(result, "without masks"), "2");
  EXPECT_EQ(Count(result, "  without file"), "2");
  EXPECT_EQ(Count(result, "malformed"), "0");
  EXPECT_EQ(Count(result, "instances"), "4");
  EXPECT_EQ(Count(result, "kept"), "3");
  EXPECT_EQ(Count(result, "rejected: no area"), "1");
  EXPECT_EQ(Count(result, "cup"), "2");
  EXPECT_EQ(Count(result, "person"), "1");
}

TEST_F(CheckMasks, ItsColumnsAreAligned) {
  std::string classes;
  for (int i = 0; i <= 62; ++i) {
    classes += i == 41 ? "a cup with a handle and a saucer\n" : "other\n";
  }
  folder_.Write("masks/classes.txt", classes);
  const std::string output = Run({"--quiet"}).output;
  const auto column_of = [&](const std::string& begin, int word) {
    size_t at = output.find('\n' + begin) + 1 + begin.size();
    const size_t line = output.rfind('\n', at);
    for (int i = 0; i < word; ++i) {
      at = output.find_first_of(" \n", output.find_first_not_of(' ', at));
    }
    return at - line;
  };
  EXPECT_EQ(column_of("rejected: few_keypoints", 1), column_of("frames", 1));
  EXPECT_EQ(column_of("rejected: no_silhouette", 1), column_of("frames", 1));
  for (const int number : {1, 2}) {
    EXPECT_EQ(column_of("a cup with a handle and a saucer", number), column_of("class", number));
    EXPECT_EQ(column_of("other", number), column_of("class", number));
  }
}

TEST_F(CheckMasks, ShowsProgress) {
  EXPECT_NE(Run().errors.find("frame 2/4  "), std::string::npos);
}

TEST_F(CheckMasks, AppliesTheSettings) {
  const ProgramResult result = Run({"--set", "objects.detection.min_score=0.85"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(Count(result, "kept"), "2");
  EXPECT_EQ(Count(result, "rejected: low_score"), "1");
  EXPECT_EQ(Count(Run({"--set", "objects.detection.min_keypoints=5"}), "kept"), "3");
}

TEST_F(CheckMasks, DrawsThePicturesAskedFor) {
  const fs::path out = folder_.path() / "pictures";
  const ProgramResult result = Run({"--output", out, "--every", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::set<std::string> names;
  for (const fs::directory_entry& file : fs::directory_iterator(out)) {
    names.insert(file.path().filename());
  }
  EXPECT_EQ(names, (std::set<std::string>{"00.png", "02.png", "pictures.json"}));
  const cv::Mat picture = cv::imread(out / "00.png", cv::IMREAD_COLOR);
  ASSERT_EQ(picture.size(), cv::Size(1280, 960));
  // The cup's left side is at x = 160 and y = 120 to 240 of the image. It is two-sided, so it is
  // green.
  cv::Mat is_green;
  cv::inRange(picture(cv::Rect(316, 230, 10, 260)), cv::Scalar(60, 220, 60),
              cv::Scalar(60, 220, 60), is_green);
  EXPECT_GT(cv::countNonZero(is_green), 50);
}

TEST_F(CheckMasks, ListsAllMalformedFiles) {
  folder_.Write("masks/01.txt", "41 0.1 0.1 0.2 x\n");
  folder_.Write("masks/03.txt", std::string(kCup) + "41 0.1 nan 0.2 0.2 0.3 0.1\n");
  const ProgramResult result = Run();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("01.txt:1: "), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("03.txt:2: y is 'nan'"), std::string::npos) << result.errors;
  EXPECT_EQ(Count(result, "malformed"), "2");
  EXPECT_EQ(Count(result, "kept"), "3");  // in the other files
}

TEST_F(CheckMasks, NeedsNeitherDepthNorImages) {
  fs::remove(sequence_.path() / "depth.txt");
  fs::remove_all(sequence_.path() / "depth");
  fs::remove_all(sequence_.path() / "rgb");
  const fs::path out = folder_.path() / "pictures";
  const ProgramResult result = Run({"--output", out, "--every", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(Count(result, "frames"), "4");
  EXPECT_EQ(Count(result, "without image"), "4");
  EXPECT_EQ(Count(result, "without depth"), "4");
  EXPECT_EQ(Count(result, "kept"), "3");
  EXPECT_EQ(cv::imread(out / "00.png", cv::IMREAD_COLOR).size(), cv::Size(1280, 960));
}

TEST_F(CheckMasks, AcceptsBoxesOfYolo) {
  folder_.Write("boxes/00.txt", "41 0.5 0.5 0.1 0.1\n");
  const ProgramResult result =
      RunProgram("hullslam check-masks", {sequence_.path(), folder_.path() / "boxes"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("(boxes)"), std::string::npos) << result.output;
  EXPECT_EQ(Count(result, "kept"), "1");
}

// Masks of images that a program has turned by their EXIF data fit nothing, and nothing is mapped.
TEST(CheckMasksOfTurnedImages, AreNoticedByAllPrograms) {
  const RenderedDesk rendered(20);
  const fs::path desk = rendered.path();
  const TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(desk / "masks")) {
    std::string turned;
    if (entry.path().filename() == "classes.txt") {
      fs::create_directories(folder.path() / "masks");
      fs::copy(entry.path(), folder.path() / "masks" / "classes.txt");
      continue;
    }
    ForEachRow(entry.path(), [&](const TextRow& row) {
      turned += row.columns[0];
      for (size_t i = 1; i + 1 < row.columns.size(); i += 2) {
        turned += ' ' + std::to_string(1.0 - row.Number(i + 1, "y")) + ' ';
        turned += row.columns[i];
      }
      turned += '\n';
    });
    folder.Write("masks/" + entry.path().filename().string(), turned);
  }
  for (const fs::path& masks : {desk / "masks", folder.path() / "masks"}) {
    const ProgramResult checked = RunProgram("hullslam check-masks", {desk, masks, "--quiet"});
    const ProgramResult mapped = RunProgram(
        "hullslam map-objects", {desk, "--poses", desk / "groundtruth.txt", "--masks", masks,
                                 "--output", folder.path() / "run", "--overwrite", "--quiet"});
    for (const std::string& errors : {checked.errors, mapped.errors}) {
      EXPECT_EQ(errors.find("the EXIF orientation 6") != std::string::npos, masks != desk / "masks")
          << errors;
    }
  }
}

TEST_F(CheckMasks, RefusesBadArguments) {
  const auto refuse = [](const ProgramResult& result, const std::string& part) {
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  };
  refuse(Run({"--format", "yolo"}), "yolo-seg");
  refuse(Run({"--every", "0"}), "--every");
  refuse(Run({"--set", "Camera.fz=1"}), "Camera.fz");
  refuse(Run({"--settings", "none.yaml"}), "none.yaml");
  refuse(Run({"--output", "/proc/none"}), "/proc/none");
  refuse(RunProgram("hullslam check-masks", {sequence_.path()}), "MASKS");
  refuse(RunProgram("hullslam check-masks", {sequence_.path(), folder_.path() / "none"}), "none");
  refuse(RunProgram("hullslam check-masks", {folder_.path() / "none", folder_.path()}), "none");
  folder_.Write("others/1.5.txt", kCup);
  refuse(RunProgram("hullslam check-masks", {sequence_.path(), folder_.path() / "others"}),
         "'1.5.txt'");
}

TEST(CheckMasksData, RealMasksAreAllReadable) {
  const auto data = FindTestData("fr1_xyz");
  if (!data) {
    GTEST_SKIP() << "fr1_xyz is not on this machine; set HULLSLAM_DATA";
  }
  const ProgramResult result =
      RunProgram("hullslam check-masks", {*data, *data / "masks-yolo8n-seg"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::istringstream counts(result.output.substr(result.output.find("malformed")));
  std::string name;
  int malformed = -1;
  counts >> name >> malformed;
  EXPECT_EQ(malformed, 0) << result.output;
}

// ---- The option --masks of the programs that run SLAM

TEST_F(CheckMasks, RunsReportTheFormatAndTheFramesWithoutMasks) {
  folder_.Write("masks/03.txt", "");
  const fs::path out = folder_.path() / "out";
  const std::vector<std::string> arguments = {sequence_.path(), "--output", out, "--masks",
                                              folder_.path() / "masks"};
  const ProgramResult result = RunProgram("rgbd_tum", arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("(yolo-seg), 2 of 4 frames have none, 1 of them because they "
                               "have no file or entry"),
            std::string::npos)
      << result.output;
  EXPECT_NE(ReadFile(out / "summary.json").find("\"frames_without_masks\": 2,"), std::string::npos);
  EXPECT_NE(ReadFile(out / "summary.json").find("\"masks_format\": \"yolo-seg\""),
            std::string::npos);
}

TEST_F(CheckMasks, RunsRefuseBrokenMasksBeforeTheFirstFrame) {
  const fs::path out = folder_.path() / "out";
  const auto refuse = [&](const std::vector<std::string>& more, const std::string& part) {
    std::vector<std::string> arguments = {sequence_.path(), "--output", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("rgbd_tum", arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    EXPECT_FALSE(fs::exists(out));
  };
  const std::string masks = folder_.path() / "masks";
  refuse({"--masks", masks, "--masks-format", "yolo"}, "yolo-seg");
  refuse({"--masks", masks, "--masks-format", "boxes"}, "00.txt:1: 10 column(s)");
  refuse({"--masks", masks + "/none"}, masks + "/none");
  refuse({"--masks-format", "coco"}, "without --masks");
  folder_.Write("masks/03.txt", "41 0.1 0.1 2.0 0.1 0.1 0.2\n");
  refuse({"--masks", masks}, "03.txt:1: x is '2'");
}

}  // namespace
}  // namespace hullslam
