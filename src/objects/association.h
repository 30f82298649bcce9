// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// What makes a detection one of an object; see AssociateDetections.
struct AssociationOptions {
  double min_outline_iou = 0.25;  // of the hull with the projected quadric
  double min_carried_iou = 0.5;   // of the hull with the last one, carried over at its depth
  int min_shared_landmarks = 3;
  double min_shared_ratio = 0.5;  // of landmarks in the detection
  double class_weight = 0.2;      // of the share of votes for the class in the similarity
  double max_rank_sum = 1.282;    // standard score
  int min_cloud = 20;             // points for the rank-sum test
  double alpha = 0.001;           // of the t-test of centroids
  double centroid_noise = 0.02;   // m
  double max_offset = 1.0;        // between centroids, in sizes of the object
  bool mapped_only = false;       // leave candidates out
};

// For each detection of a frame the object that it shows, invalid for none (Wu et al. 2023): IoU
// with the projected quadric and with the last outline, shared landmarks, rank-sum and t-tests of
// depth points, put together into a similarity; then the assignment of largest total similarity.
// The class is a vote: objects of another class are less similar, not excluded. Clouds that lie too
// far apart exclude a pair. `landmarks` has one entry a keypoint of the frame (or is empty).
std::vector<ObjectId> AssociateDetections(const Map& map, const Sensor& sensor, const Frame& frame,
                                          const Rigid3& cam_from_world,
                                          std::span<const LandmarkId> landmarks,
                                          const AssociationOptions& options);

}  // namespace hullslam
