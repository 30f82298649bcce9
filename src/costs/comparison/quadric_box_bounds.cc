// SPDX-License-Identifier: GPL-3.0-or-later
#include "costs/comparison/quadric_box_bounds.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace hullslam {
namespace {

constexpr std::array kSides = {kLeft, kTop, kRight, kBottom};

int AxisOf(BoxSide side) { return side == kLeft || side == kRight ? 0 : 1; }
double SignOf(BoxSide side) { return side == kLeft || side == kTop ? -1.0 : 1.0; }
double PositionOf(const Eigen::AlignedBox2d& box, BoxSide side) {
  return SignOf(side) < 0.0 ? box.min()[AxisOf(side)] : box.max()[AxisOf(side)];
}

// The five numbers with x and y exchanged; twice gives the same again.
template <typename Numbers>
Numbers Exchanged(const Numbers& numbers) {
  Numbers exchanged;
  for (int i = 0; i < 5; ++i) {
    constexpr int kOther[] = {1, 0, 4, 3, 2};
    exchanged[i] = numbers[kOther[i]];
  }
  return exchanged;
}

// A point of the ellipse, and the derivatives of its coordinates by the ellipse.
struct EllipsePoint {
  Eigen::Vector2d position;
  std::array<ByEllipse, 2> by_ellipse = {ByEllipse::Zero(), ByEllipse::Zero()};
};

// The point with the least or largest x: m_x + s sqrt(S_xx), m_y + s S_xy / sqrt(S_xx). Only the
// derivative of its x is needed.
EllipsePoint ExtremeInX(const EllipseNumbers& ellipse, double sign) {
  const double half = std::sqrt(ellipse[2]);
  EllipsePoint point;
  point.position = {ellipse[0] + sign * half, ellipse[1] + sign * ellipse[3] / half};
  point.by_ellipse[0] << 1.0, 0.0, 0.5 * sign / half, 0.0, 0.0;
  return point;
}

// The two points at this x, if there are any. With dx = x - m_x, a = S_xy / S_xx,
// b = S_yy - S_xy^2 / S_xx and c = 1 - dx^2 / S_xx they have y = m_y + a dx +- sqrt(b c).
std::vector<EllipsePoint> PointsAtX(const EllipseNumbers& ellipse, double x) {
  const double dx = x - ellipse[0];
  const double s_xx = ellipse[2];
  const double a = ellipse[3] / s_xx;
  const double b = ellipse[4] - a * ellipse[3];
  const double c = 1.0 - dx * dx / s_xx;
  std::vector<EllipsePoint> points;
  if (b * c <= 0.0) {
    return points;
  }
  ByEllipse by_a;
  by_a << 0.0, 0.0, -a / s_xx, 1.0 / s_xx, 0.0;
  ByEllipse by_b;
  by_b << 0.0, 0.0, a * a, -2.0 * a, 1.0;
  ByEllipse by_c;
  by_c << 2.0 * dx / s_xx, 0.0, dx * dx / (s_xx * s_xx), 0.0, 0.0;
  const double root = std::sqrt(b * c);
  for (const double sign : {-1.0, 1.0}) {
    EllipsePoint point;
    point.position = {x, ellipse[1] + a * dx + sign * root};
    point.by_ellipse[1] = dx * by_a + 0.5 * sign / root * (c * by_b + b * by_c);
    point.by_ellipse[1][0] -= a;
    point.by_ellipse[1][1] += 1.0;
    points.push_back(point);
  }
  return points;
}

EllipsePoint Exchanged(const EllipsePoint& point) {
  return {{point.position.y(), point.position.x()},
          {Exchanged(point.by_ellipse[1]), Exchanged(point.by_ellipse[0])}};
}

EllipsePoint Extreme(const EllipseNumbers& ellipse, BoxSide side) {
  return AxisOf(side) == 0 ? ExtremeInX(ellipse, SignOf(side))
                           : Exchanged(ExtremeInX(Exchanged(ellipse), SignOf(side)));
}

// The points of the ellipse on the line of a side.
std::vector<EllipsePoint> PointsOn(const EllipseNumbers& ellipse, const Eigen::AlignedBox2d& box,
                                   BoxSide side) {
  const double position = PositionOf(box, side);
  if (AxisOf(side) == 0) {
    return PointsAtX(ellipse, position);
  }
  std::vector<EllipsePoint> points = PointsAtX(Exchanged(ellipse), position);
  for (EllipsePoint& point : points) {
    point = Exchanged(point);
  }
  return points;
}

// Whether the point is inside all sides that are cut. A point on a side is inside it.
bool IsInside(const Eigen::Vector2d& point, const Eigen::AlignedBox2d& box,
              const std::array<bool, 4>& is_cut) {
  constexpr double kTolerance = 1e-9;  // px
  for (const BoxSide side : kSides) {
    const double beyond = SignOf(side) * (point[AxisOf(side)] - PositionOf(box, side));
    if (is_cut[side] && beyond > kTolerance) {
      return false;
    }
  }
  return true;
}

BoxBound BoundOf(const EllipsePoint& point, BoxSide side) {
  const int axis = AxisOf(side);
  return {point.position[axis], point.by_ellipse[static_cast<size_t>(axis)]};
}

}  // namespace

BoxBound ClippedBound(const EllipseNumbers& ellipse, const Eigen::AlignedBox2d& box,
                      const std::array<bool, 4>& is_cut, BoxSide side) {
  const EllipsePoint extreme = Extreme(ellipse, side);
  if (IsInside(extreme.position, box, is_cut)) {
    return BoundOf(extreme, side);
  }
  std::optional<EllipsePoint> farthest;
  for (const BoxSide cut : kSides) {
    if (!is_cut[cut]) {
      continue;
    }
    for (const EllipsePoint& point : PointsOn(ellipse, box, cut)) {
      const bool is_farther =
          !farthest || SignOf(side) * (point.position - farthest->position)[AxisOf(side)] > 0.0;
      if (is_farther && IsInside(point.position, box, is_cut)) {
        farthest = point;
      }
    }
  }
  return BoundOf(farthest.value_or(extreme), side);
}

BoxBoundsCost::BoxBoundsCost(const PinholeCamera& camera, const Eigen::AlignedBox2d& box,
                             const std::array<bool, 4>& is_cut, double sigma)
    : EllipseCost(kSides.size(), camera, sigma), box_(box), is_cut_(is_cut) {}

void BoxBoundsCost::Compute(const EllipseNumbers& ellipse, std::span<double> residuals,
                            std::span<ByEllipse> by_ellipse) const {
  for (const BoxSide side : kSides) {
    const BoxBound bound = ClippedBound(ellipse, box_, is_cut_, side);
    residuals[side] = bound.value - PositionOf(box_, side);
    if (!by_ellipse.empty()) {
      by_ellipse[side] = bound.by_ellipse;
    }
  }
}

namespace {

constexpr std::array kBoxPrimitives = {ObjectPrimitive::kBox};

// The sides whose lines are one-sided, because the border of the image cuts them.
std::array<bool, 4> CutSides(std::span<const SilhouetteLine> lines) {
  std::array<bool, 4> is_cut = {};
  for (const SilhouetteLine& line : lines) {
    const Eigen::Vector2d& n = line.line.normal;
    const bool is_upright = std::abs(n.x()) > std::abs(n.y());
    const BoxSide side =
        is_upright ? (n.x() < 0.0 ? kLeft : kRight) : (n.y() < 0.0 ? kTop : kBottom);
    is_cut[side] = is_cut[side] || line.is_one_sided;
  }
  return is_cut;
}

std::unique_ptr<ceres::CostFunction> MakeBoxBoundsCost(const ObjectCostInput& input) {
  if (input.detection.box.isEmpty()) {
    return nullptr;
  }
  return std::make_unique<BoxBoundsCost>(input.camera, input.detection.box,
                                         CutSides(input.detection.lines), input.sigma);
}

}  // namespace

const ResidualKind kBoxBoundsResidual = {
    .name = "box_bounds",
    .primitives = kBoxPrimitives,
    .takes_lines = false,
    .of_pixel_error = [](double error_px, const ProjectedSize& /*size*/) { return error_px; },
    .make_cost = MakeBoxBoundsCost};

}  // namespace hullslam
