// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/object_file.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "geometry/polyline.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "io/json_file.h"
#include "io/json_node.h"
#include "io/plausible.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kVersion = 2;
constexpr const char* kObservationsFile = "objects_observations.json";
constexpr double kPixel = 1e-2;
constexpr double kMetre = 1e-9;
constexpr double kAngle = 1e-4;  // degrees; also for shares

// Rounds `value` to a multiple of `unit` (1 over a power of ten). Never returns -0.
double Rounded(double value, double unit) {
  Check(std::isfinite(value), "a number of an object is not finite");
  const double units = std::round(1.0 / unit);
  return std::round(value * units) / units + 0.0;
}

// null if the value is not known.
Json OrNull(const std::optional<double>& value) {
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

Json PointsJson(const std::vector<Eigen::Vector2d>& points) {
  Json json = Json::array();
  for (const Eigen::Vector2d& point : points) {
    json.push_back({Rounded(point.x(), kPixel), Rounded(point.y(), kPixel)});
  }
  return json;
}

Json LinesJson(const std::vector<SilhouetteLine>& lines) {
  // Over an image of 1000 px the rounding of the normal moves the line by 0.001 px.
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

const char* ToString(ObjectState state) {
  return state == ObjectState::kMapped ? "mapped" : "candidate";
}

Json ToJson(const PinholeCamera& camera) {
  return {{"fx", camera.fx}, {"fy", camera.fy}, {"cx", camera.cx},       {"cy", camera.cy},
          {"k1", camera.k1}, {"k2", camera.k2}, {"p1", camera.p1},       {"p2", camera.p2},
          {"k3", camera.k3}, {"bf", camera.bf}, {"width", camera.width}, {"height", camera.height}};
}

Json ToJson(ObjectId object, const ReportedView& view) {
  return {{"object", object.value},
          {"keyframe", view.keyframe.value},
          {"timestamp", Rounded(view.timestamp, kMetre)},
          {"cam_from_world", PoseJson(view.cam_from_world)},
          {"class", view.label},
          {"score", Rounded(view.score, kMetre)},
          {"cut", view.is_cut},
          {"box", view.is_box},
          {"hull", PointsJson(view.hull)},
          {"contour", PointsJson(view.contour)},
          {"lines", LinesJson(view.lines)}};
}

// Everything about an object except its views.
Json ToJson(const ReportedObject& object) {
  Json votes = Json::object();
  for (const auto& [label, score] : object.votes) {
    votes[label] = Rounded(score, kMetre);
  }
  const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
  return {{"id", object.id.value},
          {"class", object.label},
          {"votes", votes},
          {"state", ToString(object.state)},
          {"world_from_object", PoseJson(object.ellipsoid.world_from_object)},
          {"half_axes",
           {Rounded(axes.x(), kMetre), Rounded(axes.y(), kMetre), Rounded(axes.z(), kMetre)}},
          {"dual_quadric", QuadricJson(object.ellipsoid)},
          {"siou", OrNull(object.fit.siou)},
          {"siou_mask", OrNull(object.fit.siou_mask)},
          {"mtd_m2", OrNull(object.fit.mtd_m2)},
          {"tangent_px", OrNull(object.fit.tangent_px)},
          {"misfit_px", Rounded(object.misfit_px, kMetre)},
          {"parallax_deg", Rounded(ParallaxOf(object), kAngle)},
          {"quality", Rounded(QualityOf(object), kAngle)},
          {"observations", object.views.size()}};
}

Json ToJson(const std::optional<ObjectPlace>& place) {
  if (!place) {
    return nullptr;
  }
  const Eigen::Vector3d& axes = place->ellipsoid.half_axes;
  return {{"object", place->object.value},
          {"world_from_object", PoseJson(place->ellipsoid.world_from_object)},
          {"half_axes",
           {Rounded(axes.x(), kMetre), Rounded(axes.y(), kMetre), Rounded(axes.z(), kMetre)}}};
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

// Labels come from the files of users and may contain any bytes.
std::string Dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The head, and then a member with the entries, each on its own line.
std::string WithEntries(const Json& head, const char* name,
                        const std::vector<std::string>& entries) {
  std::string text = Dump(head);
  text.pop_back();
  text += fmt::format(",\"{}\":[", name);
  for (const std::string& entry : entries) {
    text += (&entry == &entries.front() ? "\n " : ",\n ") + entry;
  }
  return text + "\n]}\n";
}

// A field of a CSV file by RFC 4180: in quotes if it contains a quote, a comma or a line end.
std::string CsvField(const std::string& text) {
  if (text.find_first_of("\",\r\n") == std::string::npos) {
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

ReportedView ReadView(const JsonNode& node) {
  ReportedView view;
  view.keyframe = KeyframeId(node.At("keyframe").Count());
  view.timestamp = node.At("timestamp").Number(kMostSeconds);
  view.cam_from_world = node.At("cam_from_world").Pose();
  view.label = node.At("class").Text();
  view.score = node.At("score").Number(1.0);
  view.is_cut = node.At("cut").Flag();
  view.is_box = node.At("box").Flag();
  view.hull = node.At("hull").Points();
  if (view.hull.size() < 3 || !(SignedArea(view.hull) > 0.0)) {
    node.At("hull").Fail("three corners or more in the order of positive area");
  }
  view.contour = node.At("contour").Points();
  view.lines = ReadLines(node.At("lines"));
  return view;
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
    votes[label] = score.Number(kMostVotes);
  }
  return votes;
}

std::optional<double> ReadOptional(const JsonNode& node, const char* key, double most) {
  return node.Has(key) ? std::optional(node.At(key).Number(most)) : std::nullopt;
}

ReportedObject ReadObject(const JsonNode& node) {
  ReportedObject object;
  object.id = ObjectId(node.At("id").Count());
  object.state = ReadState(node.At("state"));
  object.label = node.At("class").Text();
  object.votes = ReadVotes(node.At("votes"));
  object.ellipsoid.world_from_object = node.At("world_from_object").Pose();
  object.ellipsoid.half_axes = node.At("half_axes").Lengths();
  object.misfit_px = node.At("misfit_px").Number(kMostPixels);
  object.fit.siou = ReadOptional(node, "siou", 1.0);
  object.fit.siou_mask = ReadOptional(node, "siou_mask", 1.0);
  object.fit.mtd_m2 = ReadOptional(node, "mtd_m2", kMostMetres);
  object.fit.tangent_px = ReadOptional(node, "tangent_px", kMostPixels);
  return object;
}

std::optional<ObjectPlace> ReadPlace(const JsonNode& node, const char* key) {
  if (!node.Has(key)) {
    return std::nullopt;
  }
  const JsonNode place = node.At(key);
  return ObjectPlace{ObjectId(place.At("object").Count()),
                     {place.At("world_from_object").Pose(), place.At("half_axes").Lengths()}};
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
                       .now = ReadPlace(node, "now"),
                       .former = ReadPlace(node, "former"),
                       .expected = static_cast<int>(node.At("expected").Count()),
                       .found = static_cast<int>(node.At("found").Count())});
  }
  return changes;
}

void CheckVersion(const JsonNode& top) {
  if (top.At("version").Count() != kVersion) {
    top.At("version").Fail("2, which this version of HullSLAM writes");
  }
}

// Adds the observations to their objects, which must have `counts` observations.
void ReadObservations(const std::filesystem::path& path, const std::vector<uint32_t>& counts,
                      ObjectReport& report) {
  const nlohmann::json json = ReadJson(path);
  const JsonNode top(path, json);
  CheckVersion(top);
  std::map<uint32_t, ReportedObject*> objects;
  for (ReportedObject& object : report.objects) {
    objects[object.id.value] = &object;
  }
  for (const JsonNode& view : top.At("observations").Elements()) {
    const auto object = objects.find(view.At("object").Count());
    if (object == objects.end()) {
      view.At("object").Fail("the id of an object in objects.json");
    }
    object->second->views.push_back(ReadView(view));
  }
  for (size_t i = 0; i < counts.size(); ++i) {
    const ReportedObject& object = report.objects[i];
    if (object.views.size() != counts[i]) {
      throw InputError(fmt::format(
          "{}: has {} observations of object {}, expected {} as in objects.json; both files must "
          "be of the same run",
          path.string(), object.views.size(), object.id.value, counts[i]));
    }
  }
}

}  // namespace

std::string FormatObjects(const ObjectReport& report) {
  const Json head = {{"version", kVersion},
                     {"sequence", report.sequence},
                     {"camera", ToJson(report.camera)},
                     {"candidates", report.candidates},
                     {"changes", ToJson(report.changes)}};
  std::vector<std::string> objects;
  for (const ReportedObject& object : report.objects) {
    objects.push_back(Dump(ToJson(object)));
  }
  return WithEntries(head, "objects", objects);
}

std::string FormatObservations(const ObjectReport& report) {
  std::vector<std::string> views;
  for (const ReportedObject& object : report.objects) {
    for (const ReportedView& view : object.views) {
      views.push_back(Dump(ToJson(object.id, view)));
    }
  }
  return WithEntries({{"version", kVersion}}, "observations", views);
}

std::string FormatObjectsCsv(const ObjectReport& report) {
  std::string text =
      "id,class,state,observations,tx,ty,tz,qx,qy,qz,qw,half_axis_x,half_axis_y,half_axis_z,"
      "siou,siou_mask,mtd_m2,tangent_px,misfit_px,parallax_deg,quality\n";
  for (const ReportedObject& object : report.objects) {
    text += fmt::format("{},{},{},{}", object.id.value, CsvField(object.label),
                        ToString(object.state), object.views.size());
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

ObjectReport ReadObjects(const std::filesystem::path& path,
                         const std::filesystem::path& observations) {
  const nlohmann::json json = ReadJson(path);
  const JsonNode top(path, json);
  CheckVersion(top);
  ObjectReport report;
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

ObjectReport ReadObjects(const std::filesystem::path& path) {
  return ReadObjects(path, path.parent_path() / kObservationsFile);
}

}  // namespace hullslam
