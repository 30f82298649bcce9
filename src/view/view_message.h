// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "view/view_model.h"

namespace hullslam {

// Arrays of numbers as the page reads them: an object with one key, f32, u32 or u8, whose value has
// the numbers in base64, least significant byte first (docs/live_view.md).
nlohmann::json PackArray(std::span<const float> values);
nlohmann::json PackArray(std::span<const uint32_t> values);
nlohmann::json PackArray(std::span<const uint8_t> values);

inline constexpr int kViewVersion = 1;

// The parts of the page that the model has, by name (docs/live_view.md). Times are relative to
// `start`, s.
nlohmann::json ViewParts(const ViewModel& model, double start);

// Single parts, or elements of lists of parts, as ViewParts() makes them.
nlohmann::json PictureJson(const ViewPicture& picture, double start);
nlohmann::json ObjectJson(const ViewObject& object, double start);
nlohmann::json TrajectoryJson(const Trajectory& poses, double start);
nlohmann::json EdgesJson(const ViewEdges& edges);
nlohmann::json SurfaceJson(const PlySurface& surface);
// The stretches without a pose, from the content of a summary.json. Entries that are not as
// expected are left out.
nlohmann::json LossesJson(const nlohmann::json& summary, double start);

// A message as JSON in one line, in which every "<" is escaped, so that it may stand inside a
// script element of HTML. Bytes of texts that are not UTF-8 are replaced.
std::string DumpViewMessage(const nlohmann::json& message);

// The message that sets all parts of the page (docs/live_view.md): JSON in one line, in which every
// "<" is escaped, so that it may stand inside a script element of HTML. Times are relative to the
// first pose.
std::string FormatViewMessage(const ViewModel& model);

}  // namespace hullslam
