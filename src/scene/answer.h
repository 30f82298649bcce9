// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scene/question.h"
#include "scene/scene.h"

namespace hullslam {

struct Answer {
  ObjectId object;
  double score = 0.0;  // 0 to 1
  std::string reason;
};

// An answer with a lower score is none.
inline constexpr double kLeastScore = 0.1;

// All functions return the answers in the order of the score; ties are in the order of the ids.

// The objects that fit a question. The score is the share of the class in the object's votes times
// that of each condition: the best object on its other side, times the strength of the relation. A
// relation that the scene has has the strength 1. "near" has the strength 1 / (1 + (d / s)^2), with
// the distance d of the surfaces and the mean extent s of both objects. Without the relation
// "beside", "next to" has half of this strength. Throws InputError for an
// object that the scene does not have, and for a question about what stands on what if the upward
// direction is not known.
std::vector<Answer> AnswerQuestion(const Scene& scene, const AskedThing& question);

// The objects of a class whose surface is within `distance` of an object's surface, m: the nearest
// first. Without labels, of all classes. The score falls with the distance, from the share of the
// class to kLeastScore of it.
std::vector<Answer> FindWithin(const Scene& scene, const std::set<std::string>& labels,
                               double distance, ObjectId of);

// The objects that are most like another one, by class and size: the common share of their votes
// times exp(-mean difference of the logarithms of their sorted half axes).
std::vector<Answer> FindLike(const Scene& scene, ObjectId id);

// The objects whose vector has the smallest angle to another vector of the same network. The score
// is the cosine of the angle; objects with none above 0 are no answers. Throws InputError if no
// object has a vector, or if the vectors have another length.
std::vector<Answer> FindByEmbedding(const Scene& scene, std::span<const float> embedding);

}  // namespace hullslam
