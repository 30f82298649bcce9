// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "estimators/two_views.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The squared distance of a pair from the nearest pair that agrees exactly with the motion, divided
// by its variance, to first order (Sampson 1982). With correct pairs and sigmas its mean is 1.
double SampsonError(const PinholeCamera& camera, const Rigid3& b_from_a, const PixelPair& pair);

// A robust cost of a pair. It grows with the error and stays below kMaxPairCost: e / (1 + e /
// kMaxPairCost) (Geman and McClure 1987). `noise` is the true sigma of keypoints divided by the
// sigma of the pairs.
inline constexpr double kMaxPairCost = 9.0;
double PairCost(const PinholeCamera& camera, const Rigid3& b_from_a, const PixelPair& pair,
                double noise);

// Moves a motion to the nearest minimum of the sum of its pairs' costs. The translation must not be
// zero; that of the result has length 1.
Rigid3 RefineMotion(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                    const Rigid3& b_from_a, double noise);

}  // namespace hullslam
