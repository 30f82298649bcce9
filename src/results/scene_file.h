// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/scene.h"

namespace hullslam {

// The version of the format of scene.json.
inline constexpr uint32_t kSceneFileVersion = 1;

// The members `box`, `round_axes` and `undetermined_axes` of an object, which objects.json has,
// too.
nlohmann::ordered_json BodyJson(const SceneObject& object);

// The text of `scene.json` (docs/scene.md). The same scene gives the same bytes. Throws CheckError
// for values that are not finite.
std::string FormatScene(const Scene& scene);

// Reads `scene.json`. Throws InputError, with the name of the file and the path of the key, if it
// does not have the format of FormatScene(), if another version of HullSLAM wrote it, or if a
// relation or a surface names an object that is not in the file.
Scene ReadScene(const std::filesystem::path& path);

}  // namespace hullslam
