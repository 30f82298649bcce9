// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/similarity_optimization.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "optim/pose_problem.h"
#include "optim/robust.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

// The squared errors of the inliers, for internal::Minimize.
class SimilarityTerms {
 public:
  SimilarityTerms(const PinholeCamera& camera, std::span<const SimilarityMatch> matches,
                  const std::vector<uint8_t>& is_inlier, bool robust, bool fix_scale)
      : camera_(camera),
        matches_(matches),
        is_inlier_(is_inlier),
        robust_(robust),
        fix_scale_(fix_scale) {}

  // Infinite if a point of an inlier is behind a camera.
  double Cost(const Sim3& b_from_a) const {
    const TwoWaySimilarity similarity(b_from_a);
    double cost = 0.0;
    for (size_t i = 0; i < matches_.size(); ++i) {
      if (is_inlier_[i] == 0) {
        continue;
      }
      const SimilarityMatch& match = matches_[i];
      const SimilarityChi2 chi2(camera_, match, similarity);
      if (!std::isfinite(chi2.in_a + chi2.in_b)) {
        return std::numeric_limits<double>::infinity();
      }
      cost += Loss(chi2.in_a, OutlierBound(match.measured_in_a)) +
              Loss(chi2.in_b, OutlierBound(match.measured_in_b));
      if (!fix_scale_) {
        const SimilarityDepthResidual depth(match, similarity);
        cost += Loss(depth.residual * depth.residual, Chi2Bound(1));
      }
    }
    return cost;
  }

  void Linearize(const Sim3& b_from_a, Matrix7d& hessian, Vector7d& gradient) const {
    const TwoWaySimilarity similarity(b_from_a);
    hessian.setZero();
    gradient.setZero();
    for (size_t i = 0; i < matches_.size(); ++i) {
      const SimilarityMatch& match = matches_[i];
      if (is_inlier_[i] == 0 || !std::isfinite(SimilarityError(camera_, match, similarity))) {
        continue;
      }
      const SimilarityResidual in_a = SimilarityResidualInA(camera_, match, similarity);
      const SimilarityResidual in_b = SimilarityResidualInB(camera_, match, similarity);
      Add(in_a.residual, in_a.jacobian, OutlierBound(match.measured_in_a), hessian, gradient);
      Add(in_b.residual, in_b.jacobian, OutlierBound(match.measured_in_b), hessian, gradient);
      if (!fix_scale_) {
        const SimilarityDepthResidual depth(match, similarity);
        Add(Eigen::Matrix<double, 1, 1>(depth.residual), depth.jacobian, Chi2Bound(1), hessian,
            gradient);
      }
    }
    if (fix_scale_) {
      // With a zero gradient and without coupling to other parameters, no step changes the scale.
      hessian.row(6).setZero();
      hessian.col(6).setZero();
      hessian(6, 6) = 1.0;
      gradient[6] = 0.0;
    }
  }

 private:
  double Loss(double chi2, double bound) const { return robust_ ? HuberCost(chi2, bound) : chi2; }

  template <typename Residual, typename Jacobian>
  void Add(const Residual& residual, const Jacobian& jacobian, double bound, Matrix7d& hessian,
           Vector7d& gradient) const {
    const double weight = robust_ ? HuberWeight(residual.squaredNorm(), bound) : 1.0;
    hessian.noalias() += jacobian.transpose() * (weight * jacobian);
    gradient.noalias() += jacobian.transpose() * (weight * residual);
  }

  const PinholeCamera& camera_;
  std::span<const SimilarityMatch> matches_;
  const std::vector<uint8_t>& is_inlier_;
  bool robust_;
  bool fix_scale_;
};

// The inliers are the matches with a SimilarityError of at most `bound`.
void ChooseInliers(const PinholeCamera& camera, std::span<const SimilarityMatch> matches,
                   double bound, SimilarityOptimizationResult& result) {
  const TwoWaySimilarity similarity(result.b_from_a);
  result.inlier_count = 0;
  for (size_t i = 0; i < matches.size(); ++i) {
    const bool is_inlier = SimilarityError(camera, matches[i], similarity) <= bound &&
                           matches[i].point_in_b.z() >= kMinDepth;
    result.is_inlier[i] = is_inlier ? 1 : 0;
    result.inlier_count += is_inlier ? 1 : 0;
  }
}

}  // namespace

SimilarityOptimizationResult OptimizeSimilarity(const PinholeCamera& camera, const Sim3& b_from_a,
                                                std::span<const SimilarityMatch> matches,
                                                const SimilarityOptimizationOptions& options) {
  SimilarityOptimizationResult result;
  result.b_from_a = b_from_a;
  result.is_inlier.assign(matches.size(), 0);
  // In the first round all points in front of both cameras are inliers.
  ChooseInliers(camera, matches, std::numeric_limits<double>::max(), result);
  for (int round = 0; round < options.rounds.rounds && result.inlier_count >= 3; ++round) {
    const SimilarityTerms problem(camera, matches, result.is_inlier,
                                  round < options.rounds.robust_rounds, options.fix_scale);
    result.b_from_a = internal::Minimize(problem, result.b_from_a, options.rounds);
    ChooseInliers(camera, matches, 1.0, result);
  }
  if (result.inlier_count < 3) {
    result.b_from_a = b_from_a;
  }
  return result;
}

}  // namespace hullslam
