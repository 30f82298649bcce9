// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "synthetic/hash_noise.h"
#include "synthetic/object_models.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// The textures of a scene, as indices in Scene::textures.
struct Palette {
  int wall = 0;
  int feature_wall = 0;  // for the one wall that differs from the others
  int floor = 0;
  int ceiling = 0;
  int table = 0;
  int wood = 0;
  int fabric = 0;
  int fur = 0;
  int speckle = 0;  // a light texture, meant to be tinted
  int checker = 0;
  int keys = 0;
  std::vector<int> posters;
  std::vector<int> pages;
  std::vector<int> screens;
};

// Half the side lengths of the floor, the height of the room, and the length after which the
// floor's texture repeats, metres.
struct RoomSize {
  double half_x = 3.0;
  double half_y = 3.0;
  double height = 2.7;
  double floor_tile = 2.0;
};

// The walls, clockwise as seen from above: kBack is at +y.
enum class Wall { kBack, kRight, kFront, kLeft };

// Assembles a scene step by step. Random choices are drawn from the seed in the order of the calls.
class SceneBuilder {
 public:
  explicit SceneBuilder(uint64_t seed) : seed_(seed), random_(seed) {}

  // Rich: textures with detail everywhere. Bare: textures with almost no detail.
  // Palettes with another `variant` have other textures of the same kinds.
  Palette AddRichPalette(uint32_t variant = 0);
  Palette AddBarePalette();
  // Changes a palette for one room of several: the room gets painted walls, a carpet and posters of
  // its own. Paint and carpet have little detail. `room` is the number of the room, and `wall_bgr`
  // is the colour of the paint.
  Palette AddRoomPalette(Palette palette, uint32_t room, const cv::Scalar& wall_bgr);
  // A carpet of little detail, for a `floor_tile` of 8 m.
  int AddLargeCarpet(const cv::Scalar& bgr);

  // A material that shows the texture exactly once on each side of a box with these half extents.
  Material Fit(int texture, const Eigen::Vector3d& half) const;
  // A material that repeats the texture every `metres`, with a random offset and a tint.
  Material Repeat(int texture, double metres,
                  const Eigen::Vector3f& tint_bgr = Eigen::Vector3f::Ones());

  void AddRoom(const RoomSize& size, const Palette& palette);
  // Adds a flat picture to a wall. `along` is the distance in metres to the right of the middle of
  // the wall, as seen from inside; `z` is the height of the centre.
  void AddPanel(Wall wall, double along, double z, double half_width, double half_height,
                const Material& material);
  // Adds posters side by side along all walls.
  void AddPosters(const Palette& palette);
  // Adds an open shelf full of books with its back against the wall.
  void AddShelf(Wall wall, double along, const Palette& palette);
  // The same with any pose. The x axis of the shelf is along the wall, and its back is at y = 0.16
  // m.
  void AddShelf(const Rigid3& world_from_shelf, const Palette& palette);
  // Adds a table with its top at z = `height`.
  void AddTable(const Eigen::Vector2d& centre, const Eigen::Vector2d& half, double height,
                const Palette& palette);
  void AddBackground(const Shape& shape, const Material& material, const Rigid3& world_from_part);
  // Adds an object and numbers it.
  void AddObject(SceneObject object);

  RandomStream& random() { return random_; }
  Scene& scene() { return scene_; }
  Scene Finish() { return std::move(scene_); }

 private:
  int AddTexture(const cv::Mat& image);
  // The frame of a wall: x to the right as seen from inside, y out of the room, z up.
  Rigid3 WorldFromWall(Wall wall) const;
  double WallHalfLength(Wall wall) const;

  uint64_t seed_;
  RandomStream random_;
  RoomSize room_;
  Scene scene_;
};

}  // namespace hullslam::synthetic
