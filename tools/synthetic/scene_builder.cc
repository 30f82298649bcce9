// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/scene_builder.h"

#include <numbers>
#include <utility>

#include "synthetic/texture_painter.h"
#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kHalfPi = std::numbers::pi / 2.0;
constexpr double kWallThickness = 0.2;

}  // namespace

int SceneBuilder::AddTexture(const cv::Mat& image) {
  scene_.textures.emplace_back(image);
  return static_cast<int>(scene_.textures.size()) - 1;
}

Palette SceneBuilder::AddRichPalette(uint32_t variant) {
  const auto seed = [&](uint32_t index) {
    return HashSeed(seed_, 1000 * variant + index, "texture");
  };
  Palette palette;
  palette.wall = AddTexture(PaintPlaster(seed(0), 1024, {176, 190, 196}));
  palette.feature_wall = AddTexture(PaintBrick(seed(1), 1024));
  palette.floor = AddTexture(PaintWood(seed(2), 1024, {70, 100, 140}));
  palette.ceiling = AddTexture(PaintPlaster(seed(3), 512, {205, 210, 212}));
  palette.table = AddTexture(PaintWood(seed(4), 1024, {96, 140, 186}));
  palette.wood = AddTexture(PaintWood(seed(5), 512, {60, 88, 120}));
  palette.fabric = AddTexture(PaintFabric(seed(6), 512, {150, 130, 120}));
  palette.fur = AddTexture(PaintSpeckle(seed(7), 512, {72, 110, 160}));
  palette.speckle = AddTexture(PaintSpeckle(seed(8), 512, {170, 170, 170}));
  palette.checker = AddTexture(PaintChecker(seed(9), 512, 8));
  palette.keys = AddTexture(PaintKeys(seed(10), 512));
  for (uint32_t i = 0; i < 8; ++i) {
    palette.posters.push_back(AddTexture(PaintPoster(seed(20 + i), 512)));
  }
  for (uint32_t i = 0; i < 4; ++i) {
    palette.pages.push_back(AddTexture(PaintPage(seed(40 + i), 512)));
  }
  for (uint32_t i = 0; i < 2; ++i) {
    palette.screens.push_back(AddTexture(PaintScreen(seed(50 + i), 512)));
  }
  return palette;
}

Palette SceneBuilder::AddRoomPalette(Palette palette, uint32_t room, const cv::Scalar& wall_bgr) {
  const auto seed = [&](uint32_t index) { return HashSeed(seed_, 100 * room + index, "room"); };
  palette.wall = AddTexture(PaintPlain(seed(0), 512, wall_bgr, 12.0));
  palette.floor = AddTexture(PaintPlain(seed(1), 512, 0.6 * wall_bgr, 12.0));
  for (uint32_t i = 0; i < 6; ++i) {
    palette.posters.push_back(AddTexture(PaintPoster(seed(20 + i), 512)));
  }
  palette.posters.erase(palette.posters.begin(), palette.posters.end() - 6);
  return palette;
}

int SceneBuilder::AddLargeCarpet(const cv::Scalar& bgr) {
  return AddTexture(PaintPlain(HashSeed(seed_, 0, "carpet"), 2048, bgr, 12.0));
}

Palette SceneBuilder::AddBarePalette() {
  const auto plain = [this](uint32_t index, const cv::Scalar& colour) {
    return AddTexture(PaintPlain(HashSeed(seed_, index, "texture"), 256, colour, 2.0));
  };
  Palette palette;
  palette.wall = palette.feature_wall = plain(0, {188, 196, 200});
  palette.floor = plain(1, {120, 128, 134});
  palette.ceiling = plain(2, {212, 214, 214});
  palette.table = plain(3, {150, 170, 190});
  palette.wood = plain(4, {74, 96, 122});
  palette.fabric = plain(5, {120, 100, 96});
  palette.fur = plain(6, {82, 118, 160});
  palette.speckle = palette.checker = plain(7, {190, 190, 190});
  palette.keys = plain(8, {64, 62, 60});
  palette.pages = {plain(9, {170, 176, 182})};
  palette.screens = {plain(10, {70, 60, 52})};
  return palette;
}

Material SceneBuilder::Fit(int texture, const Vector3d& half) const {
  return {.texture = texture, .tile = (2.0 * half).cast<float>(), .offset = half.cast<float>()};
}

Material SceneBuilder::Repeat(int texture, double metres, const Vector3f& tint_bgr) {
  const double x = random_.Uniform(0.0, metres);
  const double y = random_.Uniform(0.0, metres);
  const double z = random_.Uniform(0.0, metres);
  return {.texture = texture,
          .tile = Vector3f::Constant(static_cast<float>(metres)),
          .offset = Vector3d(x, y, z).cast<float>(),
          .tint = tint_bgr};
}

void SceneBuilder::AddBackground(const Shape& shape, const Material& material,
                                 const Rigid3& world_from_part) {
  scene_.background.push_back({shape, material, world_from_part});
}

void SceneBuilder::AddObject(SceneObject object) {
  object.id = static_cast<int>(scene_.objects.size());
  scene_.objects.push_back(std::move(object));
}

Rigid3 SceneBuilder::WorldFromWall(Wall wall) const {
  const bool across = wall == Wall::kBack || wall == Wall::kFront;
  const Rigid3 turn = TurnAboutZ(-kHalfPi * static_cast<double>(wall), Vector3d::Zero());
  return turn * Shift(0.0, across ? room_.half_y : room_.half_x, 0.0);
}

double SceneBuilder::WallHalfLength(Wall wall) const {
  return wall == Wall::kBack || wall == Wall::kFront ? room_.half_x : room_.half_y;
}

void SceneBuilder::AddRoom(const RoomSize& size, const Palette& palette) {
  room_ = size;
  const double t = kWallThickness / 2.0;
  const double h = size.height / 2.0;
  scene_.supports.push_back(
      {.min = {-size.half_x, -size.half_y}, .max = {size.half_x, size.half_y}});
  const Shape slab = Shape::Box({size.half_x + 2.0 * t, size.half_y + 2.0 * t, t});
  AddBackground(slab, Repeat(palette.floor, size.floor_tile), Shift(0.0, 0.0, -t));
  AddBackground(slab, Repeat(palette.ceiling, 2.5), Shift(0.0, 0.0, size.height + t));
  for (const Wall wall : {Wall::kBack, Wall::kRight, Wall::kFront, Wall::kLeft}) {
    const Shape side = Shape::Box({WallHalfLength(wall) + 2.0 * t, t, h + 2.0 * t});
    const int texture = wall == Wall::kRight ? palette.feature_wall : palette.wall;
    AddBackground(side, Repeat(texture, texture == palette.wall ? 3.0 : 1.6),
                  WorldFromWall(wall) * Shift(0.0, t, h));
    const Vector3d skirting(WallHalfLength(wall), 0.01, 0.05);
    AddBackground(Shape::Box(skirting), Repeat(palette.wood, 1.0),
                  WorldFromWall(wall) * Shift(0.0, -0.01, 0.05));
  }
}

void SceneBuilder::AddPanel(Wall wall, double along, double z, double half_width,
                            double half_height, const Material& material) {
  AddBackground(Shape::Box({half_width, 0.008, half_height}), material,
                WorldFromWall(wall) * Shift(along, -0.008, z));
}

void SceneBuilder::AddPosters(const Palette& palette) {
  size_t next = 0;
  for (const Wall wall : {Wall::kBack, Wall::kRight, Wall::kFront, Wall::kLeft}) {
    const double end = WallHalfLength(wall) - 0.2;
    double left = -end + random_.Uniform(0.0, 0.4);
    while (true) {
      const double half_width = random_.Uniform(0.22, 0.42);
      const double half_height = half_width * random_.Uniform(0.8, 1.4);
      if (left + 2.0 * half_width > end) {
        break;
      }
      AddPanel(wall, left + half_width, random_.Uniform(1.35, 1.75), half_width, half_height,
               Fit(palette.posters[next++ % palette.posters.size()],
                   Vector3d(half_width, 0.008, half_height)));
      left += 2.0 * half_width + random_.Uniform(0.15, 0.6);
    }
  }
}

void SceneBuilder::AddShelf(Wall wall, double along, const Palette& palette) {
  AddShelf(WorldFromWall(wall) * Shift(along, -0.16, 0.0), palette);
}

void SceneBuilder::AddShelf(const Rigid3& world_from_shelf, const Palette& palette) {
  const double half_width = 0.5;
  const Material wood = Repeat(palette.wood, 0.7);
  for (const double side : {-half_width, half_width}) {
    AddBackground(Shape::Box({0.015, 0.15, 0.95}), wood, world_from_shelf * Shift(side, 0.0, 0.95));
  }
  for (int board = 0; board < 6; ++board) {
    const double z = 0.05 + 0.36 * board;
    AddBackground(Shape::Box({half_width, 0.15, 0.012}), wood,
                  world_from_shelf * Shift(0.0, 0.0, z));
    double x = -half_width + 0.03;
    while (board < 5 && x < half_width - 0.10) {
      const double half_thick = random_.Uniform(0.012, 0.032);
      const double half_high = random_.Uniform(0.10, 0.15);
      // Drawn in separate statements, because C++ does not specify in which order the arguments of
      // a call are evaluated.
      const double blue = random_.Uniform(0.3, 1.2);
      const double green = random_.Uniform(0.3, 1.2);
      const double red = random_.Uniform(0.3, 1.2);
      const Vector3f tint = Vector3d(red, green, blue).cast<float>();
      AddBackground(
          Shape::Box({half_thick, 0.1, half_high}),
          Repeat(palette.pages[static_cast<size_t>(board) % palette.pages.size()], 0.25, tint),
          world_from_shelf *
              Shift(x + half_thick, random_.Uniform(-0.04, 0.0), z + 0.012 + half_high));
      x += 2.0 * half_thick + 0.002;
    }
  }
}

void SceneBuilder::AddTable(const Vector2d& centre, const Vector2d& half, double height,
                            const Palette& palette) {
  scene_.supports.push_back({.min = centre - half, .max = centre + half, .height = height});
  const Rigid3 world_from_table = Shift(centre.x(), centre.y(), 0.0);
  AddBackground(Shape::Box({half.x(), half.y(), 0.015}), Repeat(palette.table, 1.8),
                world_from_table * Shift(0.0, 0.0, height - 0.015));
  const double leg = 0.5 * (height - 0.03);
  for (const double x : {-half.x() + 0.06, half.x() - 0.06}) {
    for (const double y : {-half.y() + 0.06, half.y() - 0.06}) {
      AddBackground(Shape::Box({0.03, 0.03, leg}), Repeat(palette.wood, 0.6),
                    world_from_table * Shift(x, y, leg));
    }
  }
}

}  // namespace hullslam::synthetic
