// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/two_views.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <optional>
#include <utility>

#include "estimators/epipolar_refinement.h"
#include "geometry/triangulation.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr double kChi2 = Chi2Bound(2);
constexpr size_t kFewestPairs = 20;
// A point with less parallax than this (radians) has no measurable depth, so it counts neither for
// nor against a motion.
constexpr double kNoParallax = 0.3 * std::numbers::pi / 180.0;

cv::UsacParams MakeUsacParams(double threshold, uint64_t seed) {
  cv::UsacParams params;
  params.confidence = 0.999;
  params.isParallel = false;
  params.loIterations = 10;
  params.loMethod = cv::LOCAL_OPTIM_INNER_LO;
  params.loSampleSize = 50;
  params.maxIterations = 2000;
  params.neighborsSearch = cv::NEIGH_GRID;
  params.randomGeneratorState = static_cast<int>(seed % 0x7fffffffU);
  params.sampler = cv::SAMPLING_UNIFORM;
  params.score = cv::SCORE_METHOD_MSAC;
  params.threshold = threshold;
  return params;
}

// The pairs as OpenCV's points, and the typical noise of their pixels.
struct CvPairs {
  std::vector<cv::Point2d> a;
  std::vector<cv::Point2d> b;
  double sigma = 1.0;  // px
};

// The stretch of the undistorted image at a pixel, as a factor on the noise.
double StretchAt(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  return 1.0 / std::sqrt(camera.DistortionJacobian(pixel).determinant());
}

// OpenCV's estimators have one threshold for all pairs, so they get the pairs of the inner part of
// the image, where the stretch is small, if these are enough. All pairs judge the motions.
std::vector<PixelPair> PairsForSamples(const PinholeCamera& camera,
                                       std::span<const PixelPair> pairs) {
  constexpr double kMostStretch = 2.0;
  std::vector<PixelPair> inner;
  for (const PixelPair& pair : pairs) {
    if (StretchAt(camera, pair.a) < kMostStretch && StretchAt(camera, pair.b) < kMostStretch) {
      inner.push_back(pair);
    }
  }
  return inner.size() < kFewestPairs ? std::vector<PixelPair>(pairs.begin(), pairs.end()) : inner;
}

CvPairs ToCv(std::span<const PixelPair> pairs) {
  CvPairs points;
  std::vector<double> sigmas;
  for (const PixelPair& pair : pairs) {
    points.a.emplace_back(pair.a.x(), pair.a.y());
    points.b.emplace_back(pair.b.x(), pair.b.y());
    sigmas.push_back(std::max(pair.sigma_a, pair.sigma_b));
  }
  points.sigma = Median(std::move(sigmas));
  return points;
}

Rigid3 MakeMotion(const cv::Mat& rotation, const cv::Mat& translation, double sign) {
  Eigen::Matrix3d matrix;
  Eigen::Vector3d vector;
  cv::cv2eigen(rotation, matrix);
  cv::cv2eigen(translation, vector);
  return {Eigen::Quaterniond(matrix).normalized(), sign * vector.normalized()};
}

// Adds the four motions that follow from an essential matrix.
void AddMotionsOfEssential(const CvPairs& points, const cv::Mat& k, uint64_t seed,
                           std::vector<Rigid3>& motions) {
  cv::Mat mask;
  const cv::Mat essential =
      cv::findEssentialMat(points.a, points.b, k, k, cv::noArray(), cv::noArray(), mask,
                           MakeUsacParams(std::sqrt(kChi2) * points.sigma, seed));
  if (essential.rows != 3 || essential.cols != 3) {
    return;
  }
  cv::Mat first;
  cv::Mat second;
  cv::Mat translation;
  cv::decomposeEssentialMat(essential, first, second, translation);
  for (const cv::Mat& rotation : {first, second}) {
    motions.push_back(MakeMotion(rotation, translation, 1.0));
    motions.push_back(MakeMotion(rotation, translation, -1.0));
  }
}

// Adds the motions that follow from a homography (Malis and Vargas 2007). The homography of a plane
// does not determine the sign of the motion, so both signs are tried.
void AddMotionsOfHomography(const CvPairs& points, const cv::Mat& k, uint64_t seed,
                            std::vector<Rigid3>& motions) {
  cv::Mat mask;
  const cv::Mat homography = cv::findHomography(
      points.a, points.b, mask, MakeUsacParams(std::sqrt(kChi2) * points.sigma, seed));
  if (homography.empty()) {
    return;
  }
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  std::vector<cv::Mat> normals;
  const int count = cv::decomposeHomographyMat(homography, k, rotations, translations, normals);
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    if (cv::norm(translations[i]) > 1e-6) {
      motions.push_back(MakeMotion(rotations[i], translations[i], 1.0));
    }
  }
}

// A motion and the pairs that agree with it.
struct Hypothesis {
  Rigid3 b_from_a;
  std::vector<TwoViews::Point> points;  // with parallax
  std::vector<double> parallaxes;       // radians; of the points and of pairs without parallax
  std::vector<size_t> agreeing;         // points and pairs without parallax that agree
  double cost = 0.0;  // cost of a refined motion; a pair that does not agree costs kMaxPairCost
};

double SquaredError(const PinholeCamera& camera, const Eigen::Vector3d& point,
                    const Eigen::Vector2d& pixel, double sigma) {
  const Eigen::Vector2d error = camera.Project(point) - pixel;
  return (camera.DistortionJacobian(pixel) * error).squaredNorm() / (sigma * sigma);
}

Hypothesis Explain(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                   const Rigid3& b_from_a) {
  Hypothesis hypothesis{.b_from_a = b_from_a, .points = {}, .parallaxes = {}, .agreeing = {}};
  for (size_t i = 0; i < pairs.size(); ++i) {
    const PixelPair& pair = pairs[i];
    const Eigen::Vector3d ray_a = camera.Unproject(pair.a, 1.0);
    const Eigen::Vector3d ray_b = camera.Unproject(pair.b, 1.0);
    const Eigen::Vector3d turned = b_from_a.rotation * ray_a;
    const double parallax = std::atan2(turned.cross(ray_b).norm(), turned.dot(ray_b));
    if (parallax < kNoParallax) {
      // At infinity: it agrees if the rotation alone explains it.
      if (SquaredError(camera, turned, pair.b, std::hypot(pair.sigma_a, pair.sigma_b)) < kChi2) {
        hypothesis.agreeing.push_back(i);
      }
      hypothesis.parallaxes.push_back(parallax);
      continue;
    }
    const std::optional<Eigen::Vector3d> point =
        TriangulatePoint(Rigid3(), ray_a.head<2>(), b_from_a, ray_b.head<2>());
    if (!point || !(point->z() > 0.0)) {
      continue;
    }
    const Eigen::Vector3d in_b = b_from_a * *point;
    if (in_b.z() > 0.0 && SquaredError(camera, *point, pair.a, pair.sigma_a) < kChi2 &&
        SquaredError(camera, in_b, pair.b, pair.sigma_b) < kChi2) {
      hypothesis.points.push_back({i, *point});
      hypothesis.parallaxes.push_back(parallax);
      hypothesis.agreeing.push_back(i);
    }
  }
  return hypothesis;
}

// The covariance from which the rotation of the rays of a to those of b is computed (Kabsch 1976).
Eigen::Matrix3d RayCovariance(const PinholeCamera& camera, const PixelPair& pair) {
  return camera.Unproject(pair.b, 1.0).normalized() *
         camera.Unproject(pair.a, 1.0).normalized().transpose();
}

// The least-squares rotation for a sum of such covariances.
Eigen::Quaterniond FitRotation(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return Eigen::Quaterniond(svd.matrixU() * flip * svd.matrixV().transpose());
}

// The rotation that comes nearest to the points of a motion.
Eigen::Quaterniond NearestTurn(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                               const Hypothesis& motion) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const TwoViews::Point& point : motion.points) {
    covariance += RayCovariance(camera, pairs[point.pair]);
  }
  return FitRotation(covariance);
}

// The number of pairs that a rotation alone explains. The rotation is fitted repeatedly to the
// pairs that it explains.
size_t CountTurnedFrom(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                       Eigen::Quaterniond rotation) {
  constexpr int kRounds = 10;
  size_t explained = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double slack =
        round < kRounds / 2 ? 16.0 : 1.0;  // parallax makes the first fits imprecise
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    explained = 0;
    for (const PixelPair& pair : pairs) {
      const Eigen::Vector3d ray_a = camera.Unproject(pair.a, 1.0);
      const Eigen::Vector3d turned = rotation * ray_a;
      if (turned.z() > 0.0 &&
          SquaredError(camera, turned, pair.b, std::hypot(pair.sigma_a, pair.sigma_b)) <
              slack * kChi2) {
        ++explained;
        covariance += RayCovariance(camera, pair);
      }
    }
    if (explained < 3) {
      return explained;
    }
    rotation = FitRotation(covariance);
  }
  return explained;
}

// The same for the better one of two starts. A motion's own rotation may be far from any rotation
// that explains the pairs, because a sideways translation can replace a large part of a rotation.
size_t CountTurned(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                   const Hypothesis& motion) {
  const size_t from_motion = CountTurnedFrom(camera, pairs, motion.b_from_a.rotation);
  if (motion.points.size() < 3) {
    return from_motion;
  }
  return std::max(from_motion, CountTurnedFrom(camera, pairs, NearestTurn(camera, pairs, motion)));
}

bool AreDifferent(const Rigid3& one, const Rigid3& other) {
  constexpr double kTurn = 3.0 * std::numbers::pi / 180.0;
  constexpr double kDirection = 15.0 * std::numbers::pi / 180.0;
  return AngularDistance(one.rotation, other.rotation) > kTurn ||
         std::acos(std::clamp(one.translation.dot(other.translation), -1.0, 1.0)) > kDirection;
}

// The true sigma of the pairs over the assumed sigma, from the errors of a motion.
double MeasureNoise(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                    const Rigid3& b_from_a) {
  constexpr double kMedianOfChi2 = 0.455;  // with one degree of freedom
  constexpr double kLeastNoise = 0.1;
  std::vector<double> errors;
  for (const PixelPair& pair : pairs) {
    errors.push_back(SampsonError(camera, b_from_a, pair));
  }
  return std::max(kLeastNoise, std::sqrt(Median(std::move(errors)) / kMedianOfChi2));
}

// Refines hypotheses, with the noise that is measured from the one with the smallest errors.
std::vector<Hypothesis> Refine(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                               std::span<const Hypothesis> hypotheses) {
  std::vector<Rigid3> motions;
  double noise = std::numeric_limits<double>::infinity();
  for (const Hypothesis& hypothesis : hypotheses) {
    motions.push_back(RefineMotion(camera, pairs, hypothesis.b_from_a, 1.0));
    noise = std::min(noise, MeasureNoise(camera, pairs, motions.back()));
  }
  std::vector<Hypothesis> refined;
  for (const Rigid3& motion : motions) {
    Hypothesis& result =
        refined.emplace_back(Explain(camera, pairs, RefineMotion(camera, pairs, motion, noise)));
    result.cost = kMaxPairCost * static_cast<double>(pairs.size());
    for (const size_t agreeing : result.agreeing) {
      result.cost -= kMaxPairCost - PairCost(camera, result.b_from_a, pairs[agreeing], noise);
    }
  }
  return refined;
}

// Whether the first image shows the direction in which the camera moves, or the opposite one.
bool IsForward(const PinholeCamera& camera, const Rigid3& b_from_a) {
  const Eigen::Vector3d direction = Inverse(b_from_a).translation;
  constexpr double kSideways = 1e-6;  // share of the step along the axis
  return std::abs(direction.z()) > kSideways * direction.norm() &&
         camera.UndistortedBounds().Contains(camera.Project(direction / direction.z()));
}

// The factor on the shares of TwoViewOptions for this motion.
double ShareFactor(const PinholeCamera& camera, const Hypothesis& motion,
                   const TwoViewOptions& options) {
  return IsForward(camera, motion.b_from_a) ? options.forward_factor : 1.0;
}

// TwoViews::parallax; 0 if no pair agrees with the motion.
double TypicalParallax(const PinholeCamera& camera, const Hypothesis& motion,
                       const TwoViewOptions& options) {
  if (motion.parallaxes.empty()) {
    return 0.0;
  }
  return ReachedBy(0.5 * ShareFactor(camera, motion, options), motion.parallaxes) * 180.0 /
         std::numbers::pi;
}

bool HasTooLittleParallax(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                          const Hypothesis& motion, const TwoViewOptions& options) {
  return TypicalParallax(camera, motion, options) < options.min_parallax ||
         static_cast<double>(CountTurned(camera, pairs, motion)) >
             options.max_turned_share * static_cast<double>(motion.agreeing.size());
}

// The reason why the best hypothesis is not good enough.
TwoViewFailure Judge(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                     std::span<const Hypothesis> hypotheses, const Hypothesis& best,
                     const TwoViewOptions& options) {
  if (HasTooLittleParallax(camera, pairs, best, options)) {
    return TwoViewFailure::kTooLittleParallax;
  }
  // The distances of a pair from two epipolar lines are nearly independent where these cross, so
  // the costs of two equally good motions differ by the difference of two chi-square distributions.
  const double deviation = std::sqrt(4.0 * static_cast<double>(best.agreeing.size()));
  for (const Hypothesis& other : hypotheses) {
    if (AreDifferent(other.b_from_a, best.b_from_a) &&
        other.cost < best.cost + options.min_rival_deviations * deviation) {
      return TwoViewFailure::kAmbiguous;
    }
  }
  const bool has_few = best.points.size() < options.min_points ||
                       static_cast<double>(best.points.size()) <
                           options.min_share * ShareFactor(camera, best, options) *
                               static_cast<double>(best.agreeing.size());
  return has_few ? TwoViewFailure::kTooFewPoints : TwoViewFailure::kNone;
}

}  // namespace

std::string_view ToString(TwoViewFailure failure) {
  switch (failure) {
    case TwoViewFailure::kTooFewPairs:
      return "too few matches";
    case TwoViewFailure::kTooLittleParallax:
      return "too little parallax";
    case TwoViewFailure::kAmbiguous:
      return "ambiguous";
    case TwoViewFailure::kTooFewPoints:
      return "too few points";
    default:
      return "none";
  }
}

TwoViews EstimateTwoViews(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                          const TwoViewOptions& options) {
  TwoViews result;
  if (pairs.size() < std::max(kFewestPairs, options.min_points)) {
    result.failure = TwoViewFailure::kTooFewPairs;
    return result;
  }
  const CvPairs points = ToCv(PairsForSamples(camera, pairs));
  cv::Mat k;
  cv::eigen2cv(camera.Matrix(), k);
  std::vector<Rigid3> motions;
  AddMotionsOfEssential(points, k, options.seed, motions);
  AddMotionsOfHomography(points, k, options.seed, motions);
  std::vector<Hypothesis> hypotheses;
  for (const Rigid3& motion : motions) {
    hypotheses.push_back(Explain(camera, pairs, motion));
  }
  const auto most = std::max_element(hypotheses.begin(), hypotheses.end(),
                                     [](const Hypothesis& a, const Hypothesis& b) {
                                       return a.agreeing.size() < b.agreeing.size();
                                     });
  if (most == hypotheses.end() || most->agreeing.size() < options.min_points) {
    result.failure = TwoViewFailure::kTooFewPoints;
    return result;
  }
  const auto conclude = [&](const Hypothesis& motion, TwoViewFailure failure) {
    result.failure = failure;
    result.b_from_a = motion.b_from_a;
    result.points = motion.points;
    result.is_forward = IsForward(camera, motion.b_from_a);
    result.parallax = TypicalParallax(camera, motion, options);
    return result;
  };
  if (HasTooLittleParallax(camera, pairs, *most, options)) {
    return conclude(*most, TwoViewFailure::kTooLittleParallax);
  }
  const double fewest = options.min_rival_share * static_cast<double>(most->agreeing.size());
  std::erase_if(hypotheses, [fewest](const Hypothesis& hypothesis) {
    return static_cast<double>(hypothesis.agreeing.size()) < fewest;
  });
  const std::vector<Hypothesis> refined = Refine(camera, pairs, hypotheses);
  const auto best =
      std::min_element(refined.begin(), refined.end(),
                       [](const Hypothesis& a, const Hypothesis& b) { return a.cost < b.cost; });
  return conclude(*best, Judge(camera, pairs, refined, *best, options));
}

}  // namespace hullslam
