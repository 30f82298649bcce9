// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_writer.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>
#include <string>

#include "hullslam/settings/settings.h"
#include "hullslam/util/error.h"
#include "results/true_object_file.h"
#include "support/temporary_folder.h"
#include "synthetic/object_models.h"
#include "synthetic/sequence_layout.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

std::string Read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::map<std::string, std::string> AllFiles(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = Read(entry.path());
    }
  }
  return files;
}

bool GoOn(int) { return true; }

class SequenceWriterTest : public testing::Test {
 protected:
  fs::path Write(const std::string& name, const SequenceOptions& options) const {
    EXPECT_TRUE(WriteSequence(root_ / name, options, GoOn));
    return root_ / name;
  }
  int Entries() const {
    return static_cast<int>(std::distance(fs::directory_iterator(root_), fs::directory_iterator()));
  }

  const TemporaryFolder folder_;
  const fs::path& root_ = folder_.path();
};

TEST_F(SequenceWriterTest, TheSameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  const SequenceOptions options{.frames = 4, .seed = 7, .threads = 1};
  SequenceOptions two = options;
  two.threads = 3;
  SequenceOptions other = options;
  other.seed = 8;
  const auto files = AllFiles(Write("one", options));
  EXPECT_EQ(files.size(), 3U * 4U + 5U);
  EXPECT_EQ(files, AllFiles(Write("two", two)));
  const auto other_files = AllFiles(Write("other", other));
  EXPECT_EQ(files.at("rgb.txt"), other_files.at("rgb.txt"));
  for (const char* name : {"rgb/1000.000000.png", "depth/1000.000000.png", "groundtruth.txt"}) {
    EXPECT_NE(files.at(name), other_files.at(name)) << name;
  }
}

TEST_F(SequenceWriterTest, ImagesHaveTheRightFormats) {
  const fs::path folder = Write("out", {.frames = 2});
  const cv::Mat colour =
      cv::imread((folder / "rgb/1000.033333.png").string(), cv::IMREAD_UNCHANGED);
  const cv::Mat depth =
      cv::imread((folder / "depth/1000.033333.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(colour.type(), CV_8UC3);
  EXPECT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(colour.size(), cv::Size(640, 480));
  EXPECT_EQ(depth.size(), cv::Size(640, 480));
  EXPECT_GT(cv::countNonZero(depth), 640 * 480 * 8 / 10);
  EXPECT_EQ(Read(folder / "rgb.txt"),
            "# timestamp filename\n1000.000000 rgb/1000.000000.png\n"
            "1000.033333 rgb/1000.033333.png\n");
  EXPECT_EQ(Read(folder / "camera.yaml").substr(0, 9), "%YAML:1.0");
}

TEST_F(SequenceWriterTest, AFisheyeHasItsFieldOfViewAndItsSettings) {
  const PinholeCamera camera = SyntheticFisheye(150.0);
  EXPECT_NEAR(camera.Undistort({camera.cx + 320.0, camera.cy}).x() - camera.cx,
              camera.fx * std::tan(75.0 * std::numbers::pi / 180.0), 1e-6);
  const fs::path folder = Write("out", {.frames = 1, .fisheye = 150.0});
  SettingsNotes report;
  const SystemOptions options = ReadSettings(folder / "camera.yaml", {}, report);
  EXPECT_TRUE(options.camera.IsFisheye());
  EXPECT_NEAR(options.camera.fx, camera.fx, 1e-6);
  EXPECT_EQ(options.camera.k4, camera.k4);
  EXPECT_NEAR(options.camera.bf / options.camera.fx, SyntheticCamera().bf / SyntheticCamera().fx,
              1e-6);
}

TEST_F(SequenceWriterTest, ADistortedCameraSeesTheSameAtItsRawPixels) {
  PinholeCamera camera = SyntheticCamera();
  camera.k1 = -0.2;
  camera.p1 = 0.002;
  const fs::path distorted =
      Write("distorted", {.frames = 1, .noise = false, .readout_time = 0.02, .camera = camera});
  const fs::path straight = Write("straight", {.frames = 1, .noise = false});
  SettingsNotes report;
  const SystemOptions options = ReadSettings(distorted / "camera.yaml", {}, report);
  EXPECT_EQ(options.camera.k1, camera.k1);
  EXPECT_EQ(options.camera.p1, camera.p1);
  EXPECT_EQ(options.readout_time, 0.02);
  const cv::Mat raw = cv::imread(distorted / "depth/1000.000000.png", cv::IMREAD_UNCHANGED);
  const cv::Mat plain = cv::imread(straight / "depth/1000.000000.png", cv::IMREAD_UNCHANGED);
  int equal = 0;
  int all = 0;
  for (int y = 60; y < 420; y += 12) {
    for (int x = 80; x < 560; x += 12) {
      const Eigen::Vector2d undistorted = camera.Undistort({x, y});
      const int u = static_cast<int>(std::lround(undistorted.x()));
      const int v = static_cast<int>(std::lround(undistorted.y()));
      equal += std::abs(raw.at<uint16_t>(y, x) - plain.at<uint16_t>(v, u)) < 60 ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(equal, 9 * all / 10) << all;
}

TEST_F(SequenceWriterTest, GroundTruthIsThePathOfTheCamera) {
  const fs::path folder = Write("out", {.frames = 3, .seed = 4});
  const Scene scene = BuildScene(SceneKind::kDesk, 3, 4);
  std::ifstream file(folder / "groundtruth.txt");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line[0], '#');
  for (int i = 0; i < 3; ++i) {
    double stamp = 0.0;
    Rigid3 pose;
    Eigen::Vector3d& t = pose.translation;
    Eigen::Quaterniond& q = pose.rotation;
    file >> stamp >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    ASSERT_TRUE(file);
    EXPECT_NEAR(stamp, SequenceLayout().Stamp(i), 1e-9);
    const Rigid3 error = Inverse(scene.world_from_cam(i / 30.0)) * pose;
    EXPECT_LT(error.translation.norm(), 1e-8);
    EXPECT_LT(LogSo3(error.rotation).norm(), 1e-8);
  }
}

TEST_F(SequenceWriterTest, AThingWithoutAClassHasNoMaskAndItsOwnList) {
  const fs::path folder = Write("out", {.scene = SceneKind::kPushed, .frames = 2});
  const auto truth = nlohmann::json::parse(Read(folder / "groundtruth_objects.json"));
  ASSERT_EQ(truth["unclassed"].size(), 1U);
  EXPECT_EQ(truth["unclassed"][0]["class"], "");
  EXPECT_EQ(truth["unclassed"][0]["poses"].size(), 2U);
  std::ifstream file(folder / "masks/1000.000000.txt");
  for (std::string line; std::getline(file, line);) {
    EXPECT_FALSE(line.starts_with("-1")) << line;
  }
}

TEST_F(SequenceWriterTest, MasksAreValidPolygonsOfListedClasses) {
  const fs::path folder = Write("out", {.scene = SceneKind::kDynamic, .frames = 2});
  const auto truth = nlohmann::json::parse(Read(folder / "groundtruth_objects.json"));
  std::set<int> classes;
  for (const auto& object : truth["objects"]) {
    classes.insert(object["class_id"].get<int>());
    EXPECT_EQ(CocoClassId(object["class"].get<std::string>()), object["class_id"].get<int>());
    EXPECT_EQ(object["world_from_object"].size(), 7U);
    EXPECT_GT(object["half_extents"][2].get<double>(), 0.0);
    EXPECT_EQ(object.contains("poses"), object["dynamic"].get<bool>());
  }
  EXPECT_EQ(truth["objects"].back()["poses"].size(), 2U);
  std::ifstream file(folder / "masks/1000.000000.txt");
  int instances = 0;
  for (std::string line; std::getline(file, line); ++instances) {
    std::istringstream stream(line);
    const std::vector<double> values(std::istream_iterator<double>(stream), {});
    ASSERT_GE(values.size(), 8U);
    ASSERT_EQ(values.size() % 2, 0U);  // class, pairs, confidence
    EXPECT_EQ(classes.count(static_cast<int>(values[0])), 1U);
    EXPECT_EQ(values.back(), 1.0);
    for (size_t i = 1; i + 1 < values.size(); ++i) {
      EXPECT_GE(values[i], 0.0);
      EXPECT_LE(values[i], 1.0);
    }
  }
  EXPECT_GE(instances, 10);
}

TEST_F(SequenceWriterTest, TheTrueObjectsCountTheirMasks) {
  const fs::path folder = Write("out", {.scene = SceneKind::kPushed, .frames = 3, .threads = 2});
  std::map<int, uint32_t> lines;  // by class
  for (const auto& entry : fs::directory_iterator(folder / "masks")) {
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      ++lines[std::stoi(line)];
    }
  }
  const auto truth = nlohmann::json::parse(Read(folder / "groundtruth_objects.json"));
  std::map<int, uint32_t> counted;
  for (const auto& object : truth["objects"]) {
    EXPECT_LE(object["masks"], 3);
    if (object["masks"] > 0) {
      counted[object["class_id"].get<int>()] += object["masks"].get<uint32_t>();
    }
  }
  EXPECT_EQ(counted, lines);
  EXPECT_EQ(truth["unclassed"][0]["masks"], 0);
}

TEST_F(SequenceWriterTest, TheFileOfARearrangedSceneNamesTheChangesOfObjects) {
  const fs::path before = Write("before", {.frames = 1, .seed = 3});
  const fs::path after = Write("after", {.frames = 1, .seed = 3, .rearranged = 1});
  const TrueScene original = ReadTrueScene(before / "groundtruth_objects.json");
  const TrueScene changed = ReadTrueScene(after / "groundtruth_objects.json");
  EXPECT_FALSE(original.is_rearranged);
  ASSERT_TRUE(changed.is_rearranged);
  std::map<uint32_t, TrueObject> former;
  for (const TrueObject& object : original.objects) {
    former[object.id] = object;
  }
  for (const TrueObject& object : changed.gone) {
    EXPECT_EQ(object.label, former.at(object.id).label);
    EXPECT_EQ(object.world_from_object.translation,
              former.at(object.id).world_from_object.translation);
    former.erase(object.id);
  }
  std::map<TrueObjectStatus, int> counts;
  for (const TrueObject& object : changed.objects) {
    ++counts[*object.status];
    EXPECT_EQ(former.contains(object.id), object.status != TrueObjectStatus::kNew);
    if (object.status == TrueObjectStatus::kNew) {
      continue;
    }
    const Rigid3 pose = object.former_world_from_object.value_or(object.world_from_object);
    EXPECT_EQ(pose.translation, former.at(object.id).world_from_object.translation);
    EXPECT_EQ(object.label, former.at(object.id).label);
  }
  EXPECT_EQ(counts[TrueObjectStatus::kMoved], 3);
  EXPECT_EQ(counts[TrueObjectStatus::kNew], 3);
  EXPECT_EQ(changed.gone.size(), 3U);
  EXPECT_NE(Read(before / "groundtruth.txt"), Read(after / "groundtruth.txt"));
  EXPECT_THROW(Write("twins", {.scene = SceneKind::kTwins, .frames = 1, .rearranged = 1}),
               InputError);
  EXPECT_FALSE(fs::exists(root_ / "twins"));
}

// Number of features that ORB of OpenCV finds in the first frame.
int OrbFeatures(const fs::path& folder) {
  const cv::Mat grey = cv::imread((folder / "rgb/1000.000000.png").string(), cv::IMREAD_GRAYSCALE);
  std::vector<cv::KeyPoint> keypoints;
  cv::ORB::create(1000, 1.2F, 8, 19, 0, 2, cv::ORB::HARRIS_SCORE, 31, 20)->detect(grey, keypoints);
  return static_cast<int>(keypoints.size());
}

TEST_F(SequenceWriterTest, DeskHasManyCornersAndLowTextureFew) {
  EXPECT_EQ(OrbFeatures(Write("desk", {.frames = 1})), 1000);
  const int poor = OrbFeatures(Write("low", {.scene = SceneKind::kLowTexture, .frames = 1}));
  EXPECT_GT(poor, 30);
  EXPECT_LT(poor, 150);
}

TEST_F(SequenceWriterTest, CancellingLeavesNothingAndKeepsTheEarlierSequence) {
  const auto give_up = [](int) { return false; };
  EXPECT_FALSE(WriteSequence(root_ / "out", {.frames = 5}, give_up));
  EXPECT_TRUE(fs::is_empty(root_));
  const auto before = AllFiles(Write("out", {.frames = 1}));
  EXPECT_THROW(WriteSequence(root_ / "out", {.frames = 1}, give_up), InputError);
  EXPECT_FALSE(WriteSequence(root_ / "out", {.frames = 5, .force = true}, give_up));
  EXPECT_EQ(AllFiles(root_ / "out"), before);
}

TEST_F(SequenceWriterTest, AnEmptyFolderIsFilledAlsoWithATrailingSlash) {
  fs::create_directory(root_ / "out");
  EXPECT_TRUE(WriteSequence(root_ / "out/", {.frames = 1}, GoOn));
  EXPECT_TRUE(fs::exists(root_ / "out" / "rgb.txt"));
}

TEST_F(SequenceWriterTest, AnEarlierSequenceIsOnlyReplacedWithForce) {
  Write("out", {.frames = 2});
  EXPECT_THROW(WriteSequence(root_ / "out", {.frames = 1}, GoOn), InputError);
  EXPECT_TRUE(WriteSequence(root_ / "out", {.frames = 1, .force = true}, GoOn));
  EXPECT_EQ(AllFiles(root_ / "out").size(), 3U + 5U);
  EXPECT_EQ(Entries(), 1);
}

TEST_F(SequenceWriterTest, ForeignFilesAreNeverReplaced) {
  const fs::path out = Write("out", {.frames = 1});
  std::ofstream(out / "thesis.txt") << "precious";
  EXPECT_THROW(WriteSequence(out, {.frames = 1, .force = true}, GoOn), InputError);
  EXPECT_EQ(Read(out / "thesis.txt"), "precious");
  fs::remove(out / "thesis.txt");
  std::ofstream(out / "groundtruth_objects.json")
      << "{broken";  // the file does not say that make_synthetic wrote it
  EXPECT_THROW(WriteSequence(out, {.frames = 1, .force = true}, GoOn), InputError);
  EXPECT_TRUE(fs::exists(out / "rgb.txt"));
}

TEST_F(SequenceWriterTest, AFileWithTheNameOfTheFolderIsAnError) {
  std::ofstream(root_ / "file") << "x";
  EXPECT_THROW(WriteSequence(root_ / "file", {.frames = 1, .force = true}, GoOn), InputError);
  EXPECT_THROW(WriteSequence(root_ / "file" / "below", {.frames = 1}, GoOn), InputError);
}

TEST_F(SequenceWriterTest, FilesOfAKilledProcessAreRemoved) {
  Write("out", {.frames = 1});
  const pid_t process = ::fork();
  if (process == 0) {
    WriteSequence(root_ / "out", {.frames = 2, .force = true, .threads = 1}, [](int) {
      ::raise(SIGKILL);
      return true;
    });
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(Entries(), 2);
  EXPECT_EQ(AllFiles(root_ / "out").size(), 3U + 5U);
  Write("out", {.frames = 1, .force = true});
  EXPECT_EQ(Entries(), 1);
}

}  // namespace
}  // namespace hullslam::synthetic
