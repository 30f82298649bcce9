// SPDX-License-Identifier: GPL-3.0-or-later
// The readers of results/object_file.h.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "camera/wide_lens.h"
#include "files/json_file.h"
#include "files/plausible.h"
#include "geometry/polygon.h"
#include "hullslam/util/error.h"
#include "results/json_text.h"
#include "results/object_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr const char* kObservationsFile = "objects_observations.json";

double NumberOrZero(const JsonNode& node, const char* key) {
  return node.Has(key) ? node.At(key).Number() : 0.0;
}

PinholeCamera ReadCamera(const JsonNode& node) {
  PinholeCamera camera;
  camera.fx = node.At("fx").PositiveNumber(kMostPixels);
  camera.fy = node.At("fy").PositiveNumber(kMostPixels);
  camera.cx = node.At("cx").Number(kMostPixels);
  camera.cy = node.At("cy").Number(kMostPixels);
  camera.k1 = node.At("k1").Number();
  camera.k2 = node.At("k2").Number();
  camera.p1 = node.At("p1").Number();
  camera.p2 = node.At("p2").Number();
  camera.k3 = node.At("k3").Number();
  camera.k4 = NumberOrZero(node, "k4");
  camera.k5 = NumberOrZero(node, "k5");
  camera.k6 = NumberOrZero(node, "k6");
  if (node.Has("type")) {
    const WideModel* const model = FindWideModel(node.At("type").Text());
    if (model == nullptr) {
      node.At("type").Fail(fmt::format("one of {}", fmt::join(LensTypes(), ", ")));
    }
    camera.lens = model->lens;
    for (const LensCoefficient& one : model->coefficients) {
      camera.*one.field = NumberOrZero(node, std::string(one.name).c_str());
    }
  }
  camera.bf = node.At("bf").PositiveNumber(kMostPixels);
  constexpr uint32_t kLargest = 16384;
  const auto size = [&](const char* key) {
    const uint32_t value = node.At(key).Count();
    if (value == 0 || value > kLargest) {
      node.At(key).Fail("an integer from 1 to 16384");
    }
    return static_cast<int>(value);
  };
  camera.width = size("width");
  camera.height = size("height");
  if (const std::string fault = camera.FindFault(); !fault.empty()) {
    node.Fail("a camera; " + fault);
  }
  return camera;
}

std::vector<SilhouetteLine> ReadLines(const JsonNode& node) {
  constexpr double kTolerance = 1e-3;
  std::vector<SilhouetteLine> lines;
  for (const JsonNode& entry : node.Elements()) {
    const std::vector<double> values = entry.Numbers(4);
    const Eigen::Vector2d normal(values[0], values[1]);
    if (!(std::abs(normal.norm() - 1.0) <= kTolerance && std::abs(values[2]) <= kMostPixels)) {
      entry.Fail("nx, ny of unit length, then c and 1 or 0");
    }
    lines.push_back({{normal.normalized(), values[2]}, values[3] != 0.0});
  }
  return lines;
}

ObservationResult ReadObservation(const JsonNode& node) {
  ObservationResult observation;
  observation.keyframe = KeyframeId(node.At("keyframe").Count());
  observation.timestamp = node.At("timestamp").Number(kMostSeconds);
  observation.cam_from_world = PoseOf(node.At("cam_from_world"));
  observation.label = node.At("class").Text();
  observation.score = node.At("score").Number(1.0);
  observation.is_cut = node.At("cut").Flag();
  observation.is_box = node.At("box").Flag();
  observation.hull = node.At("hull").Points();
  if (observation.hull.size() < 3 || !(SignedArea(observation.hull) > 0.0)) {
    node.At("hull").Fail("three corners or more in the order of positive area");
  }
  observation.contour = node.At("contour").Points();
  observation.lines = ReadLines(node.At("lines"));
  return observation;
}

ObjectState ReadState(const JsonNode& node) {
  const std::string state = node.Text();
  if (state != "mapped" && state != "candidate") {
    node.Fail("\"mapped\" or \"candidate\"");
  }
  return state == "mapped" ? ObjectState::kMapped : ObjectState::kCandidate;
}

std::map<std::string, double> ReadVotes(const JsonNode& node) {
  constexpr double kMostVotes = 1e9;
  std::map<std::string, double> votes;
  for (const auto& [label, score] : node.Members()) {
    votes[Printable(label)] += score.Number(kMostVotes);
  }
  return votes;
}

std::optional<double> ReadOptional(const JsonNode& node, const char* key, double most) {
  return node.Has(key) ? std::optional(node.At(key).Number(most)) : std::nullopt;
}

ObjectResult ReadObject(const JsonNode& node) {
  ObjectResult object;
  object.id = ObjectId(node.At("id").Count());
  object.state = ReadState(node.At("state"));
  object.label = node.At("class").Text();
  object.votes = ReadVotes(node.At("votes"));
  object.ellipsoid.world_from_object = PoseOf(node.At("world_from_object"));
  object.ellipsoid.half_axes = node.At("half_axes").Lengths();
  object.misfit_px = node.At("misfit_px").Number(kMostPixels);
  object.fit.siou = ReadOptional(node, "siou", 1.0);
  object.fit.siou_mask = ReadOptional(node, "siou_mask", 1.0);
  object.fit.mtd_m2 = ReadOptional(node, "mtd_m2", kMostMetres);
  object.fit.tangent_px = ReadOptional(node, "tangent_px", kMostPixels);
  object.name = node.Has("name") ? node.At("name").Text() : "";
  object.is_locked = node.Has("locked") && node.At("locked").Flag();
  object.known_size = ReadOptional(node, "known_size", kMostMetres).value_or(0.0);
  return object;
}

std::optional<LocatedObject> ReadLocatedObject(const JsonNode& node, const char* key) {
  if (!node.Has(key)) {
    return std::nullopt;
  }
  const JsonNode located = node.At(key);
  return LocatedObject{
      ObjectId(located.At("object").Count()),
      {PoseOf(located.At("world_from_object")), located.At("half_axes").Lengths()}};
}

ObjectChange ReadChange(const JsonNode& node) {
  const std::string name = node.Text();
  for (const ObjectChange change : kObjectChanges) {
    if (ToString(change) == name) {
      return change;
    }
  }
  node.Fail("seen_again, moved, gone, new, not_seen or first_seen");
}

// Null in the file of a run without a map of earlier sessions.
std::optional<std::vector<ChangedObject>> ReadChanges(const JsonNode& top) {
  if (!top.Has("changes")) {
    return std::nullopt;
  }
  std::vector<ChangedObject> changes;
  for (const JsonNode& node : top.At("changes").Elements()) {
    changes.push_back({.change = ReadChange(node.At("change")),
                       .label = node.At("class").Text(),
                       .now = ReadLocatedObject(node, "now"),
                       .former = ReadLocatedObject(node, "former"),
                       .expected = static_cast<int>(node.At("expected").Count()),
                       .found = static_cast<int>(node.At("found").Count())});
  }
  return changes;
}

void CheckVersion(const JsonNode& top) {
  if (top.At("version").Count() != kObjectFileVersion) {
    top.At("version").Fail("2, which this version of HullSLAM writes");
  }
}

// Adds the observations to their objects, which must have `counts` observations.
void ReadObservations(const std::filesystem::path& path, const std::vector<uint32_t>& counts,
                      ObjectResults& report) {
  const nlohmann::json json = ReadJson(path);
  const JsonNode top(path, json);
  CheckVersion(top);
  std::map<uint32_t, ObjectResult*> objects;
  for (ObjectResult& object : report.objects) {
    objects[object.id.value] = &object;
  }
  for (const JsonNode& observation : top.At("observations").Elements()) {
    const auto object = objects.find(observation.At("object").Count());
    if (object == objects.end()) {
      observation.At("object").Fail("the id of an object in objects.json");
    }
    object->second->observations.push_back(ReadObservation(observation));
  }
  for (size_t i = 0; i < counts.size(); ++i) {
    const ObjectResult& object = report.objects[i];
    if (object.observations.size() != counts[i]) {
      throw InputError(fmt::format(
          "{}: has {} observations of object {}, expected {} as in objects.json; both files must "
          "be of the same run",
          path.string(), object.observations.size(), object.id.value, counts[i]));
    }
  }
}

}  // namespace

ObjectResults ReadObjects(const std::filesystem::path& path,
                          const std::filesystem::path& observations) {
  const nlohmann::json json = ReadJson(path);
  const JsonNode top(path, json);
  CheckVersion(top);
  ObjectResults report;
  report.sequence = top.At("sequence").Text();
  report.camera = ReadCamera(top.At("camera"));
  report.candidates = top.At("candidates").Count();
  report.changes = ReadChanges(top);
  std::vector<uint32_t> counts;
  for (const JsonNode& object : top.At("objects").Elements()) {
    report.objects.push_back(ReadObject(object));
    counts.push_back(object.At("observations").Count());
  }
  ReadObservations(observations, counts, report);
  return report;
}

ObjectResults ReadObjects(const std::filesystem::path& path) {
  return ReadObjects(path, path.parent_path() / kObservationsFile);
}

}  // namespace hullslam
