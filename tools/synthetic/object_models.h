// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "synthetic/scene.h"

namespace hullslam::synthetic {

// The id of a COCO class that the scenes use, counted from 0 as in the 80 classes of YOLO. Throws
// CheckError for an unknown name.
int CocoClassId(std::string_view class_name);

// Assembles an object from parts, in any frame with z up. The frame of the finished object is at
// the centre of its tight box, so that its half extents are also those of an ellipsoid around that
// centre.
class ObjectBuilder {
 public:
  // An empty name: a thing without a class.
  ObjectBuilder(std::string class_name, std::string shape);

  ObjectBuilder& Add(const Shape& shape, const Material& material,
                     const Rigid3& frame_from_part = {});
  // The finished object. The centre of its underside is at `base`, and it is rotated by `yaw`
  // radians about the vertical axis.
  SceneObject Build(const Eigen::Vector3d& base, double yaw) const;

 private:
  std::string class_name_;
  std::string shape_;
  std::vector<Part> parts_;
};

// Transforms: a translation, and rotations about the axes in radians.
Rigid3 Shift(double x, double y, double z);
Rigid3 TurnAboutX(double angle, const Eigen::Vector3d& translation);
Rigid3 TurnAboutZ(double angle, const Eigen::Vector3d& translation);

// Compound objects. All of them stand on z = 0.
ObjectBuilder MakeMug(const Material& material);
ObjectBuilder MakeBottle(const Material& glass, const Material& label);
ObjectBuilder MakeTeddyBear(double height, const Material& fur, const Material& snout);
ObjectBuilder MakeChair(const Material& frame, const Material& seat);
ObjectBuilder MakeMonitor(const Material& screen, const Material& frame);
ObjectBuilder MakeLaptop(const Material& screen, const Material& keys, const Material& body);
ObjectBuilder MakePottedPlant(double height, const Material& pot, const Material& leaves);
ObjectBuilder MakeCouch(const Material& cushion, const Material& frame);
// An object that consists of one primitive.
ObjectBuilder MakeSolid(const std::string& class_name, const Shape& shape,
                        const Material& material);

}  // namespace hullslam::synthetic
