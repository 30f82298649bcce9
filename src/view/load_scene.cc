// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/load_scene.h"

#include <optional>
#include <system_error>

#include "eval/object_metrics.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "results/scene_file.h"
#include "scene/make_scene.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

Scene SceneOfMap(const fs::path& path) {
  const StoredMap stored = ReadMap(path);
  return MakeScene(stored.map, MeasuredObjects(stored.map, stored.settings.camera, path),
                   std::nullopt);
}

}  // namespace

Scene LoadScene(const fs::path& source) {
  std::error_code error;
  if (!fs::is_directory(source, error)) {
    return SceneOfMap(source);
  }
  const fs::path file = source / "scene.json";
  if (!fs::exists(file, error)) {
    const bool has_objects = fs::exists(source / "objects.json", error);
    throw InputError(source.string() + ": has no scene.json, expected the output folder of a run " +
                     (has_objects ? "of this version; repeat the run" : "with --masks"));
  }
  return ReadScene(file);
}

}  // namespace hullslam
