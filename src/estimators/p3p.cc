// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/p3p.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hullslam {
namespace {

using Points = std::array<Eigen::Vector3d, 3>;

// The distances d of the points along unit rays satisfy, for the pairs (0, 1), (0, 2), (1, 2),
//   d_i^2 + d_j^2 - 2 cosine_ij d_i d_j = square_ij.
struct Triangle {
  Triangle(const Points& unit_rays, const Points& points)
      : cosines(unit_rays[0].dot(unit_rays[1]), unit_rays[0].dot(unit_rays[2]),
                unit_rays[1].dot(unit_rays[2])),
        squares((points[0] - points[1]).squaredNorm(), (points[0] - points[2]).squaredNorm(),
                (points[1] - points[2]).squaredNorm()) {}

  // The quadratic form of a pair.
  Eigen::Matrix3d Form(int pair) const {
    const auto [i, j] = kPairs[static_cast<size_t>(pair)];
    Eigen::Matrix3d form = Eigen::Matrix3d::Zero();
    form(i, i) = form(j, j) = 1.0;
    form(i, j) = form(j, i) = -cosines[pair];
    return form;
  }

  static constexpr std::array<std::array<int, 2>, 3> kPairs = {{{0, 1}, {0, 2}, {1, 2}}};
  Eigen::Vector3d cosines;
  Eigen::Vector3d squares;  // m^2
};

// The best conditioned real root of x^3 + b x^2 + c x + d. If the polynomial has local extrema,
// Newton's method starts beyond the one whose value is farther from zero.
double RealRootOfCubic(double b, double c, double d) {
  const auto value = [&](double x) { return ((x + b) * x + c) * x + d; };
  const double radicand = b * b - 3.0 * c;
  double x = -b / 3.0;
  if (radicand > 0.0) {
    const double root = std::sqrt(radicand);
    const double maximum = (-b - root) / 3.0;
    const double minimum = (-b + root) / 3.0;
    const bool is_left = value(maximum) > -value(minimum);
    const double extremum = is_left ? maximum : minimum;
    const double distance = std::sqrt(-value(extremum) / (3.0 * extremum + b));
    x = extremum + (is_left ? -distance : distance);
  } else {
    // Without extrema, this is beyond the root too: the slope is at least that of x^3.
    x -= std::cbrt(value(x));
  }
  constexpr int kMaxIterations = 50;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double step = value(x) / ((3.0 * x + 2.0 * b) * x + c);
    if (!(std::abs(step) > 1e-15 * std::abs(x))) {
      break;
    }
    x -= step;
  }
  return x;
}

// A factor gamma for which a + gamma b is singular, where |det a| <= |det b|.
double SingularFactor(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const auto mixed = [](const Eigen::Matrix3d& once, const Eigen::Matrix3d& twice) {
    return once.col(0).dot(twice.col(1).cross(twice.col(2))) +
           once.col(1).dot(twice.col(2).cross(twice.col(0))) +
           once.col(2).dot(twice.col(0).cross(twice.col(1)));
  };
  const double leading = b.determinant();
  if (leading == 0.0) {
    return 0.0;  // a is singular, as it is for triangles with equal sides
  }
  return RealRootOfCubic(mixed(a, b) / leading, mixed(b, a) / leading, a.determinant() / leading);
}

// Splits a singular quadratic form into two planes through the origin: d^T form d is proportional
// to (planes[0] . d) (planes[1] . d) (Richter-Gebert 2011, section 11.1). False if the planes are
// not real.
bool SplitIntoPlanes(const Eigen::Matrix3d& form, std::array<Eigen::Vector3d, 2>& planes) {
  // Minus the adjugate is p p^T, where p is the cross product of the planes.
  Eigen::Matrix3d product;
  product.col(0) = form.col(2).cross(form.col(1));
  product.col(1) = form.col(0).cross(form.col(2));
  product.col(2) = form.col(1).cross(form.col(0));
  Eigen::Index largest = 0;
  const double square = product.diagonal().maxCoeff(&largest);
  if (!(square > 0.0)) {
    return false;
  }
  const Eigen::Matrix3d rank_one = form + Skew(product.col(largest) / std::sqrt(square));
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  rank_one.cwiseAbs().maxCoeff(&row, &column);
  planes = {rank_one.row(row).transpose().normalized(), rank_one.col(column).normalized()};
  return true;
}

// Gauss-Newton on the three equations of the triangle.
void Polish(const Triangle& triangle, Eigen::Vector3d& distances) {
  for (int step = 0; step < 2; ++step) {
    Eigen::Vector3d residual;
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (int pair = 0; pair < 3; ++pair) {
      const auto [i, j] = Triangle::kPairs[static_cast<size_t>(pair)];
      const double cosine = triangle.cosines[pair];
      residual[pair] = distances[i] * distances[i] + distances[j] * distances[j] -
                       2.0 * cosine * distances[i] * distances[j] - triangle.squares[pair];
      jacobian(pair, i) = 2.0 * (distances[i] - cosine * distances[j]);
      jacobian(pair, j) = 2.0 * (distances[j] - cosine * distances[i]);
    }
    const Eigen::Vector3d moved = distances - jacobian.inverse() * residual;
    if (!moved.allFinite()) {
      return;
    }
    distances = moved;
  }
}

// The rigid motion of one triangle to a congruent one.
Rigid3 MoveTriangle(const Points& from, const Points& to) {
  const auto frame = [](const Points& points) {
    const Eigen::Vector3d x = (points[1] - points[0]).normalized();
    const Eigen::Vector3d z = x.cross(points[2] - points[0]).normalized();
    Eigen::Matrix3d axes;
    axes << x, z.cross(x), z;
    return axes;
  };
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(frame(to) * frame(from).transpose()));
  Rigid3 motion(rotation.normalized(), Eigen::Vector3d::Zero());
  motion.translation =
      (to[0] + to[1] + to[2] - motion.rotation * (from[0] + from[1] + from[2])) / 3.0;
  return motion;
}

void AddPose(const Triangle& triangle, const Points& unit_rays, const Points& points,
             Eigen::Vector3d distances, P3pPoses& poses) {
  Polish(triangle, distances);
  if (!(distances.minCoeff() > 0.0) || poses.count == poses.cam_from_world.size()) {
    return;
  }
  const Points seen = {distances[0] * unit_rays[0], distances[1] * unit_rays[1],
                       distances[2] * unit_rays[2]};
  if (SpansTriangle(seen)) {
    poses.cam_from_world[poses.count++] = MoveTriangle(points, seen);
  }
}

// The distances in a plane through the origin for which `form` is zero; at most two.
void SolveInPlane(const Eigen::Vector3d& plane, const Eigen::Matrix3d& form,
                  const Triangle& triangle, const Points& unit_rays, const Points& points,
                  P3pPoses& poses) {
  const Eigen::Matrix3d sum = triangle.Form(0) + triangle.Form(1) + triangle.Form(2);
  const Eigen::Vector3d u = plane.unitOrthogonal();
  const Eigen::Vector3d v = plane.cross(u);
  const double a = u.dot(form * u);
  const double b = u.dot(form * v);
  const double c = v.dot(form * v);
  const double radicand = b * b - a * c;
  if (!(radicand >= 0.0)) {
    return;
  }
  // a x^2 + 2 b x y + c y^2 = 0 without cancellation: (x : y) is (q : a) or (c : q).
  const double q = -(b + std::copysign(std::sqrt(radicand), b));
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(q * u + a * v), Eigen::Vector3d(c * u + q * v)}) {
    const double length = direction.dot(sum * direction);
    const double scale = std::copysign(std::sqrt(triangle.squares.sum() / length), direction.sum());
    const Eigen::Vector3d distances = scale * direction;
    if (distances.minCoeff() > 0.0 && distances.allFinite()) {
      AddPose(triangle, unit_rays, points, distances, poses);
    }
  }
}

}  // namespace

bool SpansTriangle(const std::array<Eigen::Vector3d, 3>& points) {
  constexpr double kLeastHeight = 0.01;  // as a share of the longest side
  const Eigen::Vector3d first = points[1] - points[0];
  const Eigen::Vector3d second = points[2] - points[0];
  const double longest =
      std::max({first.squaredNorm(), second.squaredNorm(), (second - first).squaredNorm()});
  const double area = first.cross(second).norm();
  return area > 0.0 && area >= kLeastHeight * longest;
}

P3pPoses SolveP3p(const std::array<Eigen::Vector3d, 3>& rays,
                  const std::array<Eigen::Vector3d, 3>& points) {
  P3pPoses poses;
  if (!SpansTriangle(points)) {
    return poses;
  }
  const Points unit_rays = {rays[0].normalized(), rays[1].normalized(), rays[2].normalized()};
  const Triangle triangle(unit_rays, points);
  // Scaled, so that the numbers do not depend on the unit of length.
  const Eigen::Vector3d squares = triangle.squares / triangle.squares.sum();
  // Both forms are zero at all solutions, and so are their combinations.
  Eigen::Matrix3d first = squares[2] * triangle.Form(0) - squares[0] * triangle.Form(2);
  Eigen::Matrix3d second = squares[2] * triangle.Form(1) - squares[1] * triangle.Form(2);
  if (std::abs(first.determinant()) > std::abs(second.determinant())) {
    first.swap(second);
  }
  const double factor = SingularFactor(first, second);
  std::array<Eigen::Vector3d, 2> planes;
  if (!SplitIntoPlanes(first + factor * second, planes)) {
    return poses;
  }
  for (const Eigen::Vector3d& plane : planes) {
    SolveInPlane(plane, std::abs(factor) < 1.0 ? second : first, triangle, unit_rays, points,
                 poses);
  }
  return poses;
}

}  // namespace hullslam
