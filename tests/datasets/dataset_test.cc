// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/datasets/dataset.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The left images are red and the others blue.
void WriteImage(const fs::path& file, bool is_red = true) {
  fs::create_directories(file.parent_path());
  cv::imwrite(file.string(),
              cv::Mat(24, 32, CV_8UC3, is_red ? cv::Scalar(0, 0, 255) : cv::Scalar(255, 0, 0)));
}

std::string FirstStem(const ImageSequence& sequence) {
  return sequence.frames.front().image.stem().string();
}

void ExpectRed(const ImageSequence& sequence) {
  const cv::Mat image = sequence.load_colour(sequence.frames.front());
  ASSERT_EQ(image.type(), CV_8UC3);
  EXPECT_EQ(image.size(), cv::Size(32, 24));
  const auto pixel = image.at<cv::Vec3b>(5, 5);
  EXPECT_LT(pixel[0], 40);
  EXPECT_GT(pixel[2], 200);
}

TEST(OpenImages, FoldersAreKnownByWhatIsInThem) {
  const TemporaryFolder folder;
  for (const char* const name :
       {"tum/rgb/1.500000.png", "tum/rgb/1.600000.png", "photos/IMG_2.jpg", "photos/IMG_10.jpg",
        "pairs/left/000001.png", "pairs/left/000002.png", "kitti/image_2/000000.png",
        "lab/rgb_0/7.png"}) {
    WriteImage(folder.path() / name);
  }
  for (const char* const name :
       {"pairs/right/000001.png", "pairs/right/000002.png", "kitti/image_3/000000.png"}) {
    WriteImage(folder.path() / name, false);
  }
  folder.Write("lab/rgb.csv", "");
  folder.Write("kitti/times.txt", "0.0\n");
  folder.Write("kitti/calib.txt",
               "P2: 10 0 16 0 0 10 12 0 0 0 1 0\nP3: 10 0 16 -5 0 10 12 0 0 0 1 0\n");
  for (const auto& [name, stem] :
       std::vector<std::pair<std::string, std::string>>{{"tum", "1.500000"},
                                                        {"photos", "IMG_2"},
                                                        {"pairs", "000001"},
                                                        {"kitti", "000000"},
                                                        {"lab", "7"}}) {
    const ImageSequence sequence = OpenImages(folder.path() / name);
    EXPECT_EQ(FirstStem(sequence), stem);
    ExpectRed(sequence);
  }
  ExpectInputError([&] { OpenImages(folder.path() / "none"); }, {"none"});
}

TEST(OpenImages, OfHalvesSideBySideTheLeftOneIsUsed) {
  const TemporaryFolder folder;
  cv::Mat both(24, 64, CV_8UC3, cv::Scalar(255, 0, 0));
  both.colRange(0, 32).setTo(cv::Scalar(0, 0, 255));
  cv::imwrite((folder.path() / "000001.png").string(), both);
  ExpectRed(OpenImages(folder.path(), {{"side_by_side", "yes"}}));
}

TEST(OpenImages, AFileIsAVideoUnlessItsEndingSaysARecording) {
  const TemporaryFolder folder;
  const fs::path video = folder.path() / "walk.avi";
  cv::VideoWriter writer(video.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10, {32, 24});
  for (int i = 0; i < 3; ++i) {
    writer.write(cv::Mat(24, 32, CV_8UC3, cv::Scalar(0, 0, 255)));
  }
  writer.release();
  const ImageSequence sequence = OpenImages(video);
  EXPECT_EQ(sequence.frames.size(), 3U);
  EXPECT_EQ(FirstStem(sequence), "000000");
  ExpectRed(sequence);
  ExpectInputError([&] { OpenImages(folder.Write("a.bag", "no bag")); }, {"a.bag"});
  ExpectInputError([&] { OpenImages(folder.Write("a.mp4", "no video")); }, {"a.mp4"});
}

TEST(OpenImages, SequencesOfStereoCamerasGiveTheirStoredLeftImages) {
  const auto euroc = FindTestData("zed2_realtime_105");
  if (!euroc) {
    GTEST_SKIP() << "the sequence is not here";
  }
  const ImageSequence sequence = OpenImages(*euroc);
  EXPECT_EQ(sequence.frames.size(), 105U);
  EXPECT_EQ(sequence.load_colour(sequence.frames.front()).size(), cv::Size(672, 376));
}

TEST(Datasets, EachHasANameOfItsOwnAndAProgramForEachSensor) {
  std::set<std::string> names;
  std::set<std::pair<std::string, SensorKind>> programs;
  for (const Dataset& dataset : Datasets()) {
    EXPECT_TRUE(names.insert(dataset.name).second) << dataset.name;
    for (const SensorKind sensor : dataset.sensors) {
      EXPECT_TRUE(programs.insert({dataset.program, sensor}).second) << dataset.name;
      EXPECT_EQ(DatasetOfProgram(dataset.program, sensor).name, dataset.name);
      EXPECT_FALSE(dataset.help(sensor).sequence.empty());
      EXPECT_NE(dataset.open, nullptr);
    }
  }
  EXPECT_EQ(programs.size(), 13U);
  ExpectInputError([] { DatasetOfProgram("tum", SensorKind::kStereo); }, {"stereo", "'tum'"});
}

TEST(Datasets, OptionsOfTheSameNameMakeTheSameChoice) {
  std::map<std::string, std::string> keys;
  for (const Dataset& dataset : Datasets()) {
    for (const DatasetOption& option : dataset.options) {
      EXPECT_EQ(keys.try_emplace(option.name, option.key).first->second, option.key);
    }
  }
}

TEST(Datasets, ThePathTellsTheDataSetAndTheSensor) {
  const TemporaryFolder folder;
  for (const char* const name :
       {"tum/rgb.txt", "tum/depth.txt", "grey/rgb.txt", "icl/associations.txt", "icl/rgb/0.png",
        "icl/depth/0.png", "euroc/mav0/cam0/data.csv", "two/mav0/cam0/data.csv",
        "two/mav0/cam1/data.csv", "kitti/image_2/0.png", "drive/image_02/data/0.png",
        "drive/image_03/data/0.png", "tartan/image_left/0.png", "tartan/image_right/0.png",
        "pairs/left/0.png", "pairs/right/0.png", "photos/a.jpg", "walk.mp4"}) {
    folder.Write(name, "");
  }
  const std::vector<std::tuple<std::string, std::string, SensorKind>> cases = {
      {"tum", "tum", SensorKind::kRgbd},
      {"grey", "tum", SensorKind::kMonocular},
      {"icl", "icl", SensorKind::kRgbd},
      {"euroc", "euroc", SensorKind::kMonocular},
      {"two", "euroc_stereo", SensorKind::kStereo},
      {"kitti", "kitti_left", SensorKind::kMonocular},
      {"drive", "kitti", SensorKind::kStereo},
      {"tartan", "stereo_folder", SensorKind::kStereo},
      {"pairs", "stereo_folder", SensorKind::kStereo},
      {"photos", "video", SensorKind::kMonocular},
      {"walk.mp4", "video", SensorKind::kMonocular}};
  for (const auto& [name, dataset, sensor] : cases) {
    const FoundDataset found = FindDataset(folder.path() / name);
    EXPECT_EQ(found.dataset->name, dataset) << name;
    EXPECT_EQ(found.sensor, sensor) << name;
  }
  ExpectInputError([&] { FindDataset(folder.path() / "none"); }, {"none: no such file"});
  EXPECT_NE(FindDataset(folder.path() / "tum").note.find("TUM RGB-D, RGB-D (--mono would do, too)"),
            std::string::npos)
      << FindDataset(folder.path() / "tum").note;
  EXPECT_EQ(FindDataset(folder.path() / "two", SensorKind::kMonocular).dataset->name,
            std::string("euroc"));
  EXPECT_EQ(FindDataset(folder.path() / "walk.mp4", SensorKind::kStereo).dataset->name,
            std::string("stereo_folder"));
}

TEST(OpenDataset, ANumberOfAChoiceIsChecked) {
  const TemporaryFolder folder;
  cv::imwrite((folder.path() / "a.png").string(), cv::Mat(96, 128, CV_8UC1, cv::Scalar(50)));
  const FoundDataset found = FindDataset(folder.path());
  DatasetRequest request{.path = folder.path(),
                         .sensor = found.sensor,
                         .choices = {{"fov", "60"}, {"frames_per_second", "4"}}};
  const OpenedDataset opened = OpenDataset(*found.dataset, request);
  EXPECT_EQ(opened.settings.options.sensor, SensorKind::kMonocular);
  EXPECT_EQ(opened.settings.options.camera.width, 128);
  EXPECT_EQ(opened.sequence.choices.at("frames_per_second"), "4");
  request.choices["fov"] = "wide";
  ExpectInputError([&] { OpenDataset(*found.dataset, request); }, {"fov is 'wide'", "a number"});
}

TEST(Datasets, AChoiceThatTheDataSetDoesNotHaveIsRefused) {
  const TemporaryFolder folder;
  folder.Write("tum/rgb.txt", "");
  folder.Write("walk.mp4", "");
  const auto find = [&](const char* name, const DatasetChoices& choices) {
    return FindDataset(folder.path() / name, std::nullopt, choices);
  };
  ExpectInputError(
      [&] {
        find("tum", {{"fov", "60"}});
      },
      {"--fov is given", "TUM RGB-D", "no such choice"});
  EXPECT_EQ(ProgramOf(*find("walk.mp4", {{"fov", "60"}}).dataset, SensorKind::kMonocular),
            "mono_video");
  EXPECT_EQ(find("walk.mp4", {{"side_by_side", "true"}}).sensor, SensorKind::kStereo);
}

}  // namespace
}  // namespace hullslam
