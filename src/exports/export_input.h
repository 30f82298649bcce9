// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "map/located_landmarks.h"
#include "results/unit_mesh.h"
#include "scene/scene.h"

namespace hullslam {

struct ColouredPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world frame
  Colour colour{};                                     // sRGB
};

// A run or a map, as far as pictures of it and lists of poses need it. Positions are in the world
// frame of the map and in its unit of length (m with depth).
struct ExportModel {
  std::optional<PinholeCamera> camera;  // absent if the files of the run do not have it
  Trajectory trajectory;                // all frames with a pose; of a map only the keyframes
  std::vector<StampedPose> keyframes;   // in the order of the map
  std::vector<ColouredPoint> points;
  Scene scene;  // the mapped objects and the upward direction
};

enum class ObjectShape { kEllipsoids, kBoxes };

// The position of an object's shape: the unit sphere or the unit cube (results/unit_mesh.h) is
// multiplied by `half_extents` along its axes and then moved to the world.
struct PlacedObject {
  const SceneObject* object = nullptr;
  Rigid3 world_from_shape;
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();
};

// The objects as shapes of this kind, in the order of the scene. A box is the upright one of the
// scene; if the scene does not know what is upwards, it is the box around the ellipsoid along the
// axes of the ellipsoid. The scene must outlive the result.
std::vector<PlacedObject> PlaceObjects(const Scene& scene, ObjectShape shape);

// The mesh that such a shape is made from.
TriangleMesh MeshOf(ObjectShape shape);

// The input of an export, as the user names it.
struct ExportSource {
  std::filesystem::path input;     // the output folder of a run, or a file of --save-map
  std::filesystem::path map;       // of the run; empty: the one that its summary.json names
  std::filesystem::path sequence;  // likewise
};

// How much of a run a format needs. Each level includes the ones before.
enum class ExportNeed { kPoses, kScene, kMap, kImages };

struct MapOfRun {
  Map map;  // with one island only
  Sensor sensor;
  LocatedLandmarks located;
};

struct MasksOfRun {
  std::filesystem::path path;
  std::string format;
};

struct ExportInput {
  ExportModel model;  // `points` are grey
  std::optional<MapOfRun> map;
  std::optional<ImageSequence> sequence;
  std::string session;  // the name of the sequence
  std::optional<MasksOfRun> masks;
  // The files and folders that an export must not be written to.
  std::vector<std::filesystem::path> read;
  std::vector<std::string> notes;  // what is missing, for the user
};

// Reads what a format needs. The map is also used for ExportNeed::kScene if there is one, because
// it tells the colours of the points. Throws InputError, which names the file and what to do, if
// something that the format needs is missing or broken, or if the map is not the run's.
ExportInput ReadExportInput(const ExportSource& source, ExportNeed need);

}  // namespace hullslam
