// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/made_room.h"
#include "support/mono_program.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kMonoIclFrames = 20;
constexpr double kMonoIclSmall = 0.010;  // m

class MonoIcl : public MonoProgram {
 protected:
  MonoIcl() : MonoProgram("mono_icl") {}
};

// A mirrored path fits with no rotation and no scale. The large error of the wrong axis shows that
// the test can notice this.
TEST_F(MonoIcl, ThePackageWithPngImagesIsTracked) {
  MadeRoom().WriteIclTum(path_, kMonoIclFrames, true);
  const ProgramResult result = ExpectMap({path_}, kMonoIclFrames);
  ExpectParts(result.output, {"y up, mirrored"});
  EXPECT_LE(Ate(), kMonoIclSmall);
  EXPECT_EQ(Summary()["trajectory"]["pairs"], kMonoIclFrames - 1)
      << "the first frame has no true pose";
  EXPECT_EQ(ReadTrajectory(output_ / "groundtruth.txt").size(), kMonoIclFrames - 1U);
  const double right = Ate();
  ExpectMap({path_, "--groundtruth-y", "down"}, kMonoIclFrames);
  EXPECT_GT(Ate(), 2.0 * right);
}

TEST_F(MonoIcl, WrongArgumentsAreRefused) {
  fs::create_directory(path_);
  ExpectRefusal({path_}, {path_, "associations.txt", "No such file"});
  ExpectRefusal({path_ + "/none"}, {path_ + "/none: no such folder"});
  ExpectRefusal({path_, "--associations", "pairs.txt"}, {"--associations"});
  ExpectRefusal({"none", "ICL.yaml", path_, "pairs.txt"}, {"4 positional arguments"});
}

TEST_F(MonoIcl, ACameraThatStandsStillMakesNoMap) {
  MadeRoom().WriteIclTum(path_, 3, false);
  fs::remove(path_ + "/made.gt.freiburg");
  for (const char* const name : {"1.png", "2.png"}) {
    fs::copy_file(path_ + "/rgb/0.png", path_ + "/rgb/" + name,
                  fs::copy_options::overwrite_existing);
  }
  ExpectParts(Run({path_}).output, {"ground truth: none"});
  ExpectNoMap({path_}, 3, "too little parallax");
}

}  // namespace
}  // namespace hullslam
