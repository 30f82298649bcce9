// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/comparison/association_measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "costs/comparison/quadric_distribution.h"
#include "geometry/polygon.h"

namespace hullslam {
namespace {

struct Measure {
  std::string_view name;
  SimilarityFunction* function;
};

// In the order of the enumerators.
constexpr std::array kMeasures = {Measure{"combined", nullptr},
                                  Measure{"class_overlap", &ClassOverlap},
                                  Measure{"wasserstein", &WassersteinSimilarity}};

double BoxOverlapWithProjected(const MatchEvidence& evidence) {
  return evidence.projected
             ? IntersectionOverUnion(evidence.projected->Bounds(), evidence.detection.box)
             : 0.0;
}

double BoxOverlapWithCarried(const MatchEvidence& evidence) {
  double overlap = 0.0;
  for (const std::vector<Eigen::Vector2d>& hull : evidence.carried) {
    if (!hull.empty()) {
      overlap = std::max(overlap, IntersectionOverUnion(BoundingBox(hull), evidence.detection.box));
    }
  }
  return overlap;
}

double AtLeast(double least, double value) { return value >= least ? value : 0.0; }

// The measured ellipse or, for detections without one, the ellipse in the box.
Ellipse MeasuredEllipse(const Detection& detection) {
  if (detection.ellipse) {
    return *detection.ellipse;
  }
  const Eigen::Vector2d half = 0.5 * detection.box.sizes();
  return {.center = detection.box.center(), .shape = half.cwiseProduct(half).asDiagonal()};
}

}  // namespace

SimilarityFunction* FunctionOf(AssociationMeasure measure) {
  return kMeasures.at(static_cast<size_t>(measure)).function;
}

std::vector<std::string> AssociationMeasureNames() {
  std::vector<std::string> names;
  for (const Measure& measure : kMeasures) {
    names.emplace_back(measure.name);
  }
  return names;
}

double ClassOverlap(const MatchEvidence& evidence) {
  constexpr double kLeastProjected = 0.3;
  constexpr double kLeastCarried = 0.2;
  constexpr size_t kManyLandmarks = 10;
  constexpr double kCertain = 2.0;  // more than any IoU
  if (evidence.detection.label != evidence.object.Label()) {
    return 0.0;
  }
  if (evidence.shared_landmarks > kManyLandmarks) {
    return kCertain;
  }
  return std::max(AtLeast(kLeastProjected, BoxOverlapWithProjected(evidence)),
                  AtLeast(kLeastCarried, BoxOverlapWithCarried(evidence)));
}

double WassersteinSimilarity(const MatchEvidence& evidence) {
  constexpr double kScale = 10.0;  // px
  constexpr double kLeastSimilarity = 1e-5;
  constexpr double kLeastOverlap = 0.01;
  constexpr double kLeastCarried = 0.3;
  if (!evidence.projected) {
    return AtLeast(kLeastCarried, BoxOverlapWithCarried(evidence));
  }
  if (BoxOverlapWithProjected(evidence) <= kLeastOverlap) {
    return 0.0;
  }
  const double square =
      SquaredWasserstein(*evidence.projected, MeasuredEllipse(evidence.detection));
  return AtLeast(kLeastSimilarity, std::exp(-std::sqrt(std::max(0.0, square)) / kScale));
}

}  // namespace hullslam
