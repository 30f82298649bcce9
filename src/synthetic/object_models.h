// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "synthetic/scene.h"

namespace hullslam::synthetic {

// COCO's id (from 0, as in the 80 classes of YOLO) of a class that the scenes use; an unknown name
// is a CheckError.
int CocoClassId(std::string_view class_name);

// Puts an object together from parts in any frame with z up. The frame of the finished object is
// at the centre of its tight box, so that its half extents are those of an ellipsoid about it.
class ObjectBuilder {
 public:
  ObjectBuilder(std::string class_name, std::string shape);

  ObjectBuilder& Add(const Shape& shape, const Material& material,
                     const Rigid3& frame_from_part = {});
  // The object standing with the middle of its underside on `base`, turned by `yaw` radians.
  SceneObject Build(const Eigen::Vector3d& base, double yaw) const;

 private:
  std::string class_name_;
  std::string shape_;
  std::vector<Part> parts_;
};

// Shift without rotation, and turns about the axes in radians, as transforms.
Rigid3 Shift(double x, double y, double z);
Rigid3 TurnAboutX(double angle, const Eigen::Vector3d& translation);
Rigid3 TurnAboutZ(double angle, const Eigen::Vector3d& translation);

// Compound objects; all stand on z = 0.
ObjectBuilder MakeMug(const Material& material);
ObjectBuilder MakeBottle(const Material& glass, const Material& label);
ObjectBuilder MakeTeddyBear(double height, const Material& fur, const Material& snout);
ObjectBuilder MakeChair(const Material& frame, const Material& seat);
ObjectBuilder MakeMonitor(const Material& screen, const Material& frame);
ObjectBuilder MakeLaptop(const Material& screen, const Material& keys, const Material& body);
ObjectBuilder MakePottedPlant(double height, const Material& pot, const Material& leaves);
ObjectBuilder MakeCouch(const Material& cushion, const Material& frame);
// A box of the given half extents; objects of one primitive likewise.
ObjectBuilder MakeSolid(const std::string& class_name, const Shape& shape,
                        const Material& material);

}  // namespace hullslam::synthetic
