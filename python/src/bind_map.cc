// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "eval/object_metrics.h"
#include "hullslam/map_files/map_file.h"
#include "module.h"
#include "report/object_results.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

using Vector3 = std::array<double, 3>;

// The rows of the structured arrays.
struct LandmarkRow {
  int64_t id;
  Vector3 position;
  Vector3 viewing_direction;
  int64_t keyframe;
  int32_t observations;
};
struct KeyframeRow {
  int64_t id;
  int64_t frame;
  double timestamp;
  std::array<std::array<double, 4>, 4> cam_from_world;
  int64_t parent;
  int64_t island;
};
struct ObservationRow {
  int64_t landmark;
  int64_t keyframe;
  std::array<float, 2> pixel;
  float depth;
};

// An object of a snapshot of the map.
struct MapObject {
  int64_t id = -1;
  ObjectLandmark object;
  MapView view;
};

Vector3 ToRow(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

template <typename Row>
py::array_t<Row> ToRows(const std::vector<Row>& rows) {
  return py::array_t<Row>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

py::array_t<LandmarkRow> LandmarksOf(const MapView& view) {
  std::vector<LandmarkRow> rows;
  rows.reserve(view.map->landmarks().size());
  for (const auto& [id, landmark] : view.map->landmarks()) {
    rows.push_back({.id = ToNumber(id),
                    .position = ToRow(landmark.position),
                    .viewing_direction = ToRow(landmark.viewing_direction),
                    .keyframe = ToNumber(landmark.created_by),
                    .observations = static_cast<int32_t>(landmark.observations.size())});
  }
  return ToRows(rows);
}

py::array_t<KeyframeRow> KeyframesOf(const MapView& view) {
  std::vector<KeyframeRow> rows;
  for (const auto& [id, keyframe] : view.map->keyframes()) {
    KeyframeRow& row = rows.emplace_back();
    row = {.id = ToNumber(id),
           .frame = ToNumber(keyframe.frame->id),
           .timestamp = keyframe.frame->timestamp,
           .cam_from_world = {},
           .parent = ToNumber(keyframe.parent),
           .island = ToNumber(keyframe.island)};
    const Eigen::Matrix<double, 3, 4> pose = keyframe.cam_from_world.ToMatrix();
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 4; ++j) {
        row.cam_from_world[i][j] = pose(static_cast<int>(i), static_cast<int>(j));
      }
    }
    row.cam_from_world[3] = {0.0, 0.0, 0.0, 1.0};
  }
  return ToRows(rows);
}

py::array_t<ObservationRow> ObservationsOf(const MapView& view) {
  std::vector<ObservationRow> rows;
  for (const auto& [id, landmark] : view.map->landmarks()) {
    for (const Observation& observation : landmark.observations) {
      const FrameFeatures& features =
          view.map->keyframes().At(observation.keyframe).frame->features;
      const Eigen::Vector2f& pixel = features.keypoints[observation.keypoint].undistorted;
      rows.push_back({.landmark = ToNumber(id),
                      .keyframe = ToNumber(observation.keyframe),
                      .pixel = {pixel.x(), pixel.y()},
                      .depth = features.depth[observation.keypoint]});
    }
  }
  return ToRows(rows);
}

std::vector<MapObject> ObjectsOf(const MapView& view, ObjectState state) {
  std::vector<MapObject> objects;
  for (const auto& [id, object] : view.map->objects()) {
    if (object.state == state) {
      objects.push_back({ToNumber(id), object, view});
    }
  }
  return objects;
}

// An array of an object, whose values are NaN if the shape of the object is not known.
py::array_t<double> IfShaped(const MapObject& object, py::array_t<double> values) {
  if (!object.object.has_shape) {
    std::fill_n(values.mutable_data(), values.size(), std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

py::array_t<double> DualQuadricOf(const MapObject& object) {
  py::array_t<double> matrix({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.mutable_data()) =
      object.object.ellipsoid.DualQuadric();
  return IfShaped(object, std::move(matrix));
}

// The object with its fit, as in objects.json.
ObjectResult ResultOf(const MapObject& object) {
  ObjectResult reported =
      ResultOfObject(*object.view.map, ObjectId(static_cast<uint32_t>(object.id)), object.object);
  reported.fit = MeasureObject(reported.ellipsoid, reported.observations, object.view.camera);
  return reported;
}

std::optional<double> ParallaxOfObject(const MapObject& object) {
  return object.object.has_shape ? std::optional(ParallaxOf(ResultOf(object))) : std::nullopt;
}

std::optional<double> SiouOfObject(const MapObject& object) {
  return object.object.has_shape ? ResultOf(object).fit.siou : std::nullopt;
}

double QualityOfObject(const MapObject& object) {
  return object.object.has_shape ? QualityOf(ResultOf(object)) : 0.0;
}

void BindReliability(py::class_<MapObject>& object) {
  object
      .def_property_readonly(
          "misfit", [](const MapObject& o) { return o.object.misfit_px; },
          "RMS distance of its lines from its projected ellipses, px.")
      .def_property_readonly(
          "parallax", &ParallaxOfObject,
          "The largest angle between the rays from the cameras of its keyframes\n"
          "to its centre, degrees; None if the shape is not known.")
      .def_property_readonly(
          "siou", &SiouOfObject,
          "Mean intersection over union of its projected ellipses with the hulls\n"
          "of its masks, 0 to 1; None if no keyframe has a value.")
      .def_property_readonly(
          "quality", &QualityOfObject,
          "Reliability of the shape, 0 to 1, as in objects.json: siou times\n"
          "min(1, parallax / 20 degrees) times min(1, keyframes / 10); 0 if the\n"
          "shape is not known.");
}

std::string DescribeObject(const MapObject& object) {
  return "<hullslam.MapObject " + std::to_string(object.id) + ": " + object.object.Label() + ", " +
         std::to_string(object.object.observations.size()) + " observations>";
}

void BindObject(py::module_& module) {
  py::class_<MapObject> object(
      module, "MapObject",
      "An object of the map: an ellipsoid with a class. Lengths are in metres, in\n"
      "monocular runs in units of the map.");
  object.def_readonly("id", &MapObject::id, "The number of the object, as in SeenObject.object.")
      .def_property_readonly(
          "label", [](const MapObject& o) { return std::string(o.object.Label()); },
          "The class with most votes.")
      .def_property_readonly(
          "name", [](const MapObject& o) { return o.object.name; },
          "The name by System.name_object(), '' if there is none.")
      .def_property_readonly(
          "is_locked", [](const MapObject& o) { return o.object.is_locked; },
          "Whether System.lock_object() has locked it.")
      .def_property_readonly(
          "known_size", [](const MapObject& o) { return o.object.known_size; },
          "The longest side by System.set_object_size(), m; 0 if there is none.")
      .def_property_readonly(
          "votes", [](const MapObject& o) { return o.object.votes; },
          "The sum of the scores of each class.")
      .def_property_readonly(
          "is_mapped", [](const MapObject& o) { return o.object.state == ObjectState::kMapped; },
          "Whether the shape fits all its views. If not, the object is a candidate.")
      .def_property_readonly(
          "world_from_object",
          [](const MapObject& o) {
            return IfShaped(o, ToArray(o.object.ellipsoid.world_from_object));
          },
          "(4, 4) pose: the origin is the centre and the axes are the ellipsoid's. NaN if\n"
          "the shape is not known.")
      .def_property_readonly(
          "half_axes",
          [](const MapObject& o) { return IfShaped(o, ToArray(o.object.ellipsoid.half_axes)); },
          "(3,) half axes of the ellipsoid, m; NaN if the shape is not known.")
      .def_property_readonly(
          "dual_quadric", &DualQuadricOf,
          "(4, 4) dual quadric Q* in the world frame: tangent planes satisfy pi^T Q* pi = 0. NaN\n"
          "if the shape is not known.")
      .def_property_readonly(
          "keyframes",
          [](const MapObject& o) {
            std::vector<int64_t> keyframes;
            for (const ObjectObservation& observation : o.object.observations) {
              keyframes.push_back(ToNumber(observation.keyframe));
            }
            return keyframes;
          },
          "The ids of the keyframes that observe it.")
      .def("__repr__", &DescribeObject);
  BindReliability(object);
}

}  // namespace

void BindMap(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(LandmarkRow, id, position, viewing_direction, keyframe, observations);
  PYBIND11_NUMPY_DTYPE(KeyframeRow, id, frame, timestamp, cam_from_world, parent, island);
  PYBIND11_NUMPY_DTYPE(ObservationRow, landmark, keyframe, pixel, depth);
  BindObject(module);
  py::class_<MapView>(
      module, "Map",
      "A snapshot of the map, which never changes. Each property makes an array or\n"
      "a list of its own. Lengths are in metres, in monocular runs in units of the\n"
      "map.")
      .def_property_readonly(
          "landmarks", &LandmarksOf,
          "Structured array (N,) of the points: id, in no order; position (3,), world frame;\n"
          "viewing_direction (3,), mean unit vector from the cameras; keyframe, the id of the one\n"
          "that made it; observations, their number.")
      .def_property_readonly("keyframes", &KeyframesOf,
                             "Structured array (N,) of the keyframes: id; frame; timestamp, s;\n"
                             "cam_from_world (4, 4); parent in the spanning tree, or -1; island.")
      .def_property_readonly(
          "observations", &ObservationsOf,
          "Structured array (N,) of the observations of points by keyframes:\n"
          "landmark and keyframe, their ids; pixel (2,), undistorted; depth along\n"
          "the optical axis, m, 0 if it is not known.")
      .def_property_readonly(
          "objects", [](const MapView& view) { return ObjectsOf(view, ObjectState::kMapped); },
          "The mapped objects: list of MapObject.")
      .def_property_readonly(
          "candidates",
          [](const MapView& view) { return ObjectsOf(view, ObjectState::kCandidate); },
          "Objects whose shape is not known or does not fit yet: list of MapObject.")
      .def_property_readonly(
          "sessions",
          [](const MapView& view) {
            std::vector<std::string> names;
            for (const Session& session : view.map->sessions()) {
              names.push_back(session.name);
            }
            return names;
          },
          "The names of the runs that added keyframes.")
      .def("__repr__", [](const MapView& view) {
        return "<hullslam.Map: " + std::to_string(view.map->keyframes().size()) + " keyframes, " +
               std::to_string(view.map->landmarks().size()) + " landmarks, " +
               std::to_string(view.map->objects().size()) + " objects and candidates>";
      });
  module.def(
      "read_map",
      [](const std::filesystem::path& path) {
        return WithoutGil([&] {
          StoredMap stored = ReadMap(path);
          return MapView{std::make_shared<const Map>(std::move(stored.map)),
                         stored.settings.camera};
        });
      },
      py::arg("path"),
      "Reads a map to look at it. To go on with a map, give its path to System. Raises InputError\n"
      "if the file is damaged.");
}

}  // namespace hullslam::python
