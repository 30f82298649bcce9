// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace hullslam {

// The number of an entity. Ids of different kinds of entities do not convert into each other. The
// default value is invalid. Ids are assigned in increasing order and are never reused.
template <typename Tag>
struct Id {
  static constexpr uint32_t kInvalid = std::numeric_limits<uint32_t>::max();

  uint32_t value = kInvalid;

  constexpr Id() = default;
  constexpr explicit Id(uint32_t number) : value(number) {}
  constexpr bool IsValid() const { return value != kInvalid; }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using FrameId = Id<struct FrameTag>;
using KeyframeId = Id<struct KeyframeTag>;
using LandmarkId = Id<struct LandmarkTag>;
using ObjectId = Id<struct ObjectTag>;

}  // namespace hullslam

template <typename Tag>
struct std::hash<hullslam::Id<Tag>> {
  size_t operator()(const hullslam::Id<Tag>& id) const noexcept {
    return std::hash<uint32_t>()(id.value);
  }
};
