// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_renderer.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.h"
#include "synthetic/scenes.h"
#include "synthetic/tests/image_motion.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

SequencePlan ThreeSmallFrames(DatasetForm form) {
  return {.name = "made",
          .scene = BuildScene(SceneKind::kWall, 3, 1),
          .frames = 3,
          .camera = SmallCamera(),
          .sensor = {},
          .layout = {form}};
}

TEST(RenderSequence, WritesImagesDepthAndMasksOfBothForms) {
  for (const DatasetForm form : {DatasetForm::kTum, DatasetForm::kIcl}) {
    const TemporaryFolder root;
    int calls = 0;
    EXPECT_TRUE(RenderSequence(root.path(), ThreeSmallFrames(form), 2,
                               [&](int done) { return done == ++calls; }));
    EXPECT_EQ(calls, 3);
    const bool is_icl = form == DatasetForm::kIcl;
    const fs::path masks = root.path() / (is_icl ? "tum/masks" : "masks");
    for (const char* const kind : {"rgb", "depth"}) {
      EXPECT_TRUE(fs::exists(root.path() / kind / (is_icl ? "2.png" : "1000.066667.png")));
    }
    EXPECT_TRUE(fs::exists(masks / (is_icl ? "2.txt" : "1000.066667.txt")));
    EXPECT_EQ(fs::exists(root.path() / "associations.txt"), is_icl);
  }
}

TEST(RenderSequence, StopsIfItIsAsked) {
  const TemporaryFolder root;
  EXPECT_FALSE(RenderSequence(root.path(), ThreeSmallFrames(DatasetForm::kTum), 1,
                              [](int) { return false; }));
  EXPECT_FALSE(fs::exists(root.path() / "rgb.txt"));
}

}  // namespace
}  // namespace hullslam::synthetic
