// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <utility>

#include "arrays.h"
#include "hullslam/system/known_pose_mapper.h"
#include "live_system.h"
#include "module.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

struct LiveMapper {
  explicit LiveMapper(const SystemOptions& options) : camera(options.camera), mapper(options) {}

  const PinholeCamera camera;
  std::mutex mutex;
  KnownPoseMapper mapper;
};

void AddView(LiveMapper& live, const py::object& world_from_cam, const MaskList& masks,
             const py::object& depth, double timestamp) {
  const Rigid3 pose = ToPose(world_from_cam, "world_from_cam");
  const PixelSpan depths = SpanOfDepth(depth, {live.camera.width, live.camera.height});
  CheckStamp(timestamp);
  WithoutGil([&] {
    const std::lock_guard lock(live.mutex);
    live.mapper.AddView(timestamp, pose, masks.masks, depths.image);
  });
}

MapView SnapshotOf(LiveMapper& live) {
  return WithoutGil([&] {
    const std::lock_guard lock(live.mutex);
    return MapView{std::make_shared<const Map>(live.mapper.Snapshot()), live.camera};
  });
}

}  // namespace

void BindKnownPoseMapper(py::module_& module) {
  py::class_<LiveMapper>(module, "KnownPoseMapper",
                         "Maps objects from masks and known poses, for example of odometry or\n"
                         "motion capture. It needs no images.")
      .def(py::init([](const SettingsTable& settings) {
             return std::make_unique<LiveMapper>(settings.options);
           }),
           py::arg("settings"))
      .def("add_view", &AddView, py::arg("world_from_cam"), py::arg("masks"),
           py::arg("depth") = py::none(), py::kw_only(), py::arg("timestamp"),
           "Adds a view; a view should differ from the one before.\n\n"
           "world_from_cam: (4, 4) pose of the camera (x right, y down, z forward, m).\n"
           "masks: Masks of the image. depth: as in System.track(), or None.\n"
           "timestamp: s.\n"
           "Raises InputError for a pose that is not finite or no rigid transform, and for masks\n"
           "or depth that do not fit the camera; a refused view changes nothing.")
      .def_property_readonly("map", &SnapshotOf,
                             "A snapshot of the views as keyframes, and of the objects: Map.")
      .def_property_readonly(
          "warnings",
          [](LiveMapper& live) {
            return WithoutGil([&] {
              const std::lock_guard lock(live.mutex);
              return live.mapper.warnings();
            });
          },
          "What is odd about the views so far, such as poses in another unit than the depth:\n"
          "list of str.");
}

}  // namespace hullslam::python
