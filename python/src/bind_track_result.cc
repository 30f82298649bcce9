// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arrays.h"
#include "hullslam/map/messages.h"
#include "module.h"

namespace hullslam::python {
namespace {

// A row of the structured array of matches.
struct MatchRow {
  int64_t keypoint;
  int64_t landmark;
  std::array<float, 2> pixel;
};

// One object that was seen in a frame.
struct SeenObject {
  Detection detection;
  std::optional<int64_t> object;
};

std::optional<int64_t> NumberOrNone(ObjectId id) {
  return id.IsValid() ? std::optional(ToNumber(id)) : std::nullopt;
}

py::object IfTracked(const FrameReport& report, const Rigid3& pose) {
  return report.tracked.state == TrackingState::kTracked ? py::object(ToArray(pose))
                                                         : py::object(py::none());
}

// What `get` gives of the odometry of the frame; None before the first pose.
template <typename Get>
py::object OfOdometry(const FrameReport& report, const Get& get) {
  const std::optional<Odometry>& odometry = report.tracked.odometry;
  return odometry ? py::object(get(*odometry)) : py::object(py::none());
}

py::object CovarianceOf(const FrameReport& report) {
  if (!report.tracked.covariance) {
    return py::none();
  }
  return py::array_t<double>({6, 6}, report.tracked.covariance->data());  // symmetric
}

py::array_t<MatchRow> MatchesOf(const FrameReport& report) {
  std::vector<MatchRow> rows;
  for (size_t i = 0; i < report.landmarks.size(); ++i) {
    if (report.landmarks[i].IsValid()) {
      const Eigen::Vector2f& pixel = report.frame->features.keypoints[i].undistorted;
      rows.push_back({.keypoint = static_cast<int64_t>(i),
                      .landmark = ToNumber(report.landmarks[i]),
                      .pixel = {pixel.x(), pixel.y()}});
    }
  }
  return py::array_t<MatchRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

std::vector<SeenObject> SeenObjectsOf(const FrameReport& report) {
  std::vector<SeenObject> objects;
  for (size_t i = 0; i < report.frame->detections.size(); ++i) {
    const ObjectId object = i < report.objects.size() ? report.objects[i] : ObjectId();
    objects.push_back({report.frame->detections[i], NumberOrNone(object)});
  }
  return objects;
}

py::array_t<double> BoxOf(const SeenObject& object) {
  const Eigen::AlignedBox2d& box = object.detection.box;
  const std::array<double, 4> values = {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
  return py::array_t<double>(4, values.data());
}

}  // namespace

void BindTrackResult(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(MatchRow, keypoint, landmark, pixel);
  py::class_<SeenObject>(module, "SeenObject", "An object that a mask shows in one frame.")
      .def_property_readonly(
          "label", [](const SeenObject& o) { return o.detection.label; }, "The class of the mask.")
      .def_property_readonly(
          "score", [](const SeenObject& o) { return o.detection.score; },
          "The score of the mask, 0 to 1.")
      .def_readonly("object", &SeenObject::object,
                    "The id of the mapped object that it shows (MapObject.id), or None.")
      .def_property_readonly(
          "hull", [](const SeenObject& o) { return ToArray(o.detection.hull); },
          "(points, 2) convex hull of the mask, undistorted pixels.")
      .def_property_readonly("box", &BoxOf,
                             "(4,) least x and y and largest x and y of the hull, undistorted px.");
  py::class_<MapEvent>(module, "MapEvent", "What happened to the camera or to the map.")
      .def_property_readonly(
          "kind", [](const MapEvent& e) { return ToString(e.kind); },
          "'lost', 'relocalised', 'island_begun', 'island_joined', 'loop_closed', 'rescaled',\n"
          "'adjusted', 'object_born', 'object_fused', 'object_moved' or 'object_gone'.")
      .def_property_readonly(
          "object", [](const MapEvent& e) { return NumberOrNone(e.object); },
          "The id of the object (MapObject.id), or None.")
      .def_property_readonly(
          "kept", [](const MapEvent& e) { return NumberOrNone(e.kept); },
          "The id of the object that it was fused with, or None.")
      .def_readonly("mean_moved", &MapEvent::mean_moved,
                    "The mean distance by which a correction has moved keyframes, m.")
      .def_readonly("most_moved", &MapEvent::most_moved,
                    "The largest such distance, or that by which an object has moved, m.")
      .def_readonly("scale", &MapEvent::scale, "The factor by which lengths in the map have grown.")
      .def("__repr__", [](const MapEvent& e) {
        return "<hullslam.MapEvent " + std::string(ToString(e.kind)) + ">";
      });
  py::class_<FrameReport>(module, "TrackResult", "What track() found in one frame.")
      .def_property_readonly(
          "state", [](const FrameReport& r) { return ToString(r.tracked.state); },
          "'tracked', 'lost', or 'initialising': there is no map yet.")
      .def_property_readonly(
          "reason", &FrameReport::Reason,
          "Why the frame has no pose (docs/my-run-fails.md); None if it has one,\n"
          "and while the mode 'rgbd' waits for a first image with features.")
      .def_property_readonly(
          "cam_from_world",
          [](const FrameReport& r) { return IfTracked(r, r.tracked.cam_from_world); },
          "(4, 4): maps points of the world frame to the camera frame (x right, y down, z\n"
          "forward, m), at the time of tracking. None if the frame is not tracked. The trajectory\n"
          "of the system has the pose after later corrections.")
      .def_property_readonly(
          "world_from_cam",
          [](const FrameReport& r) { return IfTracked(r, r.tracked.world_from_cam()); },
          "(4, 4): its inverse, the pose of the camera in the world; or None.")
      .def_property_readonly(
          "timestamp", [](const FrameReport& r) { return r.tracked.timestamp; },
          "Time stamp of the frame, s.")
      .def_property_readonly(
          "frame", [](const FrameReport& r) { return ToNumber(r.tracked.frame); },
          "The number of the frame.")
      .def_property_readonly(
          "inliers", [](const FrameReport& r) { return r.tracked.inliers; },
          "The number of landmarks that agree with the pose.")
      .def_property_readonly(
          "matches", &MatchesOf,
          "Structured array (N,) of the keypoints that show a landmark:\n"
          "keypoint, its index; landmark, its id in the map before this frame; pixel\n"
          "(2,), undistorted.")
      .def_readonly("events", &FrameReport::events,
                    "What has happened since the frame before: list of MapEvent.")
      .def_property_readonly("covariance", &CovarianceOf,
                             "(6, 6) of the error of the pose (rotation in rad, translation), in\n"
                             "the axes of the camera, with the drift of the map; or None.")
      .def_property_readonly(
          "quality", [](const FrameReport& r) { return r.tracked.quality; },
          "0 to 1: the least probability that the pose places a point in a corner of the image\n"
          "at most 1 px from where the landmarks tell.")
      .def_property_readonly(
          "prior", [](const FrameReport& r) { return ToString(r.tracked.prior); },
          "How `motion` was used: 'none', 'fused' with the landmarks, 'dropped' because they\n"
          "contradict it, or 'alone' where the image shows too few of them.")
      .def_property_readonly(
          "odom_from_cam",
          [](const FrameReport& r) {
            return OfOdometry(r, [](const Odometry& o) { return ToArray(o.odom_from_cam); });
          },
          "(4, 4): the pose in the world of the odometry, which never jumps but drifts. It goes\n"
          "on when the camera is lost. None before the first pose.")
      .def_property_readonly(
          "map_from_odom",
          [](const FrameReport& r) {
            return OfOdometry(r, [](const Odometry& o) { return ToArray(o.map_from_odom); });
          },
          "(4, 4): world_from_cam = map_from_odom @ odom_from_cam at tracked frames; or None.")
      .def_property_readonly(
          "corrected_at",
          [](const FrameReport& r) {
            return OfOdometry(r,
                              [](const Odometry& o) { return py::int_(ToNumber(o.corrected_at)); });
          },
          "The number of the last frame at which map_from_odom may have jumped; or None.")
      .def_property_readonly(
          "odometry_step",
          [](const FrameReport& r) {
            return OfOdometry(r, [](const Odometry& o) { return py::cast(ToString(o.step)); });
          },
          "Where the last step of the odometry is from: 'begun', 'measured', 'prior',\n"
          "'predicted' with the last velocity, or 'stopped'; or None.")
      .def_property_readonly(
          "linear_velocity",
          [](const FrameReport& r) {
            return OfOdometry(r, [](const Odometry& o) { return ToArray(o.linear_velocity); });
          },
          "(3,) m/s of the camera since the frame before, in its axes; or None.")
      .def_property_readonly(
          "angular_velocity",
          [](const FrameReport& r) {
            return OfOdometry(r, [](const Odometry& o) { return ToArray(o.angular_velocity); });
          },
          "(3,) rad/s, likewise; or None.")
      .def_property_readonly("objects", &SeenObjectsOf,
                             "The objects that masks show in this frame: list of SeenObject.")
      .def("__repr__", [](const FrameReport& r) {
        const std::string reason(r.Reason().value_or(""));
        return "<hullslam.TrackResult at " + fmt::format("{:f}", r.tracked.timestamp) +
               " s: " + std::string(ToString(r.tracked.state)) +
               (reason.empty() ? "" : ", " + reason) + ">";
      });
}

}  // namespace hullslam::python
