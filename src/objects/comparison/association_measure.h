// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/detection.h"
#include "hullslam/map/object_landmark.h"
#include "hullslam/objects/object_options.h"

namespace hullslam {

// The input of a comparison of a detection and an object. The references must outlive this struct.
struct MatchEvidence {
  const Detection& detection;
  const ObjectLandmark& object;
  const std::optional<Ellipse>& projected;  // of the object's quadric; absent without a shape
  // The object's last hull, moved to the pose of the frame. More than one if its depth is unknown.
  std::span<const std::vector<Eigen::Vector2d>> carried;
  size_t shared_landmarks = 0;
};

// The similarity of a detection and an object; 0 if they do not match.
using SimilarityFunction = double(const MatchEvidence& evidence);

// The function of a measure; null for kCombined: CombinedSimilarity().
SimilarityFunction* FunctionOf(AssociationMeasure measure);

// The names in settings files, in the order of the enumerators: combined, class_overlap,
// wasserstein.
std::vector<std::string> AssociationMeasureNames();

// `class_overlap` (OA-SLAM, Zins et al. 2022, and Tracking.cc of the released code): only an object
// whose class is that of the detection matches. The similarity is the IoU of the detection's box
// with that of the projected ellipse, if it is at least 0.3, or with that of the last hull, if it
// is at least 0.2; the larger one counts. With more than ten common landmarks they match before all
// others. (OA-SLAM does not move the last box to the new pose.)
double ClassOverlap(const MatchEvidence& evidence);

// `wasserstein` (VOOM, Wang et al. 2024, and MatchObjectsWasserDistance of the released
// ObjectMatcher.cc): the normalised distance exp(-W / 10 px) of the projected and the measured
// ellipse, where W is the Wasserstein distance. It must be more than 1e-5, and the IoU of the two
// boxes more than 0.01. The class does not count. A candidate without a quadric is compared by the
// box of its last hull, with an IoU of at least 0.3.
double WassersteinSimilarity(const MatchEvidence& evidence);

}  // namespace hullslam
