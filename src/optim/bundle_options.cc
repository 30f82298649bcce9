// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/bundle_options.h"

#include <algorithm>

namespace hullslam {

BundleOptions BundleOptions::ForWholeMap() const {
  BundleOptions options = *this;
  options.robust_iterations = 20;
  options.final_iterations = 40;
  options.function_tolerance = 1e-6;
  // Parts of the map may move by much more than the size of an object, together with their objects.
  // A tight prior on the positions of the objects would hold these parts back.
  constexpr double kLoose = 20.0;
  ObjectConstraintOptions& constraint = options.objects.constraint;
  for (QuadricPriorSigmas* const prior : {&constraint.prior, &constraint.prior_without_depth}) {
    prior->center *= kLoose;
    prior->rotation *= kLoose;
  }
  return options;
}

BundleOptions BundleOptions::ForMonocular() const {
  BundleOptions options = *this;
  options.robust_iterations = std::max(robust_iterations, 10);
  options.final_iterations = std::max(final_iterations, 20);
  options.function_tolerance = std::min(function_tolerance, 1e-6);
  options.follow.steps = std::max(follow.steps, 10);
  options.follow.worthwhile = std::min(follow.worthwhile, 1e-6);
  return options;
}

}  // namespace hullslam
