// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

namespace hullslam {

// Arrays of numbers as the page reads them: an object with one key, f32, u32 or u8, whose value has
// the numbers in base64, least significant byte first (docs/live_view.md).
nlohmann::json PackArray(std::span<const float> values);
nlohmann::json PackArray(std::span<const uint32_t> values);
nlohmann::json PackArray(std::span<const uint8_t> values);

}  // namespace hullslam
