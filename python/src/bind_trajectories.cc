// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "arrays.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/results/trajectory_file.h"
#include "module.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

PoseList FromArrays(const py::object& timestamps, const py::object& world_from_cam) {
  const py::array_t<double> stamps = ToNumbers(timestamps, "timestamps", 1);
  const py::array_t<double> poses = ToNumbers(world_from_cam, "world_from_cam", 3);
  if (poses.shape(0) != stamps.shape(0) || poses.shape(1) != 4 || poses.shape(2) != 4) {
    throw InputError("world_from_cam has the shape " + std::string(py::str(poses.attr("shape"))) +
                     ", expected (" + std::to_string(stamps.shape(0)) + ", 4, 4)");
  }
  PoseList list;
  for (py::ssize_t i = 0; i < stamps.shape(0); ++i) {
    const std::string name = "pose " + std::to_string(i);
    if (i > 0 && !(stamps.at(i) > stamps.at(i - 1))) {
      throw InputError(name + " has a time stamp that is not after the one before");
    }
    list.poses.push_back({stamps.at(i), ToPose(poses.data(i, 0, 0), name)});
  }
  return list;
}

py::array_t<double> StampsOf(const PoseList& list) {
  py::array_t<double> stamps(static_cast<py::ssize_t>(list.poses.size()));
  for (size_t i = 0; i < list.poses.size(); ++i) {
    stamps.mutable_data()[i] = list.poses[i].timestamp;
  }
  return stamps;
}

py::array_t<double> MatricesOf(const PoseList& list) {
  py::array_t<double> matrices(
      {static_cast<py::ssize_t>(list.poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (size_t i = 0; i < list.poses.size(); ++i) {
    const py::array_t<double> matrix = ToArray(list.poses[i].world_from_cam);
    std::copy_n(matrix.data(), 16, matrices.mutable_data(static_cast<py::ssize_t>(i), 0, 0));
  }
  return matrices;
}

py::array_t<double> PositionsOf(const PoseList& list) {
  py::array_t<double> positions({static_cast<py::ssize_t>(list.poses.size()), py::ssize_t{3}});
  double* value = positions.mutable_data();
  for (const StampedPose& pose : list.poses) {
    value = std::copy_n(pose.world_from_cam.translation.data(), 3, value);
  }
  return positions;
}

// A trajectory, or the path of its file.
Trajectory ToTrajectory(const py::object& source) {
  if (py::isinstance<PoseList>(source)) {
    return source.cast<const PoseList&>().poses;
  }
  return ReadTrajectory(source.cast<std::filesystem::path>());
}

TrajectoryErrors Evaluate(const py::object& groundtruth, const py::object& estimate,
                          const std::string& align, const std::string& pairing,
                          std::optional<double> max_difference) {
  const AteOptions options{
      .alignment = Choose<AlignmentKind>("align", align,
                                         {{"se3", AlignmentKind::kSe3},
                                          {"sim3", AlignmentKind::kSim3},
                                          {"none", AlignmentKind::kNone}}),
      .pairing = Choose<PairingRule>("pairing", pairing,
                                     {{"tum", PairingRule::kTum}, {"evo", PairingRule::kEvo}}),
      .max_difference = max_difference};
  if (max_difference && !(*max_difference > 0.0)) {
    throw InputError("max_difference is " + fmt::format("{:f}", *max_difference) +
                     ", expected a number of seconds > 0");
  }
  const Trajectory reference = ToTrajectory(groundtruth);
  const Trajectory estimated = ToTrajectory(estimate);
  return WithoutGil([&] {
    TrajectoryErrors errors = EvaluateTrajectory(reference, estimated, options);
    if (!errors.ate.ok()) {
      throw InputError(errors.ate.failure);
    }
    return errors;
  });
}

std::optional<double> RmseOf(const RpeResult& rpe, const ErrorStatistics& errors) {
  return rpe.ok() ? std::optional(errors.rmse) : std::nullopt;
}

void BindErrors(py::module_& module) {
  using Errors = TrajectoryErrors;
  py::class_<Errors>(module, "TrajectoryErrors",
                     "The errors of a trajectory after alignment to the true one\n"
                     "(Sturm et al. 2012). Made by evaluate_trajectory().")
      .def_property_readonly(
          "ate_rmse", [](const Errors& e) { return e.ate.errors.rmse; },
          "Root mean square of the distances of paired positions, m.")
      .def_property_readonly(
          "ate_mean", [](const Errors& e) { return e.ate.errors.mean; }, "Mean distance, m.")
      .def_property_readonly(
          "ate_median", [](const Errors& e) { return e.ate.errors.median; }, "Median distance, m.")
      .def_property_readonly(
          "ate_max", [](const Errors& e) { return e.ate.errors.max; }, "Largest distance, m.")
      .def_property_readonly(
          "rpe_translation_rmse", [](const Errors& e) { return RmseOf(e.rpe, e.rpe.translation); },
          "Error of motions of one second, m; None if no two poses are one second apart.")
      .def_property_readonly(
          "rpe_rotation_rmse", [](const Errors& e) { return RmseOf(e.rpe, e.rpe.rotation); },
          "The same for their rotation, degrees.")
      .def_property_readonly(
          "pairs", [](const Errors& e) { return e.ate.pairs; }, "Number of paired poses.")
      .def_property_readonly(
          "coverage", [](const Errors& e) { return e.ate.coverage; },
          "Share of the estimated poses that are paired, 0 to 1.")
      .def_property_readonly(
          "alignment", [](const Errors& e) { return ToString(e.options.alignment); },
          "'se3', 'sim3' or 'none'.")
      .def_property_readonly(
          "scale", [](const Errors& e) { return e.ate.reference_from_estimate.scale; },
          "Metres per unit of length of the estimate; 1 without 'sim3'.")
      .def_property_readonly(
          "groundtruth_from_estimate",
          [](const Errors& e) { return ToArray(e.ate.reference_from_estimate.target_from_source); },
          "(4, 4) rigid motion of the estimate after its positions were multiplied by `scale`.")
      .def("__repr__", [](const Errors& e) {
        return "<hullslam.TrajectoryErrors: ATE RMSE " + fmt::format("{:f}", e.ate.errors.rmse) +
               " m, " + std::to_string(e.ate.pairs) + " pairs, " + ToString(e.options.alignment) +
               ">";
      });
  module.def("evaluate_trajectory", &Evaluate, py::arg("groundtruth"), py::arg("estimate"),
             py::kw_only(), py::arg("align") = "se3", py::arg("pairing") = "tum",
             py::arg("max_difference") = py::none(),
             "Measures the error of a trajectory, as `hullslam evaluate` does\n"
             "(docs/outputs.md).\n\n"
             "groundtruth, estimate: Trajectory, or path of a file in TUM's format.\n"
             "align: 'se3', 'sim3' (monocular) or 'none'.\n"
             "pairing: 'tum' or 'evo', the rule by which poses are paired by time.\n"
             "max_difference: largest difference of paired time stamps, s; None: by the\n"
             "rule, 0.02 or 0.01.\n"
             "Raises InputError if there are fewer than three pairs.");
}

}  // namespace

void BindTrajectories(py::module_& module) {
  py::class_<PoseList>(module, "Trajectory", "Poses of a camera in order of time.")
      .def(py::init(&FromArrays), py::arg("timestamps"), py::arg("world_from_cam"),
           "timestamps: (N,), s, increasing. world_from_cam: (N, 4, 4) homogeneous matrices.")
      .def("__len__", [](const PoseList& list) { return list.poses.size(); })
      .def_property_readonly("timestamps", &StampsOf, "(N,) float64, s.")
      .def_property_readonly(
          "world_from_cam", &MatricesOf,
          "(N, 4, 4) float64: maps points of the camera frame (x right, y down,\n"
          "z forward, m) to the world frame.")
      .def_property_readonly("positions", &PositionsOf,
                             "(N, 3) float64: centres of the camera in the world frame, m.")
      .def(
          "interpolate",
          [](const PoseList& list, double timestamp, double max_gap) -> py::object {
            const std::optional<Rigid3> pose = InterpolatePose(list.poses, timestamp, max_gap);
            return pose ? py::object(ToArray(*pose)) : py::none();
          },
          py::arg("timestamp"), py::arg("max_gap"),
          "The (4, 4) pose at a time stamp (s), between its two neighbours. None before the first\n"
          "pose, after the last one, and in a gap longer than `max_gap` (s).")
      .def(
          "format", [](const PoseList& list) { return FormatTrajectory(list.poses); },
          "The text of a file in TUM's format: timestamp tx ty tz qx qy qz qw.")
      .def(
          "write",
          [](const PoseList& list, const std::filesystem::path& path) {
            WriteTrajectory(path, list.poses);
          },
          py::arg("path"), "Writes a file in TUM's format. It is complete or not there at all.")
      .def("__repr__", [](const PoseList& list) {
        return "<hullslam.Trajectory of " + std::to_string(list.poses.size()) + " poses>";
      });
  module.def(
      "read_trajectory",
      [](const std::filesystem::path& path) { return PoseList{ReadTrajectory(path)}; },
      py::arg("path"),
      "Reads a trajectory in TUM's format. Raises InputError with file and line for bad lines.");
  BindErrors(module);
}

}  // namespace hullslam::python
