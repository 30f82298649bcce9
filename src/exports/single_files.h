// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "exports/export_input.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "map/located_landmarks.h"
#include "mesh/make_mesh.h"

namespace hullslam {

// The poses world_from_cam as KITTI's odometry benchmark has them: one line per pose, the first
// three rows of the 4 x 4 matrix, row by row. There are no time stamps.
std::string FormatKittiPoses(const Trajectory& trajectory);

// The poses world_from_cam as a ground truth of EuRoC: a header, then one line per pose with the
// time stamp in whole nanoseconds, the position and the quaternion (w first), separated by commas.
// (EuRoC's own ground truth has the poses of the body, and velocities in further columns.)
std::string FormatEurocPoses(const Trajectory& trajectory);

// PLY files of PlyWriter (results/ply_file.h).

// Only the points.
std::string FormatPointsPly(std::span<const ColouredPoint> points);

// The points, each keyframe as an orange pyramid that opens in the direction in which it looks, and
// the objects as shapes in the colours of their classes. Faces are `uchar 3, int a b c`.
std::string FormatScenePly(const ExportModel& model, ObjectShape shape);

// A binary glTF 2.0 file (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html) with one
// scene: a node "map" that turns the world of the map so that y points up, and in it the points,
// the path of the camera as a line, a camera for each keyframe, and a node for each object, which
// has the name of the class and further values in `extras`. The box of an ellipsoid is a child of
// its node, such as "cup box", with the edges as lines. Lengths are in the unit of the map. If
// the scene does not know what is upwards, it is where the top of the first image points.
std::string FormatGlb(const ExportModel& model, ObjectShape shape);

// A mesh in the same format: in the node "map" a node "scene", and for each object a node with its
// class and id as name, which `extras` has too. The colours are those of the vertices, without
// light (KHR_materials_unlit).
std::string FormatMeshGlb(const Mesh& mesh);

// A mesh as a binary little-endian PLY file with the vertices and faces of PlyWriter. Vertices also
// have `int object`: the id of their object, -1 for the scene.
std::string FormatMeshPly(const Mesh& mesh);

// The map as a pose graph in the text format of g2o (https://github.com/RainerKuemmerle/g2o):
// VERTEX_SE3:QUAT for each keyframe (its id; the pose world_from_cam), of which the first is fixed;
// VERTEX_TRACKXYZ for each landmark (ids after the keyframes); EDGE_SE3:QUAT for each pair
// of keyframes that are covisible, joined by a loop, or parent and child in the spanning tree.
//
// The measurements of the edges agree with the map, so its graph is at its optimum as it is. The
// information of an edge comes from the landmarks that both keyframes observe: of their keypoints
// in the second keyframe, with the landmarks fixed in the first one. It is too large by the
// uncertainty of the landmarks. With fewer than six common landmarks it is the identity.
std::string FormatG2o(const Map& map, const LocatedLandmarks& located, const Sensor& sensor);

}  // namespace hullslam
