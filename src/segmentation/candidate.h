// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace hullslam {

// An instance that a network proposes, in px of its input (the coordinates of Letterbox).
struct Candidate {
  Eigen::Array2d least;     // upper left corner of the box
  Eigen::Array2d greatest;  // lower right corner
  double score = 0.0;       // 0 to 1
  int class_number = 0;
  Eigen::VectorXf coefficients = {};  // of the mask prototypes
};

// The candidates that a decoder gives: they have at least this score and a class that is asked for.
struct CandidateFilter {
  double min_score = 0.0;
  std::vector<bool> classes = {};  // by number

  bool Accepts(double score, int class_number) const {
    return score >= min_score && classes[static_cast<size_t>(class_number)];
  }
};

inline double Sigmoid(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

// Non-maximum suppression: keeps the candidates, best score first, whose box overlaps the box of no
// better one of the same class by more than kMostOverlap (intersection over union), and at most
// kMostInstances of them. Ties go to the first.
inline constexpr double kMostOverlap = 0.7;    // as networks of YOLO are evaluated
inline constexpr size_t kMostInstances = 300;  // in an image; COCO's evaluation counts 100
std::vector<Candidate> SuppressOverlaps(std::vector<Candidate> candidates);

}  // namespace hullslam
