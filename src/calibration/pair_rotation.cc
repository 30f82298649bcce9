// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/pair_rotation.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kPiecesOfPairs = 10;
constexpr double kMadToSigma = 1.4826;
constexpr double kPatternOfRows = 0.03;  // px
constexpr double kBound = 0.75;          // px, of the error of rows by a number that is determined
constexpr double kLeastChange = 0.25;    // px
constexpr double kCertain = 4.0;         // sigmas
constexpr double kLeastLate = 0.1;       // frames
// Larger deviations are not looked for, so they only come from contradictory pairs.
constexpr double kMostAngle = 0.1;    // rad
constexpr double kMostOffset = 40.0;  // px

constexpr auto kCount = static_cast<Eigen::Index>(kPairNumbers);
using PairVector = Eigen::Matrix<double, kCount, 1>;
using PairMatrix = Eigen::Matrix<double, kCount, kCount>;
using Mask = std::array<bool, kPairNumbers>;

double& NumberOf(PairNumber number, PairDeviation& deviation) {
  switch (number) {
    case PairNumber::kPitch:
      return deviation.turn.x();
    case PairNumber::kYaw:
      return deviation.turn.y();
    case PairNumber::kRoll:
      return deviation.turn.z();
    case PairNumber::kRowOffset:
      return deviation.row_offset;
    case PairNumber::kDown:
      return deviation.down;
    case PairNumber::kAhead:
      break;
  }
  return deviation.ahead;
}

PairDeviation Moved(PairDeviation deviation, const PairVector& step) {
  for (Eigen::Index i = 0; i < kCount; ++i) {
    NumberOf(static_cast<PairNumber>(i), deviation) += step[i];
  }
  return deviation;
}

// A change of a number that moves rows by a fraction of a pixel.
double SmallChange(Eigen::Index number) {
  return static_cast<PairNumber>(number) == PairNumber::kRowOffset ? 1e-2 : 1e-4;
}

std::vector<Eigen::Index> IndicesOf(const Mask& is_free) {
  std::vector<Eigen::Index> indices;
  for (Eigen::Index i = 0; i < kCount; ++i) {
    if (is_free.at(static_cast<size_t>(i))) {
      indices.push_back(i);
    }
  }
  return indices;
}

// The normal equations of some matches.
struct Equations {
  PairMatrix hessian = PairMatrix::Zero();
  PairVector gradient = PairVector::Zero();
  double weight = 0.0;
  double squares = 0.0;  // weighted

  Equations& operator+=(const Equations& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    weight += other.weight;
    squares += other.squares;
    return *this;
  }
};

// The fit of the numbers that are not held.
class RowFit {
 public:
  RowFit(std::span<const MatchedPair> pairs, const PinholeCamera& camera, double yaw)
      : pairs_(pairs), camera_(camera) {
    deviation_.turn.y() = yaw;
  }

  const PairDeviation& deviation() const { return deviation_; }
  size_t CountMatches() const {
    size_t count = 0;
    for (const MatchedPair& pair : pairs_) {
      count += pair.matches.size();
    }
    return count;
  }

  // The median length of the errors of rows, px or standard deviations.
  double MedianError(const PairDeviation& deviation, bool is_in_sigmas) const {
    std::vector<double> errors;
    for (const MatchedPair& pair : pairs_) {
      for (const PairMatch& match : pair.matches) {
        errors.push_back(std::abs(deviation.RowError(camera_, match)) /
                         (is_in_sigmas ? match.sigma : 1.0));
      }
    }
    return Median(std::move(errors));
  }

  // Iterates to the minimum; those that are held keep their values. The scale of the loss follows
  // the median error, so it is as wide as the deviation is large at the begin.
  void Solve(const Mask& is_free) {
    constexpr int kMostIterations = 30;
    free_ = IndicesOf(is_free);
    for (int i = 0; i < kMostIterations; ++i) {
      scale_ = std::max(1e-3, kMadToSigma * MedianError(deviation_, true));
      MakeEquations();
      const PairVector step = Step(sum_);
      deviation_ = Moved(deviation_, step);
      if ((step.array().abs() < 1e-4 * Changes().array()).all()) {
        break;
      }
    }
    MakeEquations();
  }

  // The covariance of errors that are independent, and that of a jackknife.
  PairMatrix BundleCovariance() const {
    return Inverse(sum_.hessian) * sum_.squares / std::max(1.0, sum_.weight);
  }
  PairMatrix JackknifeCovariance() const {
    const auto count = static_cast<double>(pieces_.size());
    Eigen::Matrix<double, kCount, Eigen::Dynamic> steps(kCount, pieces_.size());
    for (size_t i = 0; i < pieces_.size(); ++i) {
      Equations without = sum_;
      without.hessian -= pieces_[i].hessian;
      without.gradient -= pieces_[i].gradient;
      steps.col(static_cast<Eigen::Index>(i)) = Step(without);
    }
    const PairVector mean = steps.rowwise().mean();
    const auto deviations = (steps.colwise() - mean).eval();
    return (count - 1.0) / count * deviations * deviations.transpose();
  }
  // The covariance by a pattern of the rows that does not average out.
  PairMatrix PatternCovariance() const {
    return kPatternOfRows * kPatternOfRows * Inverse(MeanSquares());
  }
  // The mean of the products of the derivatives of a row, px^2 per unit^2.
  PairMatrix MeanSquares() const { return derivatives_ / std::max(1.0, sum_.weight); }

  // The mean error of the rows of each pair, px; empty without enough matches.
  std::vector<std::optional<double>> MeanErrors() const {
    constexpr double kFewest = 10.0;
    std::vector<std::optional<double>> means;
    for (const MatchedPair& pair : pairs_) {
      std::vector<double> errors;
      for (const PairMatch& match : pair.matches) {
        errors.push_back(deviation_.RowError(camera_, match));
      }
      means.push_back(static_cast<double>(errors.size()) < kFewest
                          ? std::nullopt
                          : std::optional(Median(std::move(errors))));
    }
    return means;
  }

 private:
  static PairVector Changes() {
    PairVector changes;
    for (Eigen::Index i = 0; i < kCount; ++i) {
      changes[i] = SmallChange(i);
    }
    return changes;
  }

  // The inverse of the rows and columns of the free numbers; the others are 0.
  PairMatrix Inverse(const PairMatrix& hessian) const {
    // Directions of which nothing is known have a very large sigma, but not an infinite one.
    constexpr double kNothing = 1e-9;
    PairMatrix inverse = PairMatrix::Zero();
    if (!free_.empty()) {
      Eigen::MatrixXd some = hessian(free_, free_);
      some.diagonal() *= 1.0 + kNothing;
      const Eigen::MatrixXd of_some = some.inverse();
      inverse(free_, free_) = of_some;
    }
    return inverse;
  }
  PairVector Step(const Equations& equations) const {
    return -Inverse(equations.hessian) * equations.gradient;
  }

  void MakeEquations() {
    const size_t pieces = std::min(kPiecesOfPairs, pairs_.size());
    std::array<PairDeviation, kPairNumbers> below;
    std::array<PairDeviation, kPairNumbers> above;
    for (Eigen::Index i = 0; i < kCount; ++i) {
      below.at(static_cast<size_t>(i)) = Moved(deviation_, -SmallChange(i) * PairVector::Unit(i));
      above.at(static_cast<size_t>(i)) = Moved(deviation_, SmallChange(i) * PairVector::Unit(i));
    }
    pieces_.assign(pieces, {});
    derivatives_.setZero();
    for (size_t p = 0; p < pairs_.size(); ++p) {
      Equations& piece = pieces_[p * pieces / pairs_.size()];
      for (const PairMatch& match : pairs_[p].matches) {
        PairVector derivative;
        for (Eigen::Index i = 0; i < kCount; ++i) {
          const auto k = static_cast<size_t>(i);
          derivative[i] =
              (above.at(k).RowError(camera_, match) - below.at(k).RowError(camera_, match)) /
              (2.0 * SmallChange(i));
        }
        const double residual = deviation_.RowError(camera_, match) / match.sigma;
        const double relative = residual / scale_;
        const double weight = 1.0 / (1.0 + relative * relative / kCauchy);
        const double information = weight / (match.sigma * match.sigma);
        piece.hessian += information * derivative * derivative.transpose();
        piece.gradient += weight / match.sigma * residual * derivative;
        piece.weight += weight;
        piece.squares += weight * residual * residual;
        derivatives_ += weight * derivative * derivative.transpose();
      }
    }
    sum_ = {};
    for (const Equations& piece : pieces_) {
      sum_ += piece;
    }
  }

  static constexpr double kCauchy = 2.3849 * 2.3849;  // sigmas^2; 95 % as efficient as the mean

  std::span<const MatchedPair> pairs_;
  PinholeCamera camera_;
  PairDeviation deviation_;
  std::vector<Eigen::Index> free_;
  double scale_ = 1.0;  // standard deviation of the residuals, in sigmas of the matches
  std::vector<Equations> pieces_;
  Equations sum_;
  PairMatrix derivatives_ = PairMatrix::Zero();
};

// The covariance of all numbers, 0 for those that are held.
PairMatrix CovarianceOf(const RowFit& fit, const Mask& is_free) {
  const PairMatrix bundle = fit.BundleCovariance();
  const PairMatrix jackknife = fit.JackknifeCovariance();
  std::vector<double> factors;
  for (const Eigen::Index i : IndicesOf(is_free)) {
    factors.push_back(std::sqrt(jackknife(i, i) / bundle(i, i)));
  }
  const double factor = factors.empty() ? 1.0 : std::max(1.0, Median(std::move(factors)));
  PairMatrix covariance = factor * factor * bundle;
  for (Eigen::Index i = 0; i < kCount; ++i) {
    covariance(i, i) = std::max(covariance(i, i), jackknife(i, i));
  }
  return covariance + fit.PatternCovariance();
}

// Fits how late the right images are: one number and its error by a jackknife.
void FitDelay(std::span<const MatchedPair> pairs, const RowFit& fit, PairRows& rows) {
  constexpr size_t kFewestPairs = 8;
  const std::vector<std::optional<double>> errors = fit.MeanErrors();
  std::vector<Eigen::Vector2d> seen;  // motion and error
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (errors[i] && pairs[i].moved_down) {
      seen.emplace_back(*pairs[i].moved_down, *errors[i]);
    }
  }
  if (seen.size() < kFewestPairs) {
    return;
  }
  const auto slope_without = [&](size_t first, size_t end) {
    std::vector<Eigen::Vector2d> some = seen;
    some.erase(some.begin() + std::ptrdiff_t(first), some.begin() + std::ptrdiff_t(end));
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& one : some) {
      mean += one / static_cast<double>(some.size());
    }
    double squares = 1e-12;
    double products = 0.0;
    for (const Eigen::Vector2d& one : some) {
      squares += (one.x() - mean.x()) * (one.x() - mean.x());
      products += (one.x() - mean.x()) * (one.y() - mean.y());
    }
    return products / squares;
  };
  rows.frames_late = slope_without(0, 0);
  const size_t pieces = std::min(kPiecesOfPairs, seen.size());
  std::vector<double> slopes;
  for (size_t i = 0; i < pieces; ++i) {
    slopes.push_back(slope_without(i * seen.size() / pieces, (i + 1) * seen.size() / pieces));
  }
  const auto all = Eigen::Map<const Eigen::ArrayXd>(slopes.data(), std::ssize(slopes));
  const auto count = static_cast<double>(pieces);
  rows.frames_late_sigma = std::sqrt((count - 1.0) / count * (all - all.mean()).square().sum());
  double squares = 0.0;
  for (const Eigen::Vector2d& one : seen) {
    squares += one.x() * one.x() / static_cast<double>(seen.size());
  }
  rows.is_late =
      std::abs(rows.frames_late) > std::max(kLeastLate, kCertain * rows.frames_late_sigma) &&
      std::abs(rows.frames_late) * std::sqrt(squares) > kLeastChange;
}

// Whether the free numbers change rows by more than chance, and by more than is usual.
bool IsChange(const RowFit& fit, const PairMatrix& covariance, const Mask& is_free) {
  PairDeviation found = fit.deviation();
  PairVector values = PairVector::Zero();
  std::vector<Eigen::Index> free = IndicesOf(is_free);
  std::erase(free, static_cast<Eigen::Index>(PairNumber::kYaw));
  for (const Eigen::Index i : free) {
    values[i] = NumberOf(static_cast<PairNumber>(i), found);
  }
  if (free.empty()) {
    return false;
  }
  const Eigen::VectorXd value = values(free);
  const Eigen::MatrixXd of_free = covariance(free, free);
  const double chi2 = value.dot(of_free.ldlt().solve(value));
  const auto count = static_cast<double>(free.size());
  const double change = std::sqrt(values.dot(fit.MeanSquares() * values));
  return chi2 > count + 4.0 * std::sqrt(2.0 * count) && change > kLeastChange &&
         found.turn.norm() < kMostAngle && std::hypot(found.down, found.ahead) < kMostAngle &&
         std::abs(found.row_offset) < kMostOffset;
}

}  // namespace

Eigen::Vector2d PairDeviation::Undone(const PinholeCamera& camera,
                                      const Eigen::Vector2d& right) const {
  return camera.Project(ExpSo3(turn).conjugate() *
                        camera.Unproject(right - Eigen::Vector2d(0.0, row_offset), 1.0));
}

double PairDeviation::RowError(const PinholeCamera& camera, const PairMatch& match) const {
  const Eigen::Vector2d expected = Undone(camera, match.right);
  const double disparity = (match.left.x() - expected.x()) / camera.fx;
  return expected.y() - match.left.y() +
         (camera.fy * down - (match.left.y() - camera.cy) * ahead) * disparity;
}

StereoCalibration PairDeviation::AppliedTo(const StereoCalibration& given,
                                           const StereoRectifier& rectifier,
                                           const PinholeCamera& rectified) const {
  StereoCalibration applied = given;
  const Eigen::Quaterniond from_rectified =
      rectifier.rectified_from_right().rotation.conjugate() * ExpSo3(turn);
  const double baseline = rectified.bf / rectified.fx;
  applied.right.cy += row_offset * given.right.fy / rectified.fy;
  applied.right_from_left = {
      (from_rectified * rectifier.rectified_from_left().rotation).normalized(),
      from_rectified * (-baseline * Eigen::Vector3d(1.0, down, ahead))};
  return applied;
}

PairRows FitPairRows(std::span<const MatchedPair> pairs, const PinholeCamera& camera, double yaw) {
  constexpr size_t kFewestMatches = 200;
  PairRows rows;
  RowFit fit(pairs, camera, yaw);
  rows.matches = fit.CountMatches();
  if (rows.matches < kFewestMatches) {
    return rows;
  }
  rows.median_before = fit.MedianError({}, false);
  Mask is_free;
  is_free.fill(true);
  PairMatrix covariance;
  while (true) {
    fit.Solve(is_free);
    covariance = CovarianceOf(fit, is_free);
    const PairMatrix squares = fit.MeanSquares();
    size_t last = kPairNumbers;
    for (const Eigen::Index k : IndicesOf(is_free)) {
      const auto i = static_cast<size_t>(k);
      PairDeviation found = fit.deviation();
      PairEvidence& one = rows.evidence.at(i);
      one.value = NumberOf(static_cast<PairNumber>(i), found);
      one.sigma = std::sqrt(covariance(k, k));
      one.is_determined = one.sigma * std::sqrt(squares(k, k)) < kBound ||
                          std::abs(one.value) > kCertain * one.sigma;
      last = one.is_determined ? last : i;
    }
    if (last == kPairNumbers) {
      break;
    }
    is_free.at(last) = false;
    fit = RowFit(pairs, camera, yaw);
  }
  rows.median = fit.MedianError(fit.deviation(), false);
  FitDelay(pairs, fit, rows);
  rows.is_changed = !rows.is_late && IsChange(fit, covariance, is_free);
  rows.found = fit.deviation();
  rows.found.turn.y() = yaw;
  return rows;
}

double YawOf(double disparity_offset, const PinholeCamera& camera) {
  const double half = 0.5 * camera.width / camera.fx;
  return -disparity_offset / (camera.fx * (1.0 + half * half / 3.0));
}

}  // namespace hullslam
