// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "report/object_results.h"
#include "results/output_folder.h"
#include "scene/scene.h"

namespace hullslam {

// The version of the format of objects.json and objects_observations.json.
inline constexpr uint32_t kObjectFileVersion = 2;

// The objects of a run are in two files, so that the list of the objects stays small
// (docs/outputs.md). Together they have everything that is needed to judge the shapes of the
// objects again. Pixels are rounded to 0.01, metres to 1e-9. The same report gives the same bytes.
// All functions throw CheckError for values that are not finite.

// The text of `objects.json`: the camera and the objects, without their observations. Objects of
// the scene have its boxes and free axes.
std::string FormatObjects(const ObjectResults& report, const Scene& scene = {});
// The text of `objects_observations.json`: the observations of all objects.
std::string FormatObservations(const ObjectResults& report);
// The text of `objects.csv`: a table with one line per object.
std::string FormatObjectsCsv(const ObjectResults& report);

// Reads `objects.json`, whose path this is, and `objects_observations.json` from the same folder.
// Throws InputError, with the name of the file and the path of the key, if a file does not have the
// format of FormatObjects() and FormatObservations(), or if the two files are from different runs.
ObjectResults ReadObjects(const std::filesystem::path& path);
// The same with the path of the file of observations. Both may be the same file.
ObjectResults ReadObjects(const std::filesystem::path& path,
                          const std::filesystem::path& observations);

// objects.json, objects_observations.json, objects.csv, objects.ply and scene.json, so that they
// can be written together with the other files of a run.
std::vector<FileContent> ObjectFiles(const ObjectResults& report, const Scene& scene);

}  // namespace hullslam
