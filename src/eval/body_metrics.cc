// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/body_metrics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "geometry/assignment.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFarthestPair =
    0.5;  // distance of the centres of a pair, in sizes of the true body

Vector3d SortedByLength(Vector3d axes) {
  std::sort(axes.begin(), axes.end(), std::greater<>());
  return axes;
}

double DistanceInSizes(const TrueBody& truth, const MappedBody& mapped) {
  return (truth.body.world_from_body.translation - mapped.body.world_from_body.translation).norm() /
         truth.body.Size();
}

// Calls `use` with each of the 24 rotations that map axes to axes.
void ForEachAxisRotation(const std::function<void(const Matrix3d&)>& use) {
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d rotation = Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) {
        rotation(order[static_cast<size_t>(i)], i) = (signs >> i) % 2 == 0 ? 1.0 : -1.0;
      }
      if (rotation.determinant() > 0.0) {
        use(rotation);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

// The rotation of least angle from the axes of the true body to the mapped ones.
struct AxisMatch {
  double turn = 0.0;                // BodyError::turn
  Matrix3d mapped_from_truth_axes;  // a permutation with signs
};

AxisMatch MatchAxes(const Matrix3d& truth_from_mapped, std::optional<int> round_axis) {
  AxisMatch best;
  std::pair<double, double> least(HUGE_VAL, HUGE_VAL);
  ForEachAxisRotation([&](const Matrix3d& permutation) {
    const Matrix3d rotation = truth_from_mapped * permutation;
    const double all = Eigen::AngleAxisd(rotation).angle();
    const double turn =
        round_axis ? std::acos(std::min(1.0, std::abs(rotation(*round_axis, *round_axis)))) : all;
    if (std::pair(turn, all) < least) {
      least = {turn, all};
      best = {turn, permutation};
    }
  });
  return best;
}

std::optional<double> MedianOf(std::vector<double> values) {
  if (values.empty()) {
    return std::nullopt;
  }
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::optional<double> MeanOf(const std::vector<double>& values) {
  return values.empty() ? std::nullopt
                        : std::optional(std::accumulate(values.begin(), values.end(), 0.0) /
                                        static_cast<double>(values.size()));
}

// BodyScore::average_precision of bodies in the order of their confidence.
double AveragePrecision(const std::vector<bool>& is_right, size_t truths) {
  std::vector<double> precisions;  // at each right one
  size_t right = 0;
  for (size_t i = 0; i < is_right.size(); ++i) {
    if (is_right[i]) {
      precisions.push_back(static_cast<double>(++right) / static_cast<double>(i + 1));
    }
  }
  double sum = 0.0;
  double largest = 0.0;
  for (size_t i = precisions.size(); i-- > 0;) {
    largest = std::max(largest, precisions[i]);
    sum += largest;
  }
  return sum / static_cast<double>(truths);
}

Eigen::MatrixXd OverlapsOf(const std::vector<TrueBody>& truths,
                           const std::vector<MappedBody>& mapped,
                           double (*overlap)(const Body&, const Body&)) {
  Eigen::MatrixXd overlaps(mapped.size(), truths.size());
  for (size_t i = 0; i < mapped.size(); ++i) {
    for (size_t j = 0; j < truths.size(); ++j) {
      overlaps(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          overlap(truths[j].body, mapped[i].body);
    }
  }
  return overlaps;
}

// The overlaps of pairs of one class; those of other pairs are 0.
Eigen::MatrixXd OfOneClass(Eigen::MatrixXd overlaps, const BodyEvaluation& evaluation) {
  for (size_t i = 0; i < evaluation.mapped.size(); ++i) {
    for (size_t j = 0; j < evaluation.truths.size(); ++j) {
      if (evaluation.mapped[i].label != evaluation.truths[j].label) {
        overlaps(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0.0;
      }
    }
  }
  return overlaps;
}

std::array<BodyScore, 2> ScoreBoth(const Eigen::MatrixXd& overlaps,
                                   const std::vector<TrueBody>& truths) {
  return {ScoreBodies(overlaps, truths, 0.25), ScoreBodies(overlaps, truths, 0.5)};
}

void PairBodies(BodyEvaluation& evaluation) {
  const std::vector<TrueBody>& truths = evaluation.truths;
  const std::vector<MappedBody>& mapped = evaluation.mapped;
  Eigen::MatrixXd distances(truths.size(), mapped.size());
  for (size_t i = 0; i < truths.size(); ++i) {
    for (size_t j = 0; j < mapped.size(); ++j) {
      distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          DistanceInSizes(truths[i], mapped[j]);
    }
  }
  const std::vector<int> pairs = AssignMinimumCost(distances, kFarthestPair);
  std::vector<bool> is_paired(mapped.size(), false);
  for (size_t i = 0; i < truths.size(); ++i) {
    if (pairs[i] >= 0) {
      const auto j = static_cast<size_t>(pairs[i]);
      is_paired[j] = true;
      if (truths[i].is_counted) {
        evaluation.errors.push_back(CompareBodies(truths[i], mapped[j]));
        evaluation.errors.back().truth = i;
        evaluation.errors.back().mapped = j;
      }
    } else if (truths[i].is_counted) {
      evaluation.missed.push_back(i);
    }
  }
  for (size_t j = 0; j < mapped.size(); ++j) {
    if (!is_paired[j]) {
      const bool is_near = std::ranges::any_of(truths, [&](const TrueBody& truth) {
        return DistanceInSizes(truth, mapped[j]) < kFarthestPair;
      });
      (is_near ? evaluation.duplicates : evaluation.false_ones).push_back(j);
    }
  }
}

}  // namespace

std::vector<MappedBody> MappedBodies(const ObjectResults& report, const Sim3& truth_from_map) {
  std::vector<MappedBody> bodies;
  for (const ObjectResult& object : report.objects) {
    if (object.state != ObjectState::kMapped) {
      continue;
    }
    const Ellipsoid ellipsoid = truth_from_map * object.ellipsoid;
    MappedBody& body = bodies.emplace_back(
        MappedBody{object.id,
                   object.label,
                   {BodyKind::kEllipsoid, ellipsoid.world_from_object, ellipsoid.half_axes},
                   object.observations.size()});
    for (const ObservationResult& view : object.observations) {
      const Vector3d eye = Inverse(view.cam_from_world).translation;
      const Vector3d direction =
          truth_from_map.rotation *
          (object.ellipsoid.world_from_object.translation - eye).normalized();
      body.sight += direction * direction.transpose() / static_cast<double>(body.views);
    }
  }
  std::stable_sort(bodies.begin(), bodies.end(), [](const MappedBody& a, const MappedBody& b) {
    return std::pair(b.views, a.id) < std::pair(a.views, b.id);
  });
  return bodies;
}

BodyScore ScoreBodies(const Eigen::MatrixXd& overlaps, const std::vector<TrueBody>& truths,
                      double least) {
  Check(overlaps.cols() == static_cast<Eigen::Index>(truths.size()), "one column for each truth");
  BodyScore score;
  score.least = least;
  std::vector<bool> is_free;
  for (const TrueBody& truth : truths) {
    is_free.push_back(truth.is_counted);
    score.truths += truth.is_counted ? 1 : 0;
  }
  std::vector<bool> is_right;
  for (Eigen::Index row = 0; row < overlaps.rows(); ++row) {
    std::optional<size_t> best;
    bool is_ignored = false;
    for (size_t j = 0; j < truths.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      if (overlaps(row, column) < least) {
        continue;
      }
      is_ignored = is_ignored || !truths[j].is_counted;
      if (is_free[j] &&
          (!best || overlaps(row, column) > overlaps(row, static_cast<Eigen::Index>(*best)))) {
        best = j;
      }
    }
    if (best) {
      is_free[*best] = false;
    }
    if (best || !is_ignored) {
      is_right.push_back(best.has_value());
      score.right += best ? 1 : 0;
    }
  }
  score.predictions = is_right.size();
  if (score.predictions > 0) {
    score.precision = static_cast<double>(score.right) / static_cast<double>(score.predictions);
  }
  if (score.truths > 0) {
    score.recall = static_cast<double>(score.right) / static_cast<double>(score.truths);
    score.average_precision = AveragePrecision(is_right, score.truths);
  }
  return score;
}

BodyError CompareBodies(const TrueBody& truth, const MappedBody& mapped) {
  BodyError error;
  error.box_overlap = BoxOverlap(truth.body, mapped.body);
  error.solid_overlap = SolidOverlap(truth.body, mapped.body);
  error.center_m =
      (truth.body.world_from_body.translation - mapped.body.world_from_body.translation).norm();
  const Vector3d& half_axes = truth.body.half_axes;
  error.sorted_axes =
      SortedByLength(mapped.body.half_axes).cwiseQuotient(SortedByLength(half_axes)).array() - 1.0;
  const Matrix3d world_from_truth = truth.body.world_from_body.rotation.toRotationMatrix();
  const auto round_axes = std::ranges::count(truth.is_round, true);
  const auto first_round = std::ranges::find(truth.is_round, true) - truth.is_round.begin();
  const AxisMatch match = MatchAxes(
      world_from_truth.transpose() * mapped.body.world_from_body.rotation.toRotationMatrix(),
      round_axes == 1 ? std::optional(static_cast<int>(first_round)) : std::nullopt);
  const Vector3d along =
      match.mapped_from_truth_axes.cwiseAbs().transpose() * mapped.body.half_axes;
  error.along_axes = along.cwiseQuotient(half_axes).array() - 1.0;
  error.sight = (world_from_truth.transpose() * mapped.sight * world_from_truth).diagonal();
  error.turn = round_axes > 1 ? std::nullopt : std::optional(match.turn);
  return error;
}

BodyErrors SummarizeBodyErrors(const std::vector<BodyError>& errors) {
  std::vector<double> boxes, solids, centers, sizes, towards, across, turns;
  std::array<std::vector<double>, 3> sorted;
  for (const BodyError& error : errors) {
    boxes.push_back(error.box_overlap);
    solids.push_back(error.solid_overlap);
    centers.push_back(error.center_m);
    Eigen::Index nearest = 0;
    error.sight.maxCoeff(&nearest);
    for (Eigen::Index i = 0; i < 3; ++i) {
      sorted[static_cast<size_t>(i)].push_back(error.sorted_axes[i]);
      sizes.push_back(std::abs(error.sorted_axes[i]));
      (i == nearest ? towards : across).push_back(error.along_axes[i]);
    }
    if (error.turn) {
      turns.push_back(*error.turn);
    }
  }
  return {errors.size(),
          MeanOf(boxes),
          MeanOf(solids),
          MedianOf(centers),
          {MedianOf(sorted[0]), MedianOf(sorted[1]), MedianOf(sorted[2])},
          MedianOf(sizes),
          MeanOf(sizes),
          MedianOf(towards),
          MedianOf(across),
          MedianOf(turns)};
}

BodyEvaluation EvaluateBodies(std::vector<TrueBody> truths, std::vector<MappedBody> mapped) {
  BodyEvaluation evaluation;
  evaluation.truths = std::move(truths);
  evaluation.mapped = std::move(mapped);
  const Eigen::MatrixXd boxes = OverlapsOf(evaluation.truths, evaluation.mapped, BoxOverlap);
  const Eigen::MatrixXd solids = OverlapsOf(evaluation.truths, evaluation.mapped, SolidOverlap);
  evaluation.boxes = ScoreBoth(boxes, evaluation.truths);
  evaluation.solids = ScoreBoth(solids, evaluation.truths);
  evaluation.boxes_of_class = ScoreBoth(OfOneClass(boxes, evaluation), evaluation.truths);
  evaluation.solids_of_class = ScoreBoth(OfOneClass(solids, evaluation), evaluation.truths);
  evaluation.have_common_class =
      evaluation.mapped.empty() ||
      std::ranges::any_of(evaluation.mapped, [&](const MappedBody& body) {
        return std::ranges::find(evaluation.truths, body.label, &TrueBody::label) !=
               evaluation.truths.end();
      });
  PairBodies(evaluation);
  return evaluation;
}

std::map<std::string, BodyErrors> ErrorsByShape(const BodyEvaluation& evaluation) {
  std::map<std::string, std::vector<BodyError>> groups;
  for (const BodyError& error : evaluation.errors) {
    groups[evaluation.truths[error.truth].shape].push_back(error);
  }
  std::map<std::string, BodyErrors> shapes;
  for (const auto& [shape, errors] : groups) {
    shapes[shape] = SummarizeBodyErrors(errors);
  }
  return shapes;
}

}  // namespace hullslam
