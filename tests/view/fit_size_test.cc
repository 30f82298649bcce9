// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/fit_size.h"

#include <gtest/gtest.h>

#include <string>

#include "support/made_view.h"
#include "view/view_message.h"

namespace hullslam {
namespace {

TEST(ThinToFit, ASmallModelStaysAsItIs) {
  ViewModel model = MadeView(100);
  const std::string before = FormatViewMessage(model);
  ThinToFit(kMostReportBytes, model);
  EXPECT_EQ(FormatViewMessage(model), before);
}

TEST(ThinToFit, ALargeMapIsThinnedAndSaysSo) {
  constexpr size_t kMost = 500'000;
  ViewModel model = MadeView(1000);
  for (int i = 0; i < 100'000; ++i) {
    model.landmarks.positions.emplace_back(0.0f, 0.0f, static_cast<float>(i));
    model.landmarks.colours.push_back({1, 2, 3});
    model.landmarks.created.push_back(100.0);
  }
  ThinToFit(kMost, model);
  EXPECT_LE(FormatViewMessage(model).size(), kMost);
  EXPECT_GT(model.landmarks.positions.size(), 5'000u);
  EXPECT_EQ(model.landmarks.colours.size(), model.landmarks.positions.size());
  EXPECT_EQ(model.landmarks.created.size(), model.landmarks.positions.size());
  EXPECT_EQ(model.trajectory.size(), 1000u);  // smaller parts stay
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_TRUE(model.notes[0].find("of 101000 landmarks") != std::string::npos) << model.notes[0];
}

// A level square of 300 x 300 vertices, one centimetre apart.
PlySurface LevelSurface() {
  constexpr uint32_t kSide = 300;
  PlySurface surface;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    surface.positions.emplace_back(0.01f * static_cast<float>(i % kSide),
                                   0.01f * static_cast<float>(i / kSide), 2.0f);
    surface.colours.push_back({10, 20, 30});
    if (i % kSide > 0 && i >= kSide) {
      surface.triangles.push_back({i, i - 1, i - kSide});
      surface.triangles.push_back({i - 1, i - kSide - 1, i - kSide});
    }
  }
  return surface;
}

double AreaOf(const PlySurface& surface) {
  double area = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    area += 0.5 * (surface.positions[b] - surface.positions[a])
                      .cross(surface.positions[c] - surface.positions[a])
                      .norm();
  }
  return area;
}

TEST(ThinToFit, ALargeSurfaceGetsLargerTriangles) {
  constexpr size_t kMost = 1'000'000;
  ViewModel model = MadeView(3);
  model.surface = LevelSurface();
  const double area = AreaOf(model.surface);
  ThinToFit(kMost, model);
  EXPECT_LE(FormatViewMessage(model).size(), kMost);
  const PlySurface& thinned = model.surface;
  EXPECT_GT(thinned.triangles.size(), 5'000u);
  EXPECT_NEAR(AreaOf(thinned), area, 0.03 * area);  // no holes
  for (const Eigen::Vector3f& position : thinned.positions) {
    EXPECT_EQ(position.z(), 2.0f);
  }
  EXPECT_EQ(thinned.colours.front(), (Colour{10, 20, 30}));
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_NE(model.notes[0].find("of 178802 triangles"), std::string::npos) << model.notes[0];
}

TEST(ThinToFit, ASurfaceWithoutRoomIsLeftOut) {
  ViewModel model;
  model.surface = LevelSurface();
  ThinToFit(0, model);
  EXPECT_TRUE(model.surface.triangles.empty());
  EXPECT_TRUE(model.surface.positions.empty());
}

TEST(ThinToFit, PicturesAndCutoutsAreThinned) {
  constexpr size_t kMost = 300'000;
  ViewModel model = MadeView(3);
  const ViewPicture picture{.timestamp = 100.0,
                            .jpeg = std::string(20'000, 'x'),
                            .width = 1,
                            .height = 1,
                            .outlines = {},
                            .ellipses = {}};
  model.pictures.assign(20, picture);
  model.objects.assign(10, model.objects[0]);
  for (ViewObject& object : model.objects) {
    object.cutouts.assign(3, picture);
  }
  ThinToFit(kMost, model);
  EXPECT_LE(FormatViewMessage(model).size(), kMost);
  EXPECT_EQ(model.objects.size(), 10u);
  EXPECT_FALSE(model.pictures.empty());
  EXPECT_EQ(model.notes.size(), 2u);
}

}  // namespace
}  // namespace hullslam
