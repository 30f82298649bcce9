// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/shape_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "hullslam/objects/object_constraint_options.h"
#include "objects/constraint/misfit.h"
#include "scene/object_body.h"

namespace hullslam {
namespace {

// Centre (m) and rotation (rad) in the frame of the object, and log half axes.
using Gradient = Eigen::Matrix<double, 9, 1>;
using Information = Eigen::Matrix<double, 9, 9>;

// Width of the correlation of the shape's deviation, rad. The side of a box is 90 degrees wide from
// edge to edge, and a handle or a foot is about as wide; so deviations are much alike up to 35
// degrees to either side.
constexpr double kShapeWidth = 35.0 * std::numbers::pi / 180.0;
constexpr int kHalf = 64;                 // patches of a half of the sphere
constexpr int kPatches = 2 * kHalf;       // patch i + kHalf is opposite to patch i
constexpr double kLeastVariance = 1e-18;  // m^2, so that exact lines have a weight

// The contribution of one line to the covariance.
struct LineTerm {
  size_t patch = 0;     // of the normal
  Gradient gradient;    // of the excess
  double excess = 0.0;  // m
  double pixels_per_metre = 0.0;
  double share = 0.0;   // the lines of a mask count as at most max_effective_lines
  double weight = 0.0;  // 1 / m^2, in the fit
};

// The gradient of the excess of the tangent plane with this normal.
Gradient GradientOf(const Ellipsoid& ellipsoid, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d stretched = ellipsoid.half_axes.cwiseProduct(normal);
  const double support = stretched.norm();
  const Eigen::Vector3d contact = ellipsoid.half_axes.cwiseProduct(stretched) / support;
  Gradient gradient;
  gradient << -normal, -contact.cross(normal), -stretched.cwiseAbs2() / support;
  return gradient;
}

// Patches of the sphere, evenly spread on the upper half, and their opposites.
const std::array<Eigen::Vector3d, kPatches>& PatchNormals() {
  static const std::array<Eigen::Vector3d, kPatches> normals = [] {
    std::array<Eigen::Vector3d, kPatches> made;
    for (int i = 0; i < kHalf; ++i) {
      made[i] = SphereDirection(i, kPatches);
      made[i + kHalf] = -made[i];
    }
    return made;
  }();
  return normals;
}

size_t Opposite(size_t patch) { return (patch + kHalf) % kPatches; }

size_t PatchOf(const Eigen::Vector3d& normal) {
  const auto& normals = PatchNormals();
  return static_cast<size_t>(std::max_element(normals.begin(), normals.end(),
                                              [&](const auto& a, const auto& b) {
                                                return normal.dot(a) < normal.dot(b);
                                              }) -
                             normals.begin());
}

double Correlation(size_t a, size_t b) {
  const double cosine = PatchNormals()[a].dot(PatchNormals()[b]);
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::exp(-0.5 * angle * angle / (kShapeWidth * kShapeWidth));
}

void AddLines(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
              const ResolvedObservation& observation, std::vector<LineTerm>& terms) {
  const size_t first = terms.size();
  for (const SilhouetteLine& line : observation.detection->lines) {
    const auto plane = line.is_one_sided
                           ? std::nullopt
                           : PlaneOfLine(camera, observation.cam_from_world, ellipsoid, line.line);
    if (plane) {
      terms.push_back({.patch = PatchOf(plane->normal),
                       .gradient = GradientOf(ellipsoid, plane->normal),
                       .excess = plane->excess,
                       .pixels_per_metre = plane->pixels_per_metre});
    }
  }
  const double share = std::min(1.0, ObjectConstraintOptions().max_effective_lines /
                                         static_cast<double>(terms.size() - first));
  std::for_each(terms.begin() + static_cast<std::ptrdiff_t>(first), terms.end(),
                [&](LineTerm& term) { term.share = share; });
}

// The lines that touch each patch of the sphere: the sum of their shares, and the mean excess.
struct PatchExcess {
  std::array<double, kPatches> shares{};
  std::array<double, kPatches> means{};  // m

  explicit PatchExcess(const std::vector<LineTerm>& terms) {
    for (const LineTerm& term : terms) {
      shares[term.patch] += term.share;
      means[term.patch] += term.share * term.excess;
    }
    for (size_t i = 0; i < kPatches; ++i) {
      means[i] /= std::max(shares[i], 1e-12);
    }
  }
};

// The standard deviation of the noise of a line, px: the scatter of the lines of a patch.
double MeasureNoise(const std::vector<LineTerm>& terms, const PatchExcess& patches) {
  double sum = 0.0;
  double shares = 0.0;
  for (const LineTerm& term : terms) {
    const double pixels = (term.excess - patches.means[term.patch]) * term.pixels_per_metre;
    sum += term.share * pixels * pixels;
    shares += term.share;
  }
  const auto used = static_cast<double>(std::count_if(patches.shares.begin(), patches.shares.end(),
                                                      [](double s) { return s > 0.0; }));
  const double freedom = std::max(1.0, shares - used);
  return std::sqrt(sum / freedom);
}

// Variances of the even and of the odd part of the shape's deviation, m^2.
struct ShapeVariances {
  double even = 0.0;
  double odd = 0.0;
};

// The whole variance of the even or the odd part of the field over what the fit leaves of it. In
// spherical harmonics, degree l has the share (2 l + 1) exp(-l (l + 1) w^2 / 2) of the variance.
// The fit takes up degree 1 (position), and degrees 0 and 2 (size and rotation).
double WholeOverRest(bool is_odd) {
  constexpr int kMostDegree = 21;
  double whole = 0.0;
  double rest = 0.0;
  for (int degree = is_odd ? 1 : 0; degree <= kMostDegree; degree += 2) {
    const double share =
        (2.0 * degree + 1.0) * std::exp(-0.5 * degree * (degree + 1.0) * kShapeWidth * kShapeWidth);
    whole += share;
    rest += degree > 2 ? share : 0.0;
  }
  return whole / rest;
}

ShapeVariances MeasureVariances(const PatchExcess& patches) {
  ShapeVariances variances;
  double shares = 0.0;
  for (size_t i = 0; i < kHalf; ++i) {
    const double share = std::min(patches.shares[i], patches.shares[Opposite(i)]);
    const double even = 0.5 * (patches.means[i] + patches.means[Opposite(i)]);
    const double odd = 0.5 * (patches.means[i] - patches.means[Opposite(i)]);
    variances.even += share * even * even;
    variances.odd += share * odd * odd;
    shares += share;
  }
  if (!(shares > 0.0)) {  // no opposite sides were seen: nothing tells the parts apart
    for (size_t i = 0; i < kPatches; ++i) {
      variances.even += 0.5 * patches.shares[i] * patches.means[i] * patches.means[i];
      shares += patches.shares[i];
    }
    variances.odd = variances.even;
  }
  variances.even *= WholeOverRest(false) / shares;
  variances.odd *= WholeOverRest(true) / shares;
  return variances;
}

// The sum over all pairs of lines of w_k w_l K(n_k, n_l) J_k J_l^T.
Information ShapeErrors(const std::vector<LineTerm>& terms, const ShapeVariances& variances) {
  std::array<Gradient, kPatches> sums;
  sums.fill(Gradient::Zero());
  for (const LineTerm& term : terms) {
    sums[term.patch] += term.weight * term.gradient;
  }
  Information errors = Information::Zero();
  for (size_t i = 0; i < kPatches; ++i) {
    for (size_t k = 0; k < kPatches && !sums[i].isZero(0.0); ++k) {
      const double same = Correlation(i, k);
      const double opposite = Correlation(i, Opposite(k));
      const double covariance =
          variances.even * (same + opposite) + variances.odd * (same - opposite);
      errors += covariance * sums[i] * sums[k].transpose();
    }
  }
  return errors;
}

// The information of the prior on the shape (QuadricPriorCost).
Information PriorOf(const Ellipsoid& start, bool has_depth) {
  const ObjectConstraintOptions options;
  const QuadricPriorSigmas& sigmas = has_depth ? options.prior : options.prior_without_depth;
  const double center = sigmas.center * std::cbrt(start.half_axes.prod());
  Gradient diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (center * center)),
      Eigen::Vector3d::Constant(1.0 / (sigmas.rotation * sigmas.rotation)),
      Eigen::Vector3d::Constant(1.0 / (sigmas.log_axes * sigmas.log_axes));
  return diagonal.asDiagonal();
}

// What is free, of the covariance and of what the prior contributes to each parameter (0 to 1).
std::array<FreeAxis, 3> FindFreeAxes(const Ellipsoid& ellipsoid, const Gradient& variances,
                                     const Gradient& prior_shares) {
  constexpr double kMostTurn = 26.0 * std::numbers::pi / 180.0;
  constexpr double kMostLength = 0.25;
  constexpr double kMostPrior = 0.5;
  constexpr double kEqual = 1.2;  // ratio of half axes
  const auto is_free = [&](Eigen::Index parameter, double most) {
    return prior_shares[parameter] > kMostPrior || variances[parameter] > most * most;
  };
  std::array<FreeAxis, 3> axes;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double a = ellipsoid.half_axes[(i + 1) % 3];
    const double b = ellipsoid.half_axes[(i + 2) % 3];
    axes.at(static_cast<size_t>(i)) = {
        .is_round = std::max(a, b) <= kEqual * std::min(a, b) && is_free(3 + i, kMostTurn),
        .is_undetermined = is_free(6 + i, kMostLength)};
  }
  return axes;
}

}  // namespace

std::optional<ShapeCovariance> CovarianceOf(const PinholeCamera& camera, const Ellipsoid& ellipsoid,
                                            const Ellipsoid& start,
                                            std::span<const ResolvedObservation> observations) {
  std::vector<LineTerm> terms;
  for (const ResolvedObservation& observation : observations) {
    AddLines(camera, ellipsoid, observation, terms);
  }
  if (terms.empty()) {
    return std::nullopt;
  }
  const PatchExcess patches(terms);
  const ShapeVariances variances = MeasureVariances(patches);
  const double noise_px = MeasureNoise(terms, patches);
  // As in the refinement, the misfit sets the sigma of a line.
  const Information prior = PriorOf(start, HasDepth(observations));
  Information information = prior;
  Information errors = prior;
  for (LineTerm& term : terms) {
    const double noise = noise_px / term.pixels_per_metre;
    term.weight = term.share / (noise * noise + variances.even + variances.odd + kLeastVariance);
    const Information outer = term.gradient * term.gradient.transpose();
    information += term.weight * outer;
    errors += term.weight * term.weight / term.share * noise * noise * outer;
  }
  errors += ShapeErrors(terms, variances);
  const Eigen::LDLT<Information> solver(information);
  const Information half = solver.solve(errors);
  const Information covariance = solver.solve(half.transpose());
  if (!covariance.allFinite()) {
    return std::nullopt;
  }
  const Eigen::Matrix3d world_from_object = ellipsoid.world_from_object.rotation.toRotationMatrix();
  const Eigen::DiagonalMatrix<double, 3> axes(ellipsoid.half_axes);
  ShapeCovariance result;
  result.center =
      world_from_object * covariance.topLeftCorner<3, 3>() * world_from_object.transpose();
  result.half_axes = axes * covariance.bottomRightCorner<3, 3>() * axes;
  const Information without_errors = solver.solve(Information::Identity());
  result.axes = FindFreeAxes(ellipsoid, covariance.diagonal(),
                             without_errors.diagonal().cwiseProduct(prior.diagonal()));
  return result;
}

}  // namespace hullslam
