// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_overlap.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/polygon.h"

namespace hullslam {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Sums up the intersection of the unit disc with a polygon, edge by edge: its area, and the
// integrals of u and u u^T, u = (cos phi, sin phi), over the arcs of the circle inside the polygon.
// The part of an edge inside the disc adds the area of a triangle with the centre; the part outside
// adds a sector. Both have a sign.
class DiscIntersection {
 public:
  void AddEdge(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d along = b - a;
    const double square = along.squaredNorm();
    const double half_linear = a.dot(along);
    const double discriminant = half_linear * half_linear - square * (a.squaredNorm() - 1.0);
    if (square == 0.0) {
      return;
    }
    const double root = std::sqrt(std::max(discriminant, 0.0));
    const double enter = std::max((-half_linear - root) / square, 0.0);
    const double leave = std::min((-half_linear + root) / square, 1.0);
    if (discriminant <= 0.0 || enter >= leave) {
      AddSector(a, b);
      return;
    }
    const Eigen::Vector2d first = a + enter * along;
    const Eigen::Vector2d last = a + leave * along;
    if (enter > 0.0) {
      AddSector(a, first);
    }
    area_ += 0.5 * Cross(first, last);
    if (leave < 1.0) {
      AddSector(last, b);
    }
  }

  double area() const { return area_; }
  const Eigen::Vector2d& first_moment() const { return first_moment_; }
  const Eigen::Matrix2d& second_moment() const { return second_moment_; }

 private:
  void AddSector(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double angle = std::atan2(Cross(from, to), from.dot(to));
    const Eigen::Vector2d u = from.normalized();
    const Eigen::Vector2d v = to.normalized();
    const double turn = 0.5 * (v.x() * v.y() - u.x() * u.y());
    const double mixed = 0.5 * (v.y() * v.y() - u.y() * u.y());
    area_ += 0.5 * angle;
    first_moment_ += Eigen::Vector2d(v.y() - u.y(), u.x() - v.x());
    second_moment_(0, 0) += 0.5 * angle + turn;
    second_moment_(0, 1) += mixed;
    second_moment_(1, 0) += mixed;
    second_moment_(1, 1) += 0.5 * angle - turn;
  }

  double area_ = 0.0;
  Eigen::Vector2d first_moment_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_moment_ = Eigen::Matrix2d::Zero();
};

// The overlap from the areas of the intersection and the ellipse, and from their derivatives.
Overlap OverlapOfAreas(double intersection, const ByEllipse& by_intersection, double covered,
                       const ByEllipse& by_covered, double region) {
  const double united = covered + region - intersection;
  Overlap overlap;
  overlap.iou = intersection / united;
  overlap.by_ellipse = (by_intersection - overlap.iou * (by_covered - by_intersection)) / united;
  return overlap;
}

// The length that two intervals share, and its derivative with respect to the centre and the half
// length of the first one.
struct SharedLength {
  double length = 0.0;
  double by_center = 0.0;
  double by_half = 0.0;
};

SharedLength Share(double center, double half, double low, double high) {
  SharedLength shared;
  const bool ends_inside = center + half < high;
  const bool begins_inside = center - half > low;
  const double end = ends_inside ? center + half : high;
  const double begin = begins_inside ? center - half : low;
  if (begin < end) {
    shared.length = end - begin;
    shared.by_center = (ends_inside ? 1.0 : 0.0) - (begins_inside ? 1.0 : 0.0);
    shared.by_half = (ends_inside ? 1.0 : 0.0) + (begins_inside ? 1.0 : 0.0);
  }
  return shared;
}

}  // namespace

// The ellipse is m + L u with S = L L^T. When m and S change, its boundary moves outwards by
// n.dm + n^T dS n / (2 h) at the point with normal n and half extent h. The change of the
// intersection's area is the integral of this over the arcs inside the region. With n h = L^-T u
// and an arc length of det(L) |L^-T u| dphi it is:
//   d/dm = det(L) L^-T int u,   d/dS = det(L) / 2 L^-T (int u u^T) L^-1.
Overlap EllipseOverlap(const EllipseNumbers& ellipse, std::span<const Eigen::Vector2d> region) {
  const Eigen::Matrix2d shape = ToEllipse(ellipse).shape;
  Eigen::Matrix2d root = Eigen::Matrix2d::Zero();
  root(0, 0) = std::sqrt(shape(0, 0));
  root(1, 0) = shape(0, 1) / root(0, 0);
  root(1, 1) = std::sqrt(shape(1, 1) - root(1, 0) * root(1, 0));
  const double determinant = root(0, 0) * root(1, 1);
  const Eigen::Matrix2d inverse = root.inverse();
  DiscIntersection disc;
  for (size_t i = 0; i < region.size(); ++i) {
    const Eigen::Vector2d& next = region[i + 1 < region.size() ? i + 1 : 0];
    disc.AddEdge(inverse * (region[i] - ellipse.head<2>()), inverse * (next - ellipse.head<2>()));
  }
  const Eigen::Vector2d by_center = determinant * inverse.transpose() * disc.first_moment();
  const Eigen::Matrix2d by_shape =
      0.5 * determinant * inverse.transpose() * disc.second_moment() * inverse;
  ByEllipse by_intersection;
  by_intersection << by_center.transpose(), by_shape(0, 0), 2.0 * by_shape(0, 1), by_shape(1, 1);
  const double pi = std::numbers::pi;
  ByEllipse by_area;
  by_area << 0.0, 0.0, shape(1, 1), -2.0 * shape(0, 1), shape(0, 0);
  return OverlapOfAreas(determinant * disc.area(), by_intersection, pi * determinant,
                        0.5 * pi / determinant * by_area, SignedArea(region));
}

Overlap BoxOverlap(const EllipseNumbers& ellipse, const Eigen::AlignedBox2d& box) {
  const double half_x = std::sqrt(ellipse[2]);
  const double half_y = std::sqrt(ellipse[4]);
  const SharedLength x = Share(ellipse[0], half_x, box.min().x(), box.max().x());
  const SharedLength y = Share(ellipse[1], half_y, box.min().y(), box.max().y());
  ByEllipse by_intersection;
  by_intersection << x.by_center * y.length, x.length * y.by_center,
      x.by_half * y.length / (2.0 * half_x), 0.0, x.length * y.by_half / (2.0 * half_y);
  ByEllipse by_area;
  by_area << 0.0, 0.0, 2.0 * half_y / half_x, 0.0, 2.0 * half_x / half_y;
  return OverlapOfAreas(x.length * y.length, by_intersection, 4.0 * half_x * half_y, by_area,
                        box.volume());
}

OverlapCost::OverlapCost(const PinholeCamera& camera, std::span<const Eigen::Vector2d> region,
                         double sigma)
    : EllipseCost(1, camera, sigma), region_(region.begin(), region.end()) {
  if (SignedArea(region_) < 0.0) {
    std::reverse(region_.begin(), region_.end());
  }
}

OverlapCost::OverlapCost(const PinholeCamera& camera, const Eigen::AlignedBox2d& box, double sigma)
    : EllipseCost(1, camera, sigma), box_(box) {}

void OverlapCost::Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
                          std::span<ByEllipse> by_ellipse) const {
  const Overlap overlap =
      region_.empty() ? BoxOverlap(ellipse, box_) : EllipseOverlap(ellipse, region_);
  residuals[0] = 1.0 - overlap.iou;
  if (!by_ellipse.empty()) {
    by_ellipse[0] = -overlap.by_ellipse;
  }
}

namespace {

constexpr int kConicVertices = 64;
constexpr std::array kOverlapPrimitives = {ObjectPrimitive::kHull, ObjectPrimitive::kContour,
                                           ObjectPrimitive::kBox, ObjectPrimitive::kConic,
                                           ObjectPrimitive::kBoxEllipse};

std::unique_ptr<ceres::CostFunction> OverlapWithRegion(const ObjectCostInput& input,
                                                       std::span<const Eigen::Vector2d> region) {
  if (region.size() < 3) {
    return nullptr;
  }
  return std::make_unique<OverlapCost>(input.camera, region, input.sigma);
}

std::unique_ptr<ceres::CostFunction> MakeOverlapCost(const ObjectCostInput& input) {
  const Detection& detection = input.detection;
  const ObjectPrimitive primitive = detection.primitive;
  if (primitive == ObjectPrimitive::kHull) {
    return OverlapWithRegion(input, detection.hull);
  }
  if (primitive == ObjectPrimitive::kContour) {
    return OverlapWithRegion(input, detection.contour.Unpack());
  }
  if ((primitive == ObjectPrimitive::kConic || primitive == ObjectPrimitive::kBoxEllipse) &&
      detection.ellipse.has_value()) {
    return OverlapWithRegion(input, detection.ellipse->Polygon(kConicVertices));
  }
  if (primitive == ObjectPrimitive::kBox && !detection.box.isEmpty()) {
    return std::make_unique<OverlapCost>(input.camera, detection.box, input.sigma);
  }
  return nullptr;
}

}  // namespace

const ResidualKind kOverlapResidual = {.name = "overlap",
                                       .primitives = kOverlapPrimitives,
                                       .takes_lines = false,
                                       .of_pixel_error =
                                           [](double error_px, const ProjectedSize& size) {
                                             const double ratio =
                                                 size.radius_px / (size.radius_px + error_px);
                                             return 1.0 - ratio * ratio;
                                           },
                                       .make_cost = MakeOverlapCost};

}  // namespace hullslam
