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
  int feature_wall = 0;  // one wall may differ
  int floor = 0;
  int ceiling = 0;
  int table = 0;
  int wood = 0;
  int fabric = 0;
  int fur = 0;
  int speckle = 0;  // light, to be tinted
  int checker = 0;
  int keys = 0;
  std::vector<int> posters;
  std::vector<int> pages;
  std::vector<int> screens;
};

// Half the floor's sides and the height, metres.
struct RoomSize {
  double half_x = 3.0;
  double half_y = 3.0;
  double height = 2.7;
};

// The walls as seen from inside, clockwise from above: kBack is at +y.
enum class Wall { kBack, kRight, kFront, kLeft };

// Assembles a scene piece by piece; what is left to chance is drawn from the seed in order.
class SceneBuilder {
 public:
  explicit SceneBuilder(uint64_t seed) : seed_(seed), random_(seed) {}

  // Textures with detail everywhere, or all but bare ones.
  Palette AddRichPalette();
  Palette AddBarePalette();

  // The texture once over each side of a box of these half extents.
  Material Fit(int texture, const Eigen::Vector3d& half) const;
  // The texture every `metres`, from a random place on and with a tint.
  Material Repeat(int texture, double metres,
                  const Eigen::Vector3f& tint_bgr = Eigen::Vector3f::Ones());

  void AddRoom(const RoomSize& size, const Palette& palette);
  // A flat picture on a wall; `along` is metres to the right of the wall's middle as seen from
  // inside, `z` the height of its centre.
  void AddPanel(Wall wall, double along, double z, double half_width, double half_height,
                const Material& material);
  // Posters side by side along all walls.
  void AddPosters(const Palette& palette);
  // An open shelf full of books, its back against the wall.
  void AddShelf(Wall wall, double along, const Palette& palette);
  // A table with its top at z = `height`.
  void AddTable(const Eigen::Vector2d& centre, const Eigen::Vector2d& half, double height,
                const Palette& palette);
  void AddBackground(const Shape& shape, const Material& material, const Rigid3& world_from_part);
  void AddObject(SceneObject object) { scene_.objects.push_back(std::move(object)); }

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
