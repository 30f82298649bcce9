// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/object_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geometry/polygon.h"
#include "objects/constraint/misfit.h"

namespace hullslam {

Eigen::Vector3d SphereDirection(int index, int count) {
  const double z = 1.0 - (2.0 * index + 1.0) / count;
  const double angle = index * std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

double SupportOf(const Ellipsoid& ellipsoid, const Eigen::Vector3d& normal) {
  const Rigid3& pose = ellipsoid.world_from_object;
  const Eigen::Vector3d in_object = pose.rotation.conjugate() * normal;
  return normal.dot(pose.translation) + ellipsoid.half_axes.cwiseProduct(in_object).norm();
}

namespace {

constexpr int kSides = 48;  // sides of a footprint
constexpr int kGapDirections = 256;
// A line limits the object downwards if the normal of its plane points more downwards than
// sideways.
constexpr double kDownwards = 0.5 * std::numbers::sqrt2;
constexpr size_t kLeastLowerLines = 3;
constexpr double kLeastLowerShare = 0.25;  // of the lower lines that must not be cut off

Eigen::Vector2d DirectionOf(int index, int count) {
  const double angle = 2.0 * std::numbers::pi * index / count;
  return {std::cos(angle), std::sin(angle)};
}

// Measures how far an object reaches in a direction of the upright frame.
class Reach {
 public:
  Reach(const Ellipsoid& upright, std::span<const MisfitSample> samples)
      : ellipsoid_(upright), samples_(samples) {}

  double Along(const Eigen::Vector3d& normal) const {
    const Eigen::Vector3d in_object = ellipsoid_.world_from_object.rotation.conjugate() * normal;
    const double excess = PredictExcess(samples_, in_object, KeyframeId()).value_or(0.0);
    return SupportOf(ellipsoid_, normal) + excess;
  }

 private:
  const Ellipsoid& ellipsoid_;
  std::span<const MisfitSample> samples_;
};

std::vector<Eigen::Vector2d> FootprintOf(const Ellipsoid& upright, const Reach& reach) {
  const Eigen::Vector2d center = upright.world_from_object.translation.head<2>();
  const double far = 4.0 * upright.half_axes.maxCoeff();
  std::vector<Eigen::Vector2d> polygon = {
      center + Eigen::Vector2d(-far, -far), center + Eigen::Vector2d(far, -far),
      center + Eigen::Vector2d(far, far), center + Eigen::Vector2d(-far, far)};
  for (int i = 0; i < kSides; ++i) {
    const Eigen::Vector2d direction = DirectionOf(i, kSides);
    polygon = ClipToHalfPlane(polygon, direction, reach.Along({direction.x(), direction.y(), 0.0}));
  }
  return polygon;
}

// Whether enough of the lines that limit the object downwards are not cut off.
bool IsBottomSeen(const Ellipsoid& ellipsoid, const PinholeCamera& camera,
                  std::span<const ResolvedObservation> observations,
                  const Eigen::Vector3d& up_in_object) {
  size_t lines = 0;
  size_t free = 0;
  for (const ResolvedObservation& observation : observations) {
    for (const SilhouetteLine& line : observation.detection->lines) {
      const auto plane = PlaneOfLine(camera, observation.cam_from_world, ellipsoid, line.line);
      if (plane && plane->normal.dot(up_in_object) < -kDownwards) {
        ++lines;
        free += line.is_one_sided ? 0 : 1;
      }
    }
  }
  return free >= kLeastLowerLines &&
         static_cast<double>(free) >= kLeastLowerShare * static_cast<double>(lines);
}

// A rectangle with a side along `direction` around the points: centre and half side lengths in the
// frame of the direction.
struct Rectangle {
  Eigen::Vector2d direction;
  Eigen::Vector2d min;
  Eigen::Vector2d max;
  double Area() const { return (max - min).prod(); }
};

Rectangle RectangleAlong(const std::vector<Eigen::Vector2d>& points,
                         const Eigen::Vector2d& direction) {
  constexpr double kFar = std::numeric_limits<double>::max();
  Rectangle rectangle{direction, Eigen::Vector2d::Constant(kFar), Eigen::Vector2d::Constant(-kFar)};
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d turned(direction.dot(point),
                                 direction.x() * point.y() - direction.y() * point.x());
    rectangle.min = rectangle.min.cwiseMin(turned);
    rectangle.max = rectangle.max.cwiseMax(turned);
  }
  return rectangle;
}

// The rectangle of least area; its sides have the directions of the footprint's sides.
Rectangle SmallestRectangle(const std::vector<Eigen::Vector2d>& points) {
  Rectangle best = RectangleAlong(points, Eigen::Vector2d::UnitX());
  for (int i = 1; i < kSides / 4; ++i) {
    const Rectangle next = RectangleAlong(points, DirectionOf(i, kSides));
    if (next.Area() < best.Area()) {
      best = next;
    }
  }
  return best;
}

double ReachOfFootprint(const ObjectBody& body, const Eigen::Vector2d& direction) {
  double reach = -std::numeric_limits<double>::max();
  for (const Eigen::Vector2d& corner : body.footprint) {
    reach = std::max(reach, direction.dot(corner));
  }
  return reach;
}

void Finish(ObjectBody& body, const Reach& reach) {
  body.footprint = FootprintOf(body.ellipsoid, reach);
  body.bottom = -reach.Along(-Eigen::Vector3d::UnitZ());
  body.top = reach.Along(Eigen::Vector3d::UnitZ());
  const bool is_sound = body.footprint.size() >= 3 && body.bottom < body.top;
  if (!is_sound) {  // the samples contradict each other
    const Reach plain(body.ellipsoid, {});
    body.footprint = FootprintOf(body.ellipsoid, plain);
    body.bottom = -plain.Along(-Eigen::Vector3d::UnitZ());
    body.top = plain.Along(Eigen::Vector3d::UnitZ());
  }
  const Rectangle rectangle = SmallestRectangle(body.footprint);
  body.width = 0.5 * (rectangle.max - rectangle.min).sum();
  body.size = ((rectangle.max - rectangle.min).sum() + body.Height()) / 3.0;
}

}  // namespace

Eigen::Quaterniond UprightFromWorld(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
}

ObjectBody MeasureBody(ObjectId id, const Ellipsoid& ellipsoid, const PinholeCamera& camera,
                       std::span<const ResolvedObservation> observations,
                       const Eigen::Quaterniond& upright_from_world) {
  ObjectBody body;
  body.id = id;
  body.ellipsoid = Rigid3(upright_from_world, Eigen::Vector3d::Zero()) * ellipsoid;
  const std::vector<MisfitSample> samples = MeasureMisfit(camera, ellipsoid, observations);
  Finish(body, Reach(body.ellipsoid, samples));
  body.is_bottom_seen = IsBottomSeen(
      ellipsoid, camera, observations,
      body.ellipsoid.world_from_object.rotation.conjugate() * Eigen::Vector3d::UnitZ());
  return body;
}

ObjectBody BodyOfEllipsoid(ObjectId id, const Ellipsoid& ellipsoid,
                           const Eigen::Quaterniond& upright_from_world) {
  ObjectBody body;
  body.id = id;
  body.ellipsoid = Rigid3(upright_from_world, Eigen::Vector3d::Zero()) * ellipsoid;
  Finish(body, Reach(body.ellipsoid, {}));
  return body;
}

UprightBox BoxOf(const ObjectBody& body, const Eigen::Quaterniond& upright_from_world) {
  const Rectangle rectangle = SmallestRectangle(body.footprint);
  const Eigen::Vector2d turned = 0.5 * (rectangle.min + rectangle.max);
  const Eigen::Vector2d& x = rectangle.direction;
  const Eigen::Vector2d middle = turned.x() * x + turned.y() * Eigen::Vector2d(-x.y(), x.x());
  const Eigen::Vector2d half = 0.5 * (rectangle.max - rectangle.min);
  const Rigid3 upright_from_box(
      Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(x.y(), x.x()), Eigen::Vector3d::UnitZ())),
      Eigen::Vector3d(middle.x(), middle.y(), 0.5 * (body.bottom + body.top)));
  return {Rigid3(upright_from_world.conjugate(), Eigen::Vector3d::Zero()) * upright_from_box,
          Eigen::Vector3d(half.x(), half.y(), 0.5 * body.Height())};
}

double FootprintGap(const ObjectBody& a, const ObjectBody& b) {
  double gap = -std::numeric_limits<double>::max();
  for (int i = 0; i < kGapDirections; ++i) {
    const Eigen::Vector2d direction = DirectionOf(i, kGapDirections);
    gap = std::max(gap, -ReachOfFootprint(b, -direction) - ReachOfFootprint(a, direction));
  }
  return gap;
}

double FootprintOverlap(const ObjectBody& a, const ObjectBody& b) {
  const double area = std::min(SignedArea(a.footprint), SignedArea(b.footprint));
  return area > 0.0 ? std::min(1.0, IntersectionArea(a.footprint, b.footprint) / area) : 0.0;
}

double EllipsoidGap(const Ellipsoid& a, const Ellipsoid& b) {
  const auto gap_along = [&](const Eigen::Vector3d& direction) {
    return -SupportOf(b, -direction) - SupportOf(a, direction);
  };
  const Eigen::Vector3d between = b.world_from_object.translation - a.world_from_object.translation;
  double gap =
      between.norm() > 0.0 ? gap_along(between.normalized()) : -std::numeric_limits<double>::max();
  for (int i = 0; i < kGapDirections; ++i) {
    gap = std::max(gap, gap_along(SphereDirection(i, kGapDirections)));
  }
  return gap;
}

double VolumeShare(const Ellipsoid& a, const Ellipsoid& b) {
  constexpr int kShells = 6;
  constexpr int kPerShell = 64;
  const Rigid3 b_from_world = Inverse(b.world_from_object);
  int inside = 0;
  for (int shell = 0; shell < kShells; ++shell) {
    // Shells of equal volume.
    const double radius = std::cbrt((shell + 0.5) / kShells);
    for (int i = 0; i < kPerShell; ++i) {
      const Eigen::Vector3d in_a = radius * a.half_axes.cwiseProduct(SphereDirection(i, kPerShell));
      const Eigen::Vector3d in_b = b_from_world * (a.world_from_object * in_a);
      inside += in_b.cwiseQuotient(b.half_axes).squaredNorm() <= 1.0 ? 1 : 0;
    }
  }
  return static_cast<double>(inside) / (kShells * kPerShell);
}

}  // namespace hullslam
