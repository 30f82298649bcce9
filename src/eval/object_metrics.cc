// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/object_metrics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "frame/detection/visible_part.h"
#include "geometry/polygon.h"

namespace hullslam {

// The polygon is a fan of triangles. With unit rays a, b and c to its corners, a triangle has the
// solid angle 2 atan2(a . (b x c), 1 + a . b + b . c + c . a) (Van Oosterom and Strackee 1983).
double SolidAngle(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon) {
  double sum = 0.0;
  const auto ray = [&](size_t i) -> Eigen::Vector3d {
    return camera.Unproject(polygon[i], 1.0).normalized();
  };
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Eigen::Vector3d a = ray(0);
    const Eigen::Vector3d b = ray(i);
    const Eigen::Vector3d c = ray(i + 1);
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return sum;
}

double OverlapOnSphere(const PinholeCamera& camera, std::span<const Eigen::Vector2d> polygon,
                       std::span<const Eigen::Vector2d> convex) {
  std::vector<Eigen::Vector2d> shared;
  if (convex.size() >= 3) {
    shared.assign(polygon.begin(), polygon.end());
  }
  for (size_t i = 0; i < convex.size(); ++i) {
    const Eigen::Vector2d side = convex[(i + 1) % convex.size()] - convex[i];
    const Eigen::Vector2d outwards(side.y(), -side.x());
    shared = ClipToHalfPlane(shared, outwards, outwards.dot(convex[i]));
  }
  const double both = SolidAngle(camera, shared);
  const double either = SolidAngle(camera, polygon) + SolidAngle(camera, convex) - both;
  return either > 0.0 ? both / either : 0.0;
}

namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr int kEllipseCorners = 128;

// Running mean of the values passed to Add().
class Mean {
 public:
  void Add(const std::optional<double>& value) {
    if (value) {
      sum_ += *value;
      ++count_;
    }
  }
  std::optional<double> Value() const {
    return count_ > 0 ? std::optional(sum_ / static_cast<double>(count_)) : std::nullopt;
  }

 private:
  double sum_ = 0.0;
  size_t count_ = 0;
};

// Running means of fits and sums of their counts.
class FitMean {
 public:
  void Add(const ObjectFit& fit) {
    siou_.Add(fit.siou);
    siou_mask_.Add(fit.siou_mask);
    mtd_.Add(fit.mtd_m2);
    tangent_.Add(fit.tangent_px);
    observations_ += fit.observations;
    lines_ += fit.lines;
  }
  ObjectFit Value() const {
    return {siou_.Value(),    siou_mask_.Value(), mtd_.Value(),
            tangent_.Value(), observations_,      lines_};
  }

 private:
  Mean siou_;
  Mean siou_mask_;
  Mean mtd_;
  Mean tangent_;
  size_t observations_ = 0;
  size_t lines_ = 0;
};

// The parameters of a camera that the projection depends on.
struct ImagePlane {
  PinholeCamera camera;
  Eigen::Matrix3d k;
  Eigen::AlignedBox2d bounds;

  explicit ImagePlane(const PinholeCamera& of) : camera(of), k(of.Matrix()) {
    const PinholeCamera::Bounds box = of.UndistortedBounds();
    bounds.extend(Eigen::Vector2d(box.min_x, box.min_y));
    bounds.extend(Eigen::Vector2d(box.max_x, box.max_y));
  }
};

// Segmenters give contours in either orientation.
Polygon WithPositiveArea(Polygon polygon) {
  if (SignedArea(polygon) < 0.0) {
    std::reverse(polygon.begin(), polygon.end());
  }
  return polygon;
}

// The pixels of the undistorted image of a wide lens are no measure, so solid angles are.
double OverlapOf(const Polygon& outline, const Polygon& polygon, const PinholeCamera& camera) {
  return camera.IsWide() ? OverlapOnSphere(camera, outline, polygon)
                         : IntersectionOverUnion(outline, polygon);
}

double OverlapWithHull(const Polygon& polygon, const ObservationResult& observation,
                       const ImagePlane& image) {
  const Polygon hull = ClipToBox(observation.hull, image.bounds);
  return observation.is_box ? IntersectionOverUnion(BoundingBox(polygon), BoundingBox(hull))
                            : OverlapOf(polygon, hull, image.camera);
}

double OverlapWithMask(const Polygon& polygon, const ObservationResult& observation,
                       const ImagePlane& image) {
  return OverlapOf(ClipToBox(WithPositiveArea(observation.contour), image.bounds), polygon,
                   image.camera);
}

void MeasureLines(const Ellipsoid& ellipsoid, const Ellipse& ellipse,
                  const ObservationResult& observation, const Eigen::Matrix3d& k, ObjectFit& fit) {
  const Eigen::Matrix4d quadric = (observation.cam_from_world * ellipsoid).DualQuadric();
  Mean mtd;
  Mean tangent;
  for (const auto& [line, is_one_sided] : observation.lines) {
    if (is_one_sided) {
      continue;
    }
    ++fit.lines;
    // The plane through the camera centre and the line, in the camera frame.
    const Eigen::Vector3d normal = (k.transpose() * line.Homogeneous()).normalized();
    const Eigen::Vector4d plane(normal.x(), normal.y(), normal.z(), 0.0);
    mtd.Add(std::abs(plane.dot(quadric * plane)));
    tangent.Add(std::abs(line.SignedDistance(ellipse.center) + ellipse.HalfExtent(line.normal)));
  }
  fit.mtd_m2 = mtd.Value();
  fit.tangent_px = tangent.Value();
}

ObjectFit MeasureIn(const ImagePlane& image, const Ellipsoid& ellipsoid,
                    const ObservationResult& observation) {
  const bool has_mask = !observation.is_box && observation.contour.size() >= 3;
  ObjectFit fit;
  fit.observations = 1;
  fit.siou = 0.0;
  fit.siou_mask = has_mask ? std::optional(0.0) : std::nullopt;
  const std::optional<Ellipse> ellipse =
      ProjectEllipsoid(image.k, observation.cam_from_world, ellipsoid);
  if (!ellipse) {
    return fit;
  }
  const Polygon polygon =
      VisiblePart(ellipse->Polygon(kEllipseCorners), image.camera, image.bounds);
  fit.siou = OverlapWithHull(polygon, observation, image);
  if (has_mask) {
    fit.siou_mask = OverlapWithMask(polygon, observation, image);
  }
  MeasureLines(ellipsoid, *ellipse, observation, image.k, fit);
  return fit;
}

}  // namespace

ObjectFit MeasureObject(const Ellipsoid& ellipsoid, std::span<const ObservationResult> observations,
                        const PinholeCamera& camera) {
  const ImagePlane image(camera);
  FitMean mean;
  for (const ObservationResult& observation : observations) {
    mean.Add(MeasureIn(image, ellipsoid, observation));
  }
  return mean.Value();
}

void MeasureObjects(ObjectResults& report) {
  for (ObjectResult& object : report.objects) {
    object.fit = MeasureObject(object.ellipsoid, object.observations, report.camera);
  }
}

ObjectResults MeasuredObjects(const Map& map, const PinholeCamera& camera,
                              const std::string& sequence) {
  ObjectResults report = CollectObjectResults(map, camera);
  report.sequence = sequence;
  MeasureObjects(report);
  return report;
}

MapFit SummarizeFits(const ObjectResults& report) {
  MapFit summary;
  FitMean mean;
  for (const ObjectResult& object : report.objects) {
    if (object.state == ObjectState::kMapped) {
      ++summary.objects;
      mean.Add(object.fit);
    }
  }
  summary.mean = mean.Value();
  return summary;
}

}  // namespace hullslam
