// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map_tables.h"

#include <algorithm>

namespace hullslam {

size_t SessionNumber(std::span<const Session> sessions, FrameId frame) {
  const auto next =
      std::upper_bound(sessions.begin(), sessions.end(), frame,
                       [](FrameId id, const Session& session) { return id < session.first_frame; });
  return static_cast<size_t>(next - sessions.begin());
}

}  // namespace hullslam
