// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/similarity.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "estimators/determination.h"
#include "estimators/p3p.h"
#include "hullslam/geometry/alignment.h"

namespace hullslam {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

bool IsUsable(const SimilarityMatch& match) {
  return match.point_in_a.allFinite() && match.point_in_b.allFinite() &&
         match.point_in_a.z() >= kMinDepth && match.point_in_b.z() >= kMinDepth &&
         match.measured_in_a.IsValid() && match.measured_in_b.IsValid();
}

// For Ransac().
class SimilarityProblem {
 public:
  using Model = TwoWaySimilarity;
  static constexpr size_t kSampleSize = 3;

  SimilarityProblem(const PinholeCamera& camera, std::span<const SimilarityMatch> matches,
                    bool fix_scale)
      : camera_(camera), fix_scale_(fix_scale) {
    for (size_t i = 0; i < matches.size(); ++i) {
      if (IsUsable(matches[i])) {
        matches_.push_back(matches[i]);
        indices_.push_back(i);
      }
    }
  }

  size_t size() const { return matches_.size(); }
  // The index of a match of this problem in the list that it was made from.
  size_t IndexOf(size_t match) const { return indices_[match]; }

  void Solve(const std::array<size_t, kSampleSize>& sample, std::vector<Model>& models) const {
    std::array<Eigen::Vector3d, 3> in_a;
    std::array<Eigen::Vector3d, 3> in_b;
    for (size_t i = 0; i < sample.size(); ++i) {
      in_a[i] = matches_[sample[i]].point_in_a;
      in_b[i] = matches_[sample[i]].point_in_b;
    }
    if (!SpansTriangle(in_a) || !SpansTriangle(in_b)) {
      return;
    }
    const PointAlignment alignment =
        AlignPoints(in_a, in_b, fix_scale_ ? AlignmentKind::kSe3 : AlignmentKind::kSim3);
    if (alignment.ok() && alignment.scale > 0.0) {
      const Rigid3& rigid = alignment.target_from_source;
      models.emplace_back(Sim3(alignment.scale, rigid.rotation, rigid.translation));
    }
  }

  double Error(const Model& model, size_t match) const {
    return SimilarityError(camera_, matches_[match], model);
  }

  // A Gauss-Newton step.
  std::optional<Model> Refine(const Model& model, const std::vector<size_t>& inliers) const {
    Matrix7d hessian = Matrix7d::Zero();
    Vector7d gradient = Vector7d::Zero();
    for (const size_t i : inliers) {
      for (const SimilarityResidual& seen : ResidualsOf(model, i)) {
        hessian.noalias() += seen.jacobian.transpose() * seen.jacobian;
        gradient.noalias() += seen.jacobian.transpose() * seen.residual;
      }
      if (!fix_scale_) {
        const SimilarityDepthResidual depth(matches_[i], model);
        hessian.noalias() += depth.jacobian.transpose() * depth.jacobian;
        gradient.noalias() += depth.jacobian.transpose() * depth.residual;
      }
    }
    Vector7d step = Vector7d::Zero();
    if (fix_scale_) {
      step.head<6>() = hessian.topLeftCorner<6, 6>().ldlt().solve(-gradient.head<6>());
    } else {
      step = hessian.ldlt().solve(-gradient);
    }
    return step.allFinite() ? std::optional(Model(Retract(model.b_from_a, step))) : std::nullopt;
  }

  // Whether the inliers determine rotation and scale.
  bool Determines(const Model& model, const std::vector<size_t>& inliers) const {
    return fix_scale_
               ? internal::DetermineParameters(InformationsOf<6>(model, inliers), {0, 1, 2})
               : internal::DetermineParameters(InformationsOf<7>(model, inliers), {0, 1, 2, 6});
  }

 private:
  // The information of each inlier about the first kSize parameters of Retract.
  template <int kSize>
  std::vector<Eigen::Matrix<double, kSize, kSize>> InformationsOf(
      const Model& model, const std::vector<size_t>& inliers) const {
    std::vector<Eigen::Matrix<double, kSize, kSize>> informations;
    for (const size_t i : inliers) {
      auto& information = informations.emplace_back();
      information.setZero();
      for (const SimilarityResidual& seen : ResidualsOf(model, i)) {
        const auto jacobian = seen.jacobian.leftCols<kSize>();
        information += jacobian.transpose() * jacobian;
      }
      if constexpr (kSize == 7) {
        const SimilarityDepthResidual depth(matches_[i], model);
        information += depth.jacobian.transpose() * depth.jacobian;
      }
    }
    return informations;
  }

  std::array<SimilarityResidual, 2> ResidualsOf(const Model& model, size_t match) const {
    return {SimilarityResidualInA(camera_, matches_[match], model),
            SimilarityResidualInB(camera_, matches_[match], model)};
  }

  const PinholeCamera& camera_;
  bool fix_scale_;
  std::vector<SimilarityMatch> matches_;
  std::vector<size_t> indices_;
};

}  // namespace

Similarity EstimateSimilarity(const PinholeCamera& camera, std::span<const SimilarityMatch> matches,
                              const SimilarityOptions& options) {
  const SimilarityProblem problem(camera, matches, options.fix_scale);
  RansacResult<TwoWaySimilarity> found = Ransac(problem, options.ransac);
  if (found.ok() && !problem.Determines(found.model, found.inliers)) {
    found.failure =
        "the matches do not determine rotation and scale: nearly all points are on one line or far "
        "away";
  }
  Similarity similarity{.b_from_a = found.model.b_from_a,
                        .inliers = {},
                        .score = found.score,
                        .iterations = found.iterations,
                        .failure = std::move(found.failure)};
  for (const size_t match : found.inliers) {
    similarity.inliers.push_back(problem.IndexOf(match));
  }
  return similarity;
}

}  // namespace hullslam
