// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/mono_program.h"
#include "support/plane_sequence.h"
#include "support/rendered_desk.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kMonoTumFrames = 16;

class MonoTum : public MonoProgram {
 protected:
  MonoTum() : MonoProgram("mono_tum") {}
};

TEST_F(MonoTum, MakesAMapAndGivesPosesToTheFramesBeforeIt) {
  const RenderedDesk desk(kMonoTumFrames);
  const ProgramResult result = ExpectMap({desk.path()}, kMonoTumFrames);
  ExpectParts(result.output, {"16 frames: 16 tracked, 0 lost, 0 skipped; first map after 0.",
                              "sim3 alignment, 16 pairs of poses, coverage 100.0 %"});
  ExpectParts(result.errors, {"initialising: too little parallax"});
  EXPECT_LE(Ate(), 0.005);
  // Each frame before the first map has a reason.
  const Json initialisation = Summary()["initialisation"];
  double failures = 0.0;
  for (const auto& [reason, count] : initialisation["failures"].items()) {
    failures += count.get<double>();
  }
  EXPECT_GT(failures, 0.0);
  EXPECT_NEAR(initialisation["seconds"].get<double>(), failures / 30.0, 1e-4);
  ExpectMap({desk.path(), "--threaded"}, kMonoTumFrames);
  EXPECT_LE(Ate(), 0.005);
}

TEST_F(MonoTum, RunsGiveTheSameBytesAlsoWithTheThreeArgumentsOfOrbSlam2) {
  const RenderedDesk desk(kMonoTumFrames);
  const Arguments three = {"none", desk.settings(), desk.path(), "--quiet"};
  ExpectMap(three, kMonoTumFrames);
  const std::string poses = ReadFile(output_ / "trajectory.txt");
  const std::string keyframes = ReadFile(output_ / "keyframes.txt");
  const std::string map = ReadFile(output_ / "map.ply");
  for (const Arguments& again : {three, {desk.path(), "--vocabulary", "none", "--quiet"}}) {
    const ProgramResult result = ExpectMap(again, kMonoTumFrames);
    EXPECT_EQ(result.output + result.errors, "");
    EXPECT_TRUE(ReadFile(output_ / "trajectory.txt") == poses);
    EXPECT_TRUE(ReadFile(output_ / "keyframes.txt") == keyframes);
    EXPECT_TRUE(ReadFile(output_ / "map.ply") == map);
  }
}

// The longest side of the keyboard of desk is 0.42 m. All views are from nearly the same side here,
// so it is measured less precisely than in a longer run.
TEST_F(MonoTum, ObjectsOfKnownSizeGiveTheScale) {
  const RenderedDesk desk(40);
  const Arguments arguments = {desk.path(), "--masks", desk.path() / "masks"};
  ExpectMap(arguments, 40);
  EXPECT_TRUE(Summary()["map"]["known_sizes"].is_null());
  const double unit = Summary()["trajectory"]["scale"];
  EXPECT_GT(std::abs(unit - 1.0), 0.2);

  Arguments with_size = arguments;
  with_size.insert(with_size.end(), {"--set", "objects.sizes=keyboard:0.42"});
  const ProgramResult sized = ExpectMap(with_size, 40);
  EXPECT_EQ(Summary()["map"]["known_sizes"], 1);
  EXPECT_NEAR(Summary()["trajectory"]["scale"].get<double>(), 1.0, 0.1);
  ExpectParts(sized.output, {"the unit of length is the metre (objects of known size: 1)"});

  Arguments unknown = arguments;
  unknown.insert(unknown.end(), {"--set", "objects.sizes=giraffe:5"});
  const ProgramResult unsized = ExpectMap(unknown, 40);
  EXPECT_EQ(Summary()["map"]["known_sizes"], 0);
  EXPECT_EQ(Summary()["trajectory"]["scale"], unit);
  ExpectParts(unsized.output, {"the unit of length is unknown"});
  ExpectParts(unsized.errors, {"warning: objects.sizes has 'giraffe', but no mask has this class"});
}

TEST_F(MonoTum, HasNoDepthAndNoAssociations) {
  const PlaneSequence sequence(2);
  const std::string path = sequence.path();
  const std::string pairs = path + "/associations.txt";
  ExpectRefusal({path, "--associations", pairs}, {"--associations"});
  ExpectRefusal({"none", path + "/camera.yaml", path, pairs},
                {"4 positional arguments", "VOCABULARY SETTINGS SEQUENCE (see --help)"});
  ExpectRefusal({path, path}, {"2 positional arguments"});
  ExpectRefusal({path + "/none"}, {path + "/none"});
  fs::remove_all(sequence.path() / "depth");
  fs::remove(sequence.path() / "depth.txt");
  fs::remove(sequence.path() / "groundtruth.txt");
  ExpectNoMap({path}, 2, "too little parallax");
}

TEST_F(MonoTum, ACameraThatStandsStillMakesNoMap) {
  const PlaneSequence sequence(1);
  std::ofstream list(sequence.path() / "rgb.txt");
  for (int i = 0; i < 30; ++i) {
    list << fmt::format("{:.6f} rgb/00.png\n", sequence.Stamp(i));
  }
  list.close();
  ExpectNoMap({sequence.path()}, 30, "too little parallax");
}

TEST_F(MonoTum, AFewFramesMakeNoMap) {
  const PlaneSequence sequence(10, 1.0 / 30.0, 1);
  ExpectNoMap({sequence.path()}, 10, "too little parallax");
}

TEST_F(MonoTum, ImagesOfAnotherSizeAreRefused) {
  const PlaneSequence sequence(2);
  ExpectRefusal({sequence.path(), "--set", "Camera.width=320"},
                {"rgb/00.png", "640x480", "320x480", "Camera.width"});
}

// If rgb.txt lists depth images, they must be refused, because they would give a meaningless map.
TEST_F(MonoTum, DepthImagesAreNoImages) {
  const PlaneSequence sequence(2);
  fs::copy_file(sequence.path() / "depth.txt", sequence.path() / "rgb.txt",
                fs::copy_options::overwrite_existing);
  ExpectRefusal({sequence.path()}, {"depth/00.png: has 16 bits per channel", "8 bits"});
}

}  // namespace
}  // namespace hullslam
