// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "hullslam/util/error.h"
#include "scene/object_body.h"

namespace hullslam {
namespace {

// How well something holds, and why.
struct Match {
  double score = 0.0;
  std::string reason;
};

std::string NameOf(const SceneObject& object) {
  return fmt::format("{} {}", object.label, object.id.value);
}

std::string TextOf(const Evidence& evidence) {
  std::string text;
  for (const auto& [name, value] : evidence) {
    text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", name, value);
  }
  return text;
}

double Extent(const SceneObject& object) { return 2.0 * object.ellipsoid.half_axes.mean(); }

Match MatchClasses(const SceneObject& object, const std::set<std::string>& labels) {
  double share = 0.0;
  for (const std::string& label : labels) {
    const auto found = object.shares.find(label);
    share += found == object.shares.end() ? 0.0 : found->second;
  }
  return {share, fmt::format("{} ({:.0f} % of the votes)", NameOf(object), 100.0 * share)};
}

// The relation of the scene that an asked relation stands for, and whether it is its inverse.
std::pair<RelationKind, bool> KindOf(AskedRelation relation) {
  switch (relation) {
    case AskedRelation::kOn:
      return {RelationKind::kOn, false};
    case AskedRelation::kUnder:
      return {RelationKind::kOn, true};
    case AskedRelation::kIn:
      return {RelationKind::kIn, false};
    case AskedRelation::kInFrontOf:
      return {RelationKind::kInFrontOf, false};
    case AskedRelation::kBehind:
      return {RelationKind::kInFrontOf, true};
    case AskedRelation::kPartOf:
      return {RelationKind::kPartOf, false};
    case AskedRelation::kHiddenBy:
      return {RelationKind::kHiddenBy, false};
    default:
      return {RelationKind::kBeside, false};
  }
}

Match Near(const SceneObject& a, const SceneObject& b) {
  const double gap = std::max(0.0, EllipsoidGap(a.ellipsoid, b.ellipsoid));
  const double share = gap / (0.5 * (Extent(a) + Extent(b)));
  return {1.0 / (1.0 + share * share), fmt::format("distance {:.3g}", gap)};
}

class Answerer {
 public:
  explicit Answerer(const Scene& scene) : scene_(scene) {}

  // How well an object of the scene is the thing, with all of its conditions.
  Match Fit(const SceneObject& object, const AskedThing& thing) const {
    Match match = FitKind(object, thing);
    for (const AskedCondition& condition : thing.conditions) {
      if (match.score <= 0.0) {
        break;
      }
      const Match best = FitCondition(object, condition);
      match.score *= best.score;
      match.reason += fmt::format(", {} {}", condition.text, best.reason);
    }
    return match;
  }

 private:
  Match FitKind(const SceneObject& object, const AskedThing& thing) const {
    switch (thing.kind) {
      case ThingKind::kClass:
        return MatchClasses(object, thing.labels);
      case ThingKind::kAny:
        return {1.0, NameOf(object)};
      case ThingKind::kObject:
        if (scene_.Find(thing.id) == nullptr) {
          throw InputError(
              fmt::format("object {}: the scene has no object with this number", thing.id.value));
        }
        return {object.id == thing.id ? 1.0 : 0.0, NameOf(object)};
      default:
        throw InputError("'" + thing.text +
                         "' is no object; it can only follow 'on', as in \"thing on the floor\"");
    }
  }

  Match FitCondition(const SceneObject& object, const AskedCondition& condition) const {
    const AskedThing& other = condition.other.front();
    const bool needs_up =
        condition.relation == AskedRelation::kOn || condition.relation == AskedRelation::kUnder ||
        condition.relation == AskedRelation::kIn || condition.relation == AskedRelation::kBeside ||
        condition.relation == AskedRelation::kPartOf;
    if (needs_up && !scene_.up) {
      throw InputError("'" + condition.text + "': the upward direction is " + scene_.up_from);
    }
    if (condition.relation == AskedRelation::kOn &&
        (other.kind == ThingKind::kFloor || other.kind == ThingKind::kSurface)) {
      return StandsOn(object, other.kind == ThingKind::kFloor);
    }
    Match best;
    for (const SceneObject& candidate : scene_.objects) {
      if (candidate.id == object.id) {
        continue;
      }
      const Match related = Relate(object, condition.relation, candidate);
      if (related.score <= best.score) {
        continue;
      }
      const Match fit = Fit(candidate, other);
      if (fit.score * related.score > best.score) {
        best = {fit.score * related.score, fmt::format("{} ({})", fit.reason, related.reason)};
      }
    }
    return best;
  }

  Match StandsOn(const SceneObject& object, bool is_floor) const {
    for (const Surface& surface : scene_.surfaces) {
      if ((!is_floor || surface.is_lowest) &&
          std::binary_search(surface.objects.begin(), surface.objects.end(), object.id)) {
        return {1.0, fmt::format("{} at the height {:.2f} ({} objects)",
                                 surface.is_lowest ? "the lowest surface" : "a surface",
                                 surface.height, surface.objects.size())};
      }
    }
    return {};
  }

  Match Relate(const SceneObject& a, AskedRelation relation, const SceneObject& b) const {
    if (relation == AskedRelation::kNear) {
      return Near(a, b);
    }
    const auto [kind, is_inverse] = KindOf(relation);
    const ObjectId subject = is_inverse ? b.id : a.id;
    const ObjectId object = is_inverse ? a.id : b.id;
    const auto found = std::find_if(
        scene_.relations.begin(), scene_.relations.end(), [&, kind = kind](const Relation& known) {
          return known.subject == subject && known.kind == kind && known.object == object;
        });
    if (found != scene_.relations.end()) {
      return {1.0, TextOf(found->evidence)};
    }
    // Whoever asks for "the book next to the cup" also means one that is a little too far away.
    constexpr double kAlmostBeside = 0.5;
    Match match = relation == AskedRelation::kBeside ? Near(a, b) : Match();
    match.score *= kAlmostBeside;
    return match;
  }

  const Scene& scene_;
};

void SortAnswers(std::vector<Answer>& answers, double least = kLeastScore) {
  std::erase_if(answers, [&](const Answer& answer) { return !(answer.score >= least); });
  std::stable_sort(answers.begin(), answers.end(),
                   [](const Answer& a, const Answer& b) { return a.score > b.score; });
}

const SceneObject& Need(const Scene& scene, ObjectId id) {
  const SceneObject* const object = scene.Find(id);
  if (object == nullptr) {
    throw InputError(fmt::format("object {}: the scene has no object with this number", id.value));
  }
  return *object;
}

// From 0 to 1: how much the classes and the half axes agree.
Match CompareShapes(const SceneObject& a, const SceneObject& b) {
  double common = 0.0;
  for (const auto& [label, share] : a.shares) {
    const auto found = b.shares.find(label);
    common += found == b.shares.end() ? 0.0 : std::min(share, found->second);
  }
  Eigen::Vector3d axes_a = a.ellipsoid.half_axes;
  Eigen::Vector3d axes_b = b.ellipsoid.half_axes;
  std::sort(axes_a.begin(), axes_a.end());
  std::sort(axes_b.begin(), axes_b.end());
  const double ratio = std::exp(-(axes_a.array().log() - axes_b.array().log()).abs().mean());
  return {common * ratio, fmt::format("classes agree to {:.0f} %, sizes to {:.0f} %",
                                      100.0 * common, 100.0 * ratio)};
}

}  // namespace

std::vector<Answer> AnswerQuestion(const Scene& scene, const AskedThing& question) {
  const Answerer answerer(scene);
  std::vector<Answer> answers;
  for (const SceneObject& object : scene.objects) {
    Match match = answerer.Fit(object, question);
    answers.push_back({object.id, match.score, std::move(match.reason)});
  }
  SortAnswers(answers);
  return answers;
}

std::vector<Answer> FindWithin(const Scene& scene, const std::set<std::string>& labels,
                               double distance, ObjectId of) {
  const SceneObject& center = Need(scene, of);
  std::vector<Answer> answers;
  for (const SceneObject& object : scene.objects) {
    const Match match = labels.empty() ? Match{1.0, NameOf(object)} : MatchClasses(object, labels);
    const double gap = std::max(0.0, EllipsoidGap(object.ellipsoid, center.ellipsoid));
    if (object.id != of && gap <= distance) {
      // The farthest object still counts as an answer.
      const double nearness = 1.0 - (1.0 - kLeastScore) * gap / distance;
      answers.push_back({object.id, match.score * nearness,
                         fmt::format("{}, {:.3g} from {}", match.reason, gap, NameOf(center))});
    }
  }
  SortAnswers(answers);
  return answers;
}

std::vector<Answer> FindLike(const Scene& scene, ObjectId id) {
  const SceneObject& wanted = Need(scene, id);
  std::vector<Answer> answers;
  for (const SceneObject& object : scene.objects) {
    if (object.id != id) {
      const Match match = CompareShapes(wanted, object);
      answers.push_back(
          {object.id, match.score, fmt::format("{}: {}", NameOf(object), match.reason)});
    }
  }
  SortAnswers(answers);
  return answers;
}

std::vector<Answer> FindByEmbedding(const Scene& scene, std::span<const float> embedding) {
  const auto as_vector = [](std::span<const float> values) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXf>(values.data(), std::ssize(values)).cast<double>();
  };
  const Eigen::VectorXd wanted = as_vector(embedding).normalized();
  std::vector<Answer> answers;
  for (const SceneObject& object : scene.objects) {
    if (object.embedding.empty()) {
      continue;
    }
    if (object.embedding.size() != embedding.size()) {
      throw InputError(fmt::format("a vector of {} number(s), expected {} as those of the objects",
                                   embedding.size(), object.embedding.size()));
    }
    const double cosine = wanted.dot(as_vector(object.embedding));
    answers.push_back(
        {object.id, cosine, fmt::format("{}: cosine {:.3f}", NameOf(object), cosine)});
  }
  if (answers.empty()) {
    throw InputError(
        "no object has a vector: the masks of the run had no .npy files (docs/masks.md)");
  }
  SortAnswers(answers, std::numeric_limits<double>::min());
  return answers;
}

}  // namespace hullslam
