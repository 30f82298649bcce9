// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/object_models.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

Eigen::AlignedBox3d TightBox(const std::vector<Part>& parts) {
  Eigen::AlignedBox3d box;
  for (const Part& part : parts) {
    for (const Vector3d& vertex : Tessellate(part.shape).vertices) {
      box.extend(part.owner_from_part * vertex);
    }
  }
  return box;
}

std::string ShapeName(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::kBox:
      return "box";
    case ShapeKind::kEllipsoid:
      return "ellipsoid";
    case ShapeKind::kSuperquadric:
      return "superquadric";
    case ShapeKind::kCylinder:
      return "cylinder";
    case ShapeKind::kTorus:
    case ShapeKind::kRevolved:
      return "compound";
  }
  throw CheckError("unknown kind of shape");
}

}  // namespace

int CocoClassId(std::string_view class_name) {
  static constexpr std::array<std::pair<std::string_view, int>, 28> kClasses = {{
      {"person", 0},    {"backpack", 24},   {"suitcase", 28},  {"sports ball", 32},
      {"bottle", 39},   {"cup", 41},        {"bowl", 45},      {"apple", 47},
      {"orange", 49},   {"chair", 56},      {"couch", 57},     {"bed", 59},
      {"tv", 62},       {"laptop", 63},     {"mouse", 64},     {"potted plant", 58},
      {"keyboard", 66}, {"cell phone", 67}, {"microwave", 68}, {"refrigerator", 72},
      {"book", 73},     {"clock", 74},      {"vase", 75},      {"teddy bear", 77},
      {"bench", 13},    {"wine glass", 40}, {"banana", 46},    {"donut", 54},
  }};
  for (const auto& [name, id] : kClasses) {
    if (name == class_name) {
      return id;
    }
  }
  throw CheckError("no COCO class '" + std::string(class_name) + "'");
}

ObjectBuilder::ObjectBuilder(std::string class_name, std::string shape)
    : class_name_(std::move(class_name)), shape_(std::move(shape)) {}

ObjectBuilder& ObjectBuilder::Add(const Shape& shape, const Material& material,
                                  const Rigid3& frame_from_part) {
  parts_.push_back({shape, material, frame_from_part});
  return *this;
}

SceneObject ObjectBuilder::Build(const Vector3d& base, double yaw) const {
  Check(!parts_.empty(), "an object needs at least one part");
  const Eigen::AlignedBox3d box = TightBox(parts_);
  SceneObject object;
  object.class_name = class_name_;
  object.class_id = class_name_.empty() ? SceneObject::kNoClass : CocoClassId(class_name_);
  object.shape = shape_;
  object.parts = parts_;
  for (Part& part : object.parts) {
    part.owner_from_part.translation -= box.center();
  }
  object.half_extents = 0.5 * box.sizes();
  object.world_from_object = TurnAboutZ(yaw, base + Vector3d(0.0, 0.0, object.half_extents.z()));
  return object;
}

Rigid3 Shift(double x, double y, double z) {
  return {Eigen::Quaterniond::Identity(), Vector3d(x, y, z)};
}

Rigid3 TurnAboutX(double angle, const Vector3d& translation) {
  return {ExpSo3(Vector3d(angle, 0.0, 0.0)), translation};
}

Rigid3 TurnAboutZ(double angle, const Vector3d& translation) {
  return {ExpSo3(Vector3d(0.0, 0.0, angle)), translation};
}

ObjectBuilder MakeMug(const Material& material) {
  ObjectBuilder mug("cup", "compound");
  mug.Add(Shape::Cylinder(0.042, 0.05), material, Shift(0.0, 0.0, 0.05));
  mug.Add(Shape::Torus(0.028, 0.007), material, Shift(0.05, 0.0, 0.05));
  return mug;
}

ObjectBuilder MakeBottle(const Material& glass, const Material& label) {
  ObjectBuilder bottle("bottle", "compound");
  bottle.Add(Shape::Superquadric({0.037, 0.037, 0.09}, 0.4, 1.0), glass, Shift(0.0, 0.0, 0.09));
  bottle.Add(Shape::Cylinder(0.0385, 0.04), label, Shift(0.0, 0.0, 0.085));
  bottle.Add(Shape::Cylinder(0.015, 0.045), glass, Shift(0.0, 0.0, 0.2));
  return bottle;
}

ObjectBuilder MakeTeddyBear(double height, const Material& fur, const Material& snout) {
  const double s = height / 0.40;
  const auto ball = [&](double r) { return Shape::Ellipsoid(Vector3d::Constant(r * s)); };
  const auto at = [&](double x, double y, double z) { return Shift(x * s, y * s, z * s); };
  ObjectBuilder bear("teddy bear", "compound");
  bear.Add(Shape::Ellipsoid(s * Vector3d(0.095, 0.085, 0.115)), fur, at(0.0, 0.0, 0.115));
  bear.Add(ball(0.08), fur, at(0.0, -0.01, 0.285));
  bear.Add(ball(0.035), snout, at(0.0, -0.075, 0.27));
  for (const double side : {-1.0, 1.0}) {
    bear.Add(ball(0.032), fur, at(0.06 * side, 0.0, 0.368));
    bear.Add(Shape::Ellipsoid(s * Vector3d(0.038, 0.065, 0.038)), fur,
             at(0.105 * side, -0.04, 0.185));
    bear.Add(Shape::Ellipsoid(s * Vector3d(0.045, 0.08, 0.045)), fur,
             at(0.075 * side, -0.085, 0.045));
    bear.Add(ball(0.009), {.texture = snout.texture, .tint = Eigen::Vector3f::Constant(0.08F)},
             at(0.03 * side, -0.077, 0.315));
  }
  return bear;
}

ObjectBuilder MakeChair(const Material& frame, const Material& seat) {
  ObjectBuilder chair("chair", "compound");
  chair.Add(Shape::Box({0.22, 0.22, 0.025}), seat, Shift(0.0, 0.0, 0.45));
  chair.Add(Shape::Box({0.21, 0.015, 0.13}), seat, Shift(0.0, 0.2, 0.77));
  for (const double x : {-0.2, 0.2}) {
    chair.Add(Shape::Box({0.02, 0.02, 0.225}), frame, Shift(x, -0.2, 0.225));
    chair.Add(Shape::Box({0.02, 0.02, 0.45}), frame, Shift(x, 0.2, 0.45));
  }
  return chair;
}

ObjectBuilder MakeMonitor(const Material& screen, const Material& frame) {
  ObjectBuilder monitor("tv", "compound");
  monitor.Add(Shape::Box({0.13, 0.09, 0.01}), frame, Shift(0.0, 0.0, 0.01));
  monitor.Add(Shape::Box({0.03, 0.015, 0.08}), frame, Shift(0.0, 0.03, 0.1));
  monitor.Add(Shape::Box({0.26, 0.02, 0.16}), frame, Shift(0.0, 0.02, 0.27));
  monitor.Add(Shape::Box({0.25, 0.004, 0.15}), screen, Shift(0.0, -0.003, 0.27));
  return monitor;
}

ObjectBuilder MakeLaptop(const Material& screen, const Material& keys, const Material& body) {
  ObjectBuilder laptop("laptop", "compound");
  const double tilt = -0.30;
  const Vector3d lid(0.0, 0.145, 0.12);
  laptop.Add(Shape::Box({0.165, 0.115, 0.008}), body, Shift(0.0, 0.0, 0.008));
  laptop.Add(Shape::Box({0.15, 0.06, 0.001}), keys, Shift(0.0, 0.03, 0.0165));
  laptop.Add(Shape::Box({0.165, 0.005, 0.11}), body, TurnAboutX(tilt, lid));
  laptop.Add(Shape::Box({0.155, 0.002, 0.1}), screen,
             TurnAboutX(tilt, lid + ExpSo3({tilt, 0.0, 0.0}) * Vector3d(0.0, -0.0045, 0.0)));
  return laptop;
}

ObjectBuilder MakePottedPlant(double height, const Material& pot, const Material& leaves) {
  const double s = height / 0.45;
  ObjectBuilder plant("potted plant", "compound");
  plant.Add(Shape::Cylinder(0.08 * s, 0.075 * s), pot, Shift(0.0, 0.0, 0.075 * s));
  plant.Add(Shape::Ellipsoid(s * Vector3d(0.13, 0.12, 0.13)), leaves, Shift(0.0, 0.0, 0.27 * s));
  plant.Add(Shape::Ellipsoid(s * Vector3d(0.08, 0.09, 0.09)), leaves,
            Shift(0.05 * s, -0.04 * s, 0.36 * s));
  plant.Add(Shape::Ellipsoid(s * Vector3d(0.08, 0.08, 0.07)), leaves,
            Shift(-0.09 * s, 0.05 * s, 0.33 * s));
  return plant;
}

ObjectBuilder MakeCouch(const Material& cushion, const Material& frame) {
  ObjectBuilder couch("couch", "compound");
  couch.Add(Shape::Box({0.85, 0.38, 0.12}), frame, Shift(0.0, 0.0, 0.12));
  couch.Add(Shape::Superquadric({0.85, 0.13, 0.32}, 0.25, 0.25), frame, Shift(0.0, 0.3, 0.5));
  for (const double side : {-1.0, 1.0}) {
    couch.Add(Shape::Superquadric({0.37, 0.3, 0.1}, 0.3, 0.3), cushion,
              Shift(0.37 * side, -0.07, 0.32));
    couch.Add(Shape::Superquadric({0.1, 0.38, 0.18}, 0.3, 0.3), frame,
              Shift(0.82 * side, 0.0, 0.4));
  }
  return couch;
}

ObjectBuilder MakeSolid(const std::string& class_name, const Shape& shape,
                        const Material& material) {
  ObjectBuilder solid(class_name, ShapeName(shape.kind));
  solid.Add(shape, material);
  return solid;
}

}  // namespace hullslam::synthetic
