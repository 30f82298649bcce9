// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/euroc_states.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>

#include "files/plausible.h"
#include "hullslam/util/error.h"
#include "sequences/image_list.h"
#include "util/text.h"

namespace hullslam {

double EurocSeconds(const TextRow& row) {
  const std::string_view text = row.columns.at(0);
  uint64_t nanoseconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), nanoseconds);
  if (error != std::errc() || end != text.data() + text.size()) {
    row.Fail(fmt::format("timestamp is '{}', expected a whole number of nanoseconds",
                         ShowText(text, 40)));
  }
  constexpr double kNanoseconds = 1e9;
  return static_cast<double>(nanoseconds) / kNanoseconds;
}

Trajectory ReadEurocStates(const std::filesystem::path& file, const Rigid3& body_from_cam) {
  constexpr size_t kColumns = 8;  // further ones are velocity and biases
  Trajectory trajectory;
  ForEachRow(file, [&](const TextRow& row) {
    CheckColumns(row, kColumns, "timestamp [ns], p_x, p_y, p_z, q_w, q_x, q_y, q_z");
    const double stamp = EurocSeconds(row);
    if (!trajectory.empty() && stamp <= trajectory.back().timestamp) {
      row.Fail(fmt::format("time stamp {:.6f} does not come after the previous one, {:.6f}", stamp,
                           trajectory.back().timestamp));
    }
    Rigid3 world_from_body;
    world_from_body.translation = {row.Number(1, "p_x", kMostMetres),
                                   row.Number(2, "p_y", kMostMetres),
                                   row.Number(3, "p_z", kMostMetres)};
    world_from_body.rotation = row.Rotation(4, 5, 6, 7);
    trajectory.push_back({stamp, world_from_body * body_from_cam});
  });
  if (trajectory.empty()) {
    throw InputError(file.string() + ": has no poses");
  }
  return trajectory;
}

}  // namespace hullslam
