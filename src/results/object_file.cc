// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/object_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "camera/wide_lens.h"
#include "results/json_text.h"
#include "results/ply_file.h"
#include "results/scene_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPixel = 1e-2;
constexpr double kMetre = 1e-9;
constexpr double kAngle = 1e-4;  // degrees; shares are rounded to the same step

// The rounded value; null if it is not known.
Json RoundedOrNull(const std::optional<double>& value) {
  return value ? Json(Rounded(*value, kMetre)) : Json(nullptr);
}

Json PoseJson(const Rigid3& pose) {
  Json json = Json::array();
  for (const double value : pose.translation) {
    json.push_back(Rounded(value, kMetre));
  }
  for (const double value : pose.rotation.coeffs()) {
    json.push_back(Rounded(value, kMetre));
  }
  return json;
}

// Half axes are larger than 0, so they are not rounded to it. A candidate may be as flat as this.
Json HalfAxesJson(const Eigen::Vector3d& axes) {
  Json json = Json::array();
  for (const double axis : axes) {
    json.push_back(std::max(Rounded(axis, kMetre), kMetre));
  }
  return json;
}

Json PointsJson(const std::vector<Eigen::Vector2d>& points) {
  Json json = Json::array();
  for (const Eigen::Vector2d& point : points) {
    json.push_back({Rounded(point.x(), kPixel), Rounded(point.y(), kPixel)});
  }
  return json;
}

Json LinesJson(const std::vector<SilhouetteLine>& lines) {
  // Across an image of 1000 px this rounding of the normal moves the line by at most 0.001 px.
  constexpr double kNormal = 1e-6;
  constexpr double kOffset = 1e-3;
  Json json = Json::array();
  for (const auto& [line, is_one_sided] : lines) {
    json.push_back({Rounded(line.normal.x(), kNormal), Rounded(line.normal.y(), kNormal),
                    Rounded(line.offset, kOffset), is_one_sided ? 1 : 0});
  }
  return json;
}

Json QuadricJson(const Ellipsoid& ellipsoid) {
  Json rows = Json::array();
  const Eigen::Matrix4d quadric = ellipsoid.DualQuadric();
  for (const auto& row : quadric.rowwise()) {
    Json values = Json::array();
    for (const double value : row) {
      values.push_back(Rounded(value, kMetre));
    }
    rows.push_back(values);
  }
  return rows;
}

Json ToJson(const PinholeCamera& camera) {
  Json json = {{"fx", camera.fx}, {"fy", camera.fy},       {"cx", camera.cx},
               {"cy", camera.cy}, {"k1", camera.k1},       {"k2", camera.k2},
               {"p1", camera.p1}, {"p2", camera.p2},       {"k3", camera.k3},
               {"bf", camera.bf}, {"width", camera.width}, {"height", camera.height}};
  for (const auto& [key, value] :
       {std::pair("k4", camera.k4), std::pair("k5", camera.k5), std::pair("k6", camera.k6)}) {
    if (value != 0.0) {
      json[key] = value;
    }
  }
  if (const WideModel* const model = FindWideModel(camera.lens)) {
    json["type"] = std::string(model->type);
    for (const LensCoefficient& one : model->coefficients) {
      if (const std::string key(one.name); !json.contains(key) && camera.*one.field != 0.0) {
        json[key] = camera.*one.field;
      }
    }
  }
  return json;
}

Json ToJson(ObjectId object, const ObservationResult& observation) {
  return {{"object", object.value},
          {"keyframe", observation.keyframe.value},
          {"timestamp", Rounded(observation.timestamp, kMetre)},
          {"cam_from_world", PoseJson(observation.cam_from_world)},
          {"class", observation.label},
          {"score", Rounded(observation.score, kMetre)},
          {"cut", observation.is_cut},
          {"box", observation.is_box},
          {"hull", PointsJson(observation.hull)},
          {"contour", PointsJson(observation.contour)},
          {"lines", LinesJson(observation.lines)}};
}

// Everything about an object except its observations.
Json ToJson(const ObjectResult& object) {
  Json votes = Json::object();
  for (const auto& [label, score] : object.votes) {
    votes[label] = Rounded(score, kMetre);
  }
  const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
  Json json = {{"id", object.id.value},
               {"class", object.label},
               {"votes", votes},
               {"state", ToString(object.state)},
               {"world_from_object", PoseJson(object.ellipsoid.world_from_object)},
               {"half_axes", HalfAxesJson(axes)},
               {"dual_quadric", QuadricJson(object.ellipsoid)},
               {"siou", RoundedOrNull(object.fit.siou)},
               {"siou_mask", RoundedOrNull(object.fit.siou_mask)},
               {"mtd_m2", RoundedOrNull(object.fit.mtd_m2)},
               {"tangent_px", RoundedOrNull(object.fit.tangent_px)},
               {"misfit_px", Rounded(object.misfit_px, kMetre)},
               {"parallax_deg", Rounded(ParallaxOf(object), kAngle)},
               {"quality", Rounded(QualityOf(object), kAngle)},
               {"observations", object.observations.size()}};
  if (!object.name.empty()) {
    json["name"] = object.name;
  }
  if (object.is_locked) {
    json["locked"] = true;
  }
  if (object.known_size > 0.0) {
    json["known_size"] = object.known_size;
  }
  return json;
}

Json ToJson(const std::optional<LocatedObject>& located) {
  if (!located) {
    return nullptr;
  }
  const Eigen::Vector3d& axes = located->ellipsoid.half_axes;
  return {{"object", located->object.value},
          {"world_from_object", PoseJson(located->ellipsoid.world_from_object)},
          {"half_axes", HalfAxesJson(axes)}};
}

Json ToJson(const ChangedObject& changed) {
  return {{"change", std::string(ToString(changed.change))},
          {"class", changed.label},
          {"now", ToJson(changed.now)},
          {"former", ToJson(changed.former)},
          {"expected", changed.expected},
          {"found", changed.found}};
}

Json ToJson(const std::optional<std::vector<ChangedObject>>& changes) {
  if (!changes) {
    return nullptr;
  }
  Json list = Json::array();
  for (const ChangedObject& changed : *changes) {
    list.push_back(ToJson(changed));
  }
  return list;
}

// A field of a CSV file by RFC 4180: in quotes if it contains a quote or a comma. A spreadsheet
// takes a text that begins with one of = + - @ for a formula, so ' is put before it.
std::string CsvField(const std::string& label) {
  std::string text = Printable(label);
  if (text.find_first_of("=+-@") == 0) {
    text.insert(text.begin(), '\'');
  }
  if (text.find_first_of("\",") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return quoted + '"';
}

std::string CsvNumber(const std::optional<double>& value) {
  return value ? fmt::format("{}", Rounded(*value, kMetre)) : std::string();
}

}  // namespace

std::string FormatObjects(const ObjectResults& report, const Scene& scene) {
  const Json head = {{"version", kObjectFileVersion},
                     {"sequence", report.sequence},
                     {"camera", ToJson(report.camera)},
                     {"candidates", report.candidates},
                     {"changes", ToJson(report.changes)}};
  std::vector<std::string> objects;
  for (const ObjectResult& object : report.objects) {
    Json json = ToJson(object);
    if (const SceneObject* const body = scene.Find(object.id)) {
      json.update(BodyJson(*body));
    }
    objects.push_back(DumpLine(json));
  }
  return WithEntries(head, "objects", objects);
}

std::string FormatObservations(const ObjectResults& report) {
  std::vector<std::string> observations;
  for (const ObjectResult& object : report.objects) {
    for (const ObservationResult& observation : object.observations) {
      observations.push_back(DumpLine(ToJson(object.id, observation)));
    }
  }
  return WithEntries({{"version", kObjectFileVersion}}, "observations", observations);
}

std::string FormatObjectsCsv(const ObjectResults& report) {
  std::string text =
      "id,class,state,observations,tx,ty,tz,qx,qy,qz,qw,half_axis_x,half_axis_y,half_axis_z,"
      "siou,siou_mask,mtd_m2,tangent_px,misfit_px,parallax_deg,quality\n";
  for (const ObjectResult& object : report.objects) {
    text += fmt::format("{},{},{},{}", object.id.value, CsvField(object.label),
                        ToString(object.state), object.observations.size());
    const Rigid3& pose = object.ellipsoid.world_from_object;
    for (const auto& values :
         {Eigen::VectorXd(pose.translation), Eigen::VectorXd(pose.rotation.coeffs()),
          Eigen::VectorXd(object.ellipsoid.half_axes)}) {
      for (const double value : values) {
        text += ',' + CsvNumber(value);
      }
    }
    for (const std::optional<double>& value :
         {object.fit.siou, object.fit.siou_mask, object.fit.mtd_m2, object.fit.tangent_px,
          std::optional(object.misfit_px)}) {
      text += ',' + CsvNumber(value);
    }
    text += fmt::format(",{},{}\n", Rounded(ParallaxOf(object), kAngle),
                        Rounded(QualityOf(object), kAngle));
  }
  return text;
}

std::vector<FileContent> ObjectFiles(const ObjectResults& report, const Scene& scene) {
  return {{"objects.json", FormatObjects(report, scene)},
          {"objects_observations.json", FormatObservations(report)},
          {"objects.csv", FormatObjectsCsv(report)},
          {"objects.ply", FormatObjectsPly(report.objects)},
          {"scene.json", FormatScene(scene)}};
}

}  // namespace hullslam
