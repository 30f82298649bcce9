// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_lens.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class YamlLens : public ::testing::Test {
 protected:
  PinholeCamera Read(const std::string& text) {
    folder_.Write("lens.yaml", text);
    PinholeCamera camera;
    ReadLens(YamlMap(folder_.path() / "lens.yaml", "a lens"), "model", "numbers", camera);
    return camera;
  }

  TemporaryFolder folder_;
};

TEST_F(YamlLens, IsReadByItsName) {
  const PinholeCamera camera = Read("model: equidistant\nnumbers: [0.1, 0.2, 0.3, 0.4]\n");
  EXPECT_TRUE(camera.IsFisheye());
  EXPECT_EQ(camera.k4, 0.4);
}

TEST_F(YamlLens, FaultsNameTheLineAndWhatWasExpected) {
  ExpectInputError([&] { Read("model: omni\nnumbers: [0.1, 0.2, 0.3, 0.4]\n"); },
                   {"lens.yaml:1: model is 'omni' and numbers has 4 number(s)", "expected plumb"});
  ExpectInputError([&] { Read("model: equidistant\nnumbers: [0.1]\n"); },
                   {"lens.yaml:1: model", "1 number(s), expected 4 coefficients"});
  ExpectInputError([&] { Read("model: radtan\nnumbers: 0.1\n"); },
                   {"lens.yaml:2: numbers is not a list of numbers"});
  ExpectInputError([&] { Read("model: radtan\nnumbers: [0.1, x]\n"); }, {"lens.yaml:2: numbers"});
  ExpectInputError([&] { Read("model: radtan\n"); }, {"numbers is not given"});
  ExpectInputError([&] { Read("numbers: [0.1]\n"); }, {"model is not given"});
}

}  // namespace
}  // namespace hullslam
