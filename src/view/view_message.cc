// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_message.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "files/base64.h"
#include "results/json_text.h"
#include "results/scene_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

void AppendWord(std::string& bytes, uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>(word >> shift & 0xffu);
  }
}

}  // namespace

nlohmann::json PackArray(std::span<const float> values) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) {
    AppendWord(bytes, std::bit_cast<uint32_t>(value));
  }
  return {{"f32", EncodeBase64(bytes)}};
}

nlohmann::json PackArray(std::span<const uint32_t> values) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const uint32_t value : values) {
    AppendWord(bytes, value);
  }
  return {{"u32", EncodeBase64(bytes)}};
}

nlohmann::json PackArray(std::span<const uint8_t> values) {
  return {{"u8", EncodeBase64(std::string(values.begin(), values.end()))}};
}

namespace {

using Json = nlohmann::json;

// The first time stamp of the run, from which the page counts.
double StartOf(const ViewModel& model) {
  for (const Trajectory* poses : {&model.trajectory, &model.keyframes.poses}) {
    if (!poses->empty()) {
      return poses->front().timestamp;
    }
  }
  return 0.0;
}

Json PackTimes(std::span<const double> timestamps, double start) {
  std::vector<float> times;
  times.reserve(timestamps.size());
  for (const double timestamp : timestamps) {
    times.push_back(static_cast<float>(timestamp - start));
  }
  return PackArray(times);
}

void Append(const Eigen::VectorXd& values, std::vector<float>& list) {
  for (const double value : values) {
    list.push_back(static_cast<float>(value));
  }
}

Json PackPoses(const Trajectory& poses) {
  std::vector<float> values;
  values.reserve(7 * poses.size());
  for (const StampedPose& pose : poses) {
    Append(pose.world_from_cam.translation, values);
    Append(pose.world_from_cam.rotation.coeffs(), values);
  }
  return PackArray(values);
}

Json PackPositions(const Trajectory& poses) {
  std::vector<float> values;
  values.reserve(3 * poses.size());
  for (const StampedPose& pose : poses) {
    Append(pose.world_from_cam.translation, values);
  }
  return PackArray(values);
}

Json LandmarksJson(const ViewLandmarks& landmarks, double start) {
  std::vector<float> positions;
  positions.reserve(3 * landmarks.positions.size());
  for (const Eigen::Vector3f& position : landmarks.positions) {
    positions.insert(positions.end(), position.begin(), position.end());
  }
  Json json = {{"position", PackArray(positions)}, {"total", landmarks.total}};
  if (!landmarks.colours.empty()) {
    std::vector<uint8_t> colours;
    for (const std::array<uint8_t, 3>& colour : landmarks.colours) {
      colours.insert(colours.end(), colour.begin(), colour.end());
    }
    json["colour"] = PackArray(colours);
  }
  if (!landmarks.created.empty()) {
    json["age"] = PackTimes(landmarks.created, start);
  }
  return json;
}

Json ShapesJson(const std::vector<ViewShape>& shapes) {
  Json list = Json::array();
  for (const ViewShape& shape : shapes) {
    Json points = Json::array();
    for (const Eigen::Vector2d& point : shape.points) {
      for (const double coordinate : point) {
        points.push_back(std::round(10.0 * coordinate) / 10.0);
      }
    }
    list.push_back({{"object", shape.object.IsValid() ? Json(shape.object.value) : Json()},
                    {"class", Printable(shape.label)},
                    {"points", std::move(points)}});
  }
  return list;
}

Json PicturesJson(const std::vector<ViewPicture>& pictures, double start) {
  Json list = Json::array();
  for (const ViewPicture& picture : pictures) {
    list.push_back(PictureJson(picture, start));
  }
  return list;
}

Json PackEdges(const std::vector<ViewEdges::Edge>& edges) {
  std::vector<uint32_t> ids;
  for (const ViewEdges::Edge& edge : edges) {
    ids.insert(ids.end(), edge.begin(), edge.end());
  }
  return PackArray(ids);
}

Json RelationsJson(const std::vector<Relation>& relations) {
  Json list = Json::array();
  for (const Relation& relation : relations) {
    list.push_back({{"subject", relation.subject.value},
                    {"relation", ToString(relation.kind)},
                    {"object", relation.object.value}});
  }
  return list;
}

Json LocatedJson(const std::optional<LocatedObject>& located) {
  if (!located) {
    return nullptr;
  }
  const Eigen::Vector3d& centre = located->ellipsoid.world_from_object.translation;
  return {{"id", located->object.value},
          {"centre", std::vector<double>(centre.begin(), centre.end())}};
}

Json ChangesJson(const std::vector<ChangedObject>& changes) {
  Json list = Json::array();
  for (const ChangedObject& changed : changes) {
    list.push_back({{"change", ToString(changed.change)},
                    {"class", Printable(changed.label)},
                    {"former", LocatedJson(changed.former)},
                    {"now", LocatedJson(changed.now)},
                    {"expected", changed.expected},
                    {"found", changed.found}});
  }
  return list;
}

Json SettingsJson(const ViewSettings& settings) {
  Json changed = Json::array();
  for (const ViewSetting& setting : settings.changed) {
    changed.push_back({{"key", Printable(setting.key)},
                       {"value", Printable(setting.value)},
                       {"default", Printable(setting.standard)}});
  }
  return {{"changed", std::move(changed)}, {"from", settings.explanation}};
}

Json RunJson(const ViewModel& model, double start) {
  Json notes = Json::array();
  for (const std::string& note : model.notes) {
    notes.push_back(Printable(note));
  }
  return {{"title", Printable(model.title)},
          {"program", Printable(model.program)},
          {"sequence", Printable(model.sequence)},
          {"version", Printable(model.version)},
          {"unit", model.is_metric ? "m" : "u"},
          {"start", start},
          {"live", false},
          {"notes", std::move(notes)}};
}

Json CameraJson(const PinholeCamera& camera) {
  return {{"fx", camera.fx}, {"fy", camera.fy},       {"cx", camera.cx},
          {"cy", camera.cy}, {"width", camera.width}, {"height", camera.height}};
}

void SetGeometry(const ViewModel& model, double start, Json& parts) {
  const auto set_if = [&](const char* name, bool is_there, const auto& make) {
    if (is_there) {
      parts[name] = make();
    }
  };
  set_if("up", model.up.has_value(),
         [&] { return Json(std::vector<double>(model.up->begin(), model.up->end())); });
  set_if("camera", model.camera.has_value(), [&] { return CameraJson(*model.camera); });
  set_if("landmarks", !model.landmarks.positions.empty(),
         [&] { return LandmarksJson(model.landmarks, start); });
  set_if("surface", !model.surface.triangles.empty(), [&] { return SurfaceJson(model.surface); });
  set_if("keyframes", !model.keyframes.poses.empty(), [&] {
    return Json{{"id", PackArray(model.keyframes.ids)},
                {"time", PackTimes(StampsOf(model.keyframes.poses), start)},
                {"pose", PackPoses(model.keyframes.poses)}};
  });
  set_if("trajectory", !model.trajectory.empty(),
         [&] { return TrajectoryJson(model.trajectory, start); });
  set_if("groundtruth", !model.groundtruth.empty(), [&] {
    return Json{{"time", PackTimes(StampsOf(model.groundtruth), start)},
                {"position", PackPositions(model.groundtruth)}};
  });
  parts["edges"] = EdgesJson(model.edges);
}

}  // namespace

nlohmann::json SurfaceJson(const PlySurface& surface) {
  std::vector<float> positions;
  std::vector<uint8_t> colours;
  std::vector<uint32_t> corners;
  for (size_t i = 0; i < surface.positions.size(); ++i) {
    positions.insert(positions.end(), surface.positions[i].begin(), surface.positions[i].end());
    colours.insert(colours.end(), surface.colours[i].begin(), surface.colours[i].end());
  }
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  return {{"position", PackArray(positions)},
          {"colour", PackArray(colours)},
          {"triangle", PackArray(corners)}};
}

nlohmann::json PictureJson(const ViewPicture& picture, double start) {
  return {{"time", picture.timestamp - start},
          {"width", picture.width},
          {"height", picture.height},
          {"image", "data:image/jpeg;base64," + EncodeBase64(picture.jpeg)},
          {"outlines", ShapesJson(picture.outlines)},
          {"ellipses", ShapesJson(picture.ellipses)}};
}

nlohmann::json ObjectJson(const ViewObject& shown, double start) {
  const ObjectResult& object = shown.object;
  const Eigen::Vector3d& centre = object.ellipsoid.world_from_object.translation;
  const Eigen::Vector4d rotation = object.ellipsoid.world_from_object.rotation.coeffs();
  const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
  Json votes = Json::object();
  for (const auto& [label, score] : object.votes) {
    votes[Printable(label)] = score;
  }
  Json body = shown.body ? Json(BodyJson(*shown.body)) : Json();
  Json json = {{"id", object.id.value},
               {"body", std::move(body)},
               {"class", Printable(object.label)},
               {"state", ToString(object.state)},
               {"reason", shown.reason},
               {"votes", std::move(votes)},
               {"centre", std::vector<double>(centre.begin(), centre.end())},
               {"rotation", std::vector<double>(rotation.begin(), rotation.end())},
               {"half_axes", std::vector<double>(axes.begin(), axes.end())},
               {"siou", OrNull(object.fit.siou)},
               {"siou_mask", OrNull(object.fit.siou_mask)},
               {"tangent_px", OrNull(object.fit.tangent_px)},
               {"misfit_px", object.misfit_px},
               {"parallax_deg", ParallaxOf(object)},
               {"quality", QualityOf(object)},
               {"observations", object.observations.size()},
               {"cutouts", PicturesJson(shown.cutouts, start)}};
  if (!object.name.empty()) {
    json["name"] = Printable(object.name);
  }
  return json;
}

nlohmann::json TrajectoryJson(const Trajectory& poses, double start) {
  return {{"time", PackTimes(StampsOf(poses), start)}, {"pose", PackPoses(poses)}};
}

nlohmann::json EdgesJson(const ViewEdges& edges) {
  return {{"covisibility", PackEdges(edges.covisibility)}, {"loop", PackEdges(edges.loops)}};
}

nlohmann::json LossesJson(const Json& summary, double start) {
  Json list = Json::array();
  const Json losses =
      summary.is_object() && summary.contains("trajectory") && summary["trajectory"].is_object()
          ? summary["trajectory"].value("losses", Json::array())
          : Json::array();
  for (const Json& loss : losses.is_array() ? losses : Json::array()) {
    const auto has = [&](const char* key) {
      return loss.is_object() && loss.contains(key) && loss[key].is_number();
    };
    if (has("first_timestamp") && has("last_timestamp") && has("frames") &&
        loss.contains("reason") && loss["reason"].is_string()) {
      list.push_back({{"from", loss["first_timestamp"].get<double>() - start},
                      {"to", loss["last_timestamp"].get<double>() - start},
                      {"frames", loss["frames"]},
                      {"reason", loss["reason"]}});
    }
  }
  return list;
}

nlohmann::json ViewParts(const ViewModel& model, double start) {
  Json parts = {{"run", RunJson(model, start)}};
  SetGeometry(model, start, parts);
  if (!model.errors.timestamps.empty()) {
    const std::vector<float> metres(model.errors.metres.begin(), model.errors.metres.end());
    parts["errors"] = {{"time", PackTimes(model.errors.timestamps, start)},
                       {"value", PackArray(metres)}};
  }
  Json objects = Json::array();
  for (const ViewObject& object : model.objects) {
    objects.push_back(ObjectJson(object, start));
  }
  parts["objects"] = std::move(objects);
  parts["images"] = PicturesJson(model.pictures, start);
  parts["losses"] = LossesJson(model.summary, start);
  parts["summary"] = model.summary;
  parts["relations"] = RelationsJson(model.relations);
  parts["changes"] = ChangesJson(model.changes);
  if (model.settings) {
    parts["settings"] = SettingsJson(*model.settings);
  }
  return parts;
}

std::string DumpViewMessage(const nlohmann::json& message) {
  const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string FormatViewMessage(const ViewModel& model) {
  return DumpViewMessage({{"view", kViewVersion}, {"set", ViewParts(model, StartOf(model))}});
}

}  // namespace hullslam
