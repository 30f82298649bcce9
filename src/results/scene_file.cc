// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/scene_file.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "results/json_text.h"

namespace hullslam {
namespace {

constexpr double kSceneUnit = 1e-9;      // metres and shares
constexpr double kVarianceUnit = 1e-12;  // m^2

using SceneJson = nlohmann::ordered_json;

SceneJson VectorJson(const Eigen::VectorXd& values) {
  SceneJson json = SceneJson::array();
  for (const double value : values) {
    json.push_back(Rounded(value, kSceneUnit));
  }
  return json;
}

SceneJson MatrixJson(const Eigen::Matrix3d& matrix) {
  SceneJson rows = SceneJson::array();
  for (const auto& row : matrix.rowwise()) {
    rows.push_back({Rounded(row[0], kVarianceUnit), Rounded(row[1], kVarianceUnit),
                    Rounded(row[2], kVarianceUnit)});
  }
  return rows;
}

SceneJson BoxJson(const std::optional<UprightBox>& box) {
  if (!box) {
    return nullptr;
  }
  return {{"centre", VectorJson(box->world_from_box.translation)},
          {"half_extents", VectorJson(box->half_extents)},
          {"rotation", VectorJson(box->world_from_box.rotation.coeffs())},
          {"sides_seen", box->is_seen}};
}

// The axes with a property, by their names; null if it is not known.
SceneJson AxesJson(const SceneObject& object, bool FreeAxis::*property) {
  if (!object.covariance) {
    return nullptr;
  }
  SceneJson names = SceneJson::array();
  for (size_t i = 0; i < object.covariance->axes.size(); ++i) {
    if (object.covariance->axes[i].*property) {
      names.push_back(std::string(1, static_cast<char>('x' + i)));
    }
  }
  return names;
}

}  // namespace

nlohmann::ordered_json BodyJson(const SceneObject& object) {
  return {{"box", BoxJson(object.box)},
          {"round_axes", AxesJson(object, &FreeAxis::is_round)},
          {"undetermined_axes", AxesJson(object, &FreeAxis::is_undetermined)}};
}

namespace {

SceneJson SceneObjectJson(const SceneObject& object) {
  SceneJson shares = SceneJson::object();
  for (const auto& [label, share] : object.shares) {
    shares[label] = Rounded(share, kSceneUnit);
  }
  const auto& covariance = object.covariance;
  SceneJson json = {
      {"id", object.id.value},
      {"class", object.label},
      {"class_distribution", shares},
      {"centre", VectorJson(object.ellipsoid.world_from_object.translation)},
      {"axes", VectorJson(object.ellipsoid.half_axes)},
      {"rotation", VectorJson(object.ellipsoid.world_from_object.rotation.coeffs())},
      {"centre_covariance", covariance ? MatrixJson(covariance->center) : SceneJson(nullptr)},
      {"axes_covariance", covariance ? MatrixJson(covariance->half_axes) : SceneJson(nullptr)},
      {"times_seen", object.observations},
      {"first_seen", Rounded(object.first_seen, kSceneUnit)},
      {"last_seen", Rounded(object.last_seen, kSceneUnit)},
      {"quality", Rounded(object.quality, kSceneUnit)}};
  json.update(BodyJson(object));
  if (!object.embedding.empty()) {
    const Eigen::Map<const Eigen::VectorXf> embedding(
        object.embedding.data(), static_cast<Eigen::Index>(object.embedding.size()));
    json["vector"] = VectorJson(embedding.cast<double>());
  }
  return json;
}

SceneJson RelationJson(const Relation& relation) {
  SceneJson evidence = SceneJson::object();
  for (const auto& [name, value] : relation.evidence) {
    evidence[name] = Rounded(value, kSceneUnit);
  }
  return {{"subject", relation.subject.value},
          {"relation", std::string(ToString(relation.kind))},
          {"object", relation.object.value},
          {"evidence", evidence}};
}

SceneJson SurfaceJson(const Surface& surface) {
  SceneJson ids = SceneJson::array();
  for (const ObjectId id : surface.objects) {
    ids.push_back(id.value);
  }
  return {{"height", Rounded(surface.height, kSceneUnit)},
          {"lowest", surface.is_lowest},
          {"objects", ids}};
}

// A member whose entries are each on a line of their own.
template <typename Entries, typename ToEntry>
std::string List(const char* name, const Entries& entries, const ToEntry& to_entry) {
  std::string text = std::string(",\n\"") + name + "\":[";
  for (const auto& entry : entries) {
    text += (&entry == &entries.front() ? "\n " : ",\n ") + DumpLine(to_entry(entry));
  }
  return text + "]";
}

}  // namespace

std::string FormatScene(const Scene& scene) {
  const SceneJson head = {{"version", kSceneFileVersion},
                          {"up", scene.up ? VectorJson(*scene.up) : SceneJson(nullptr)},
                          {"up_from", scene.up_from}};
  std::string text = DumpLine(head);
  text.pop_back();
  text += List("objects", scene.objects, SceneObjectJson);
  text += List("relations", scene.relations, RelationJson);
  text += List("surfaces", scene.surfaces, SurfaceJson);
  return text + ",\n\"places\":[]}\n";
}

}  // namespace hullslam
