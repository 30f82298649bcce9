// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/catalogue.h"

#include <array>
#include <numbers>
#include <string>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// A class that is one primitive with a repeating texture.
struct SolidModel {
  std::string_view class_name;
  Shape shape;
  int Palette::*texture;
  double tile;  // metres per repeat
};

const SolidModel* FindSolid(std::string_view class_name) {
  static const std::array<SolidModel, 12> kSolids = {{
      {"mouse", Shape::Ellipsoid({0.032, 0.055, 0.02}), &Palette::speckle, 0.2},
      {"apple", Shape::Ellipsoid({0.038, 0.038, 0.036}), &Palette::fur, 0.15},
      {"orange", Shape::Ellipsoid({0.041, 0.041, 0.04}), &Palette::fur, 0.15},
      {"bowl", Shape::Superquadric({0.1, 0.1, 0.035}, 0.6, 1.0), &Palette::checker, 0.3},
      {"vase", Shape::Superquadric({0.07, 0.07, 0.15}, 0.8, 0.6), &Palette::speckle, 0.25},
      {"sports ball", Shape::Ellipsoid({0.11, 0.11, 0.11}), &Palette::checker, 0.35},
      {"clock", Shape::Ellipsoid({0.17, 0.03, 0.17}), &Palette::checker, 0.34},
      {"suitcase", Shape::Superquadric({0.24, 0.13, 0.33}, 0.3, 0.3), &Palette::fabric, 0.6},
      {"backpack", Shape::Superquadric({0.16, 0.11, 0.23}, 0.5, 0.6), &Palette::fabric, 0.4},
      {"bed", Shape::Superquadric({0.95, 0.5, 0.25}, 0.2, 0.2), &Palette::fabric, 0.9},
      {"refrigerator", Shape::Box({0.3, 0.3, 0.85}), &Palette::speckle, 0.9},
      {"microwave", Shape::Box({0.22, 0.16, 0.14}), &Palette::speckle, 0.5},
  }};
  for (const SolidModel& solid : kSolids) {
    if (solid.class_name == class_name) {
      return &solid;
    }
  }
  return nullptr;
}

// A flat box with a printed side.
ObjectBuilder MakePrinted(std::string_view class_name, const Vector3d& half, int texture,
                          const Vector3f& tint, const SceneBuilder& builder) {
  Material print = builder.Fit(texture, half);
  print.tint = tint;
  return MakeSolid(std::string(class_name), Shape::Box(half), print);
}

ObjectBuilder MakeComputer(std::string_view class_name, const Vector3f& tint,
                           const Palette& palette, SceneBuilder& builder) {
  const Material body = builder.Repeat(palette.speckle, 0.5, tint);
  if (class_name == "tv") {
    return MakeMonitor(builder.Fit(palette.screens.front(), {0.25, 0.004, 0.15}), body);
  }
  return MakeLaptop(builder.Fit(palette.screens.back(), {0.155, 0.002, 0.1}),
                    builder.Fit(palette.keys, {0.15, 0.06, 0.001}), body);
}

// The models of the classes that have several parts with repeating textures.
ObjectBuilder MakeCompound(const Placement& placement, const Palette& palette,
                           SceneBuilder& builder) {
  const std::string_view name = placement.class_name;
  const Vector3f& tint = placement.tint;
  const auto height = [&](double usual) {
    return placement.height > 0.0 ? placement.height : usual;
  };
  if (name == "cup") {
    return MakeMug(builder.Repeat(palette.speckle, 0.22, tint));
  }
  if (name == "bottle") {
    const Material glass = builder.Repeat(palette.speckle, 0.3, tint);
    return MakeBottle(glass, builder.Repeat(palette.pages.back(), 0.18));
  }
  if (name == "teddy bear") {
    const Material fur = builder.Repeat(palette.fur, 0.3, tint);
    return MakeTeddyBear(height(0.36), fur, builder.Repeat(palette.speckle, 0.3));
  }
  if (name == "potted plant") {
    const Material pot = builder.Repeat(palette.speckle, 0.5, tint);
    return MakePottedPlant(height(0.4), pot, builder.Repeat(palette.fur, 0.4, {0.45F, 1.0F, 0.4F}));
  }
  const Material fabric = builder.Repeat(palette.fabric, 0.6, tint);
  if (name == "chair") {
    return MakeChair(builder.Repeat(palette.wood, 0.5), fabric);
  }
  Check(name == "couch", "the catalogue has no class '" + std::string(name) + "'");
  return MakeCouch(fabric, builder.Repeat(palette.fabric, 0.7, {0.7F, 0.8F, 0.8F}));
}

}  // namespace

ObjectBuilder MakeModel(const Placement& placement, const Palette& palette, SceneBuilder& builder) {
  const std::string_view name = placement.class_name;
  const Vector3f& tint = placement.tint;
  if (const SolidModel* solid = FindSolid(name)) {
    return MakeSolid(std::string(name), solid->shape,
                     builder.Repeat(palette.*solid->texture, solid->tile, tint));
  }
  if (name == "tv" || name == "laptop") {
    return MakeComputer(name, tint, palette, builder);
  }
  if (name == "book") {
    const int page = builder.random().Index(static_cast<int>(palette.pages.size()));
    return MakePrinted(name, {0.085, 0.12, 0.014 + 0.004 * (page % 3)},
                       palette.pages[static_cast<size_t>(page)], tint, builder);
  }
  if (name == "keyboard") {
    return MakePrinted(name, {0.21, 0.07, 0.012}, palette.keys, tint, builder);
  }
  if (name == "cell phone") {
    return MakePrinted(name, {0.037, 0.075, 0.005}, palette.screens.back(), tint, builder);
  }
  return MakeCompound(placement, palette, builder);
}

void AddBook(SceneBuilder& builder, const Palette& palette, size_t page, const Vector3f& tint,
             const Vector3d& base, double yaw) {
  const Vector3d half(0.085, 0.12, 0.014 + 0.004 * static_cast<double>(page % 3));
  Material cover = builder.Fit(palette.pages[page % palette.pages.size()], half);
  cover.tint = tint;
  builder.AddObject(MakeSolid("book", Shape::Box(half), cover).Build(base, yaw));
}

void AddObjects(std::span<const Placement> placements, const Palette& palette,
                SceneBuilder& builder) {
  for (const Placement& placement : placements) {
    const double yaw = placement.yaw * std::numbers::pi / 180.0;
    builder.AddObject(MakeModel(placement, palette, builder).Build(placement.base, yaw));
  }
}

}  // namespace hullslam::synthetic
