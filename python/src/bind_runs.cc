// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "arrays.h"
#include "exports/export_run.h"
#include "files/read_file.h"
#include "files/staged_file.h"
#include "hullslam/tracking/tracking_options.h"
#include "module.h"
#include "results/finished_run.h"
#include "results/scene_file.h"
#include "types.h"
#include "util/text.h"
#include "view/load_scene.h"
#include "view/report.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

namespace fs = std::filesystem;

py::object FromJson(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

// A file of the run as a dict; None if the run has no such file.
py::object ReadJsonOf(const FinishedRun& run, const std::string& name) {
  return run.Has(name) ? FromJson(ReadText(run.folder / name)) : py::object(py::none());
}

// (N, 3) of one row per element.
template <typename Number, typename Rows>
py::array_t<Number> ToRows(const Rows& rows) {
  py::array_t<Number> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}});
  for (size_t i = 0; i < rows.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      array.mutable_at(static_cast<py::ssize_t>(i), k) = rows[i][static_cast<size_t>(k)];
    }
  }
  return array;
}

py::object ReadPoints(const FinishedRun& run) {
  const std::optional<PlyPoints> points = WithoutGil([&] { return run.ReadLandmarkPoints(); });
  return points ? py::object(py::make_tuple(ToRows<float>(points->positions),
                                            ToRows<uint8_t>(points->colours)))
                : py::object(py::none());
}

void Warn(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    py::module_::import("warnings").attr("warn")(note);
  }
}

std::string Export(const fs::path& source, const std::string& format, const fs::path& output,
                   const std::string& objects_as, bool text,
                   const std::set<std::string>& masked_classes, bool force) {
  const ObjectShape shape = Choose<ObjectShape>(
      "objects_as", objects_as,
      {{"ellipsoids", ObjectShape::kEllipsoids}, {"boxes", ObjectShape::kBoxes}});
  const FinishedExport written = WithoutGil([&] {
    return ExportRun(
        {.input = source, .map = {}, .sequence = {}}, format,
        {.output = output, .shape = shape, .as_text = text, .masked_classes = masked_classes},
        force);
  });
  Warn(written.notes);
  return written.content;
}

fs::path WriteReport(const fs::path& source, const std::optional<fs::path>& output) {
  const fs::path file = output.value_or(DefaultReportPath(source));
  const Report report = WithoutGil([&] { return MakeReportOf(source, HULLSLAM_VERSION); });
  WriteFileAtomically(file, report.page);
  Warn(report.notes);
  return file;
}

void BindRun(py::module_& module) {
  py::class_<FinishedRun>(module, "Run", "The results of a finished run (docs/outputs.md).")
      .def_readonly("folder", &FinishedRun::folder, "The output folder.")
      .def_property_readonly(
          "summary", [](const FinishedRun& run) { return FromJson(run.summary->dump()); },
          "The content of summary.json: dict.")
      .def_property_readonly(
          "trajectory", [](const FinishedRun& run) { return PoseList{run.ReadPoses()}; },
          "The Trajectory of all tracked frames.")
      .def_property_readonly(
          "keyframes", [](const FinishedRun& run) { return PoseList{run.ReadKeyframePoses()}; },
          "The Trajectory of the keyframes.")
      .def_property_readonly("points", &ReadPoints,
                             "The landmarks: positions (N, 3) float32, world frame, and colours\n"
                             "(N, 3) uint8; None if the run has not written them.")
      .def_property_readonly(
          "objects", [](const FinishedRun& run) { return ReadJsonOf(run, "objects.json"); },
          "The content of objects.json: dict; None for a run without masks.");
}

}  // namespace

void BindRuns(py::module_& module) {
  BindRun(module);
  module.def(
      "open_run", [](const fs::path& folder) { return OpenFinishedRun(folder); }, py::arg("folder"),
      "Opens the output folder of a finished run: Run. Raises InputError if there is none.");
  module.def(
      "scene",
      [](const fs::path& source) {
        return FromJson(WithoutGil([&] { return FormatScene(LoadScene(source)); }));
      },
      py::arg("source"),
      "The objects, relations and surfaces of a run (its folder) or of a saved map, as in\n"
      "scene.json (docs/scene.md): dict. Raises InputError for a run without masks.");
  module.def("report", &WriteReport, py::arg("source"), py::arg("output") = py::none(),
             "Writes the report of a run (its folder) or of a saved map, as `hullslam view "
             "--report` does.\n"
             "Returns its path.\n\n"
             "output: the file; None: report.html in the folder, or beside the map.");
  module.def("export", &Export, py::arg("source"), py::arg("format"), py::arg("output"),
             py::kw_only(), py::arg("objects_as") = "ellipsoids", py::arg("text") = false,
             py::arg("masked_classes") = SplitNames(TrackingOptions().dynamic_classes),
             py::arg("force") = false,
             "Writes a run (its folder) or a saved map in a format of other programs\n"
             "(docs/exports.md). Returns a text about what was written.\n\n"
             "format: such as 'colmap' or 'gltf'. output: the file or folder to write.\n"
             "objects_as: 'ellipsoids' or 'boxes' (gltf, ply). text: text files (colmap).\n"
             "masked_classes: left out of training (nerfstudio). force: replace what is there.\n"
             "Raises InputError if the run lacks something that the format needs.");
}

}  // namespace hullslam::python
