// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace hullslam {

// Whether the ids of this kind of entity are used again after an entity was erased
// (util/recycling_table.h).
template <typename Tag>
inline constexpr bool kIsRecycled = false;
template <>
inline constexpr bool kIsRecycled<struct LandmarkTag> = true;

// The number of an entity. Ids of different kinds of entities do not convert into each other. The
// default value is invalid.
//
// Most ids are assigned in increasing order and are never used again. An id of a recycled kind
// consists of a slot, which is used again, and of a generation, which counts these uses. So the id
// of an erased entity never equals a later entity's id. Ids of a recycled kind are ordered by their
// slots, so their order does not tell which is older.
template <typename Tag>
struct Id {
  static constexpr bool kHasGeneration = kIsRecycled<Tag>;
  static constexpr uint32_t kInvalid = std::numeric_limits<uint32_t>::max();
  static constexpr int kSlotBits =
      24;  // lower bits of `value` that are the slot, in recycled kinds
  static constexpr uint32_t kMaxSlot = (uint32_t{1} << kSlotBits) - 1;
  static constexpr uint32_t kMaxGeneration = kInvalid >> kSlotBits;

  uint32_t value = kInvalid;

  constexpr Id() = default;
  constexpr explicit Id(uint32_t number) : value(number) {}
  constexpr Id(uint32_t slot, uint32_t generation) requires kIsRecycled<Tag>
      : value(generation << kSlotBits | slot) {}
  constexpr bool IsValid() const { return value != kInvalid; }

  // The number of the slot in which a table keeps the entity.
  constexpr uint32_t slot() const {
    if constexpr (kIsRecycled<Tag>) {
      return value & kMaxSlot;
    } else {
      return value;
    }
  }
  constexpr uint32_t generation() const requires kIsRecycled<Tag> { return value >> kSlotBits; }

  friend constexpr bool operator==(const Id&, const Id&) = default;
  friend constexpr std::strong_ordering operator<=>(const Id& a, const Id& b) {
    return a.Rank() <=> b.Rank();
  }

 private:
  constexpr uint32_t Rank() const {
    if constexpr (kIsRecycled<Tag>) {
      return std::rotl(value, 32 - kSlotBits);  // the slot first, then the generation
    } else {
      return value;
    }
  }
};

using FrameId = Id<struct FrameTag>;
using KeyframeId = Id<struct KeyframeTag>;
using LandmarkId = Id<struct LandmarkTag>;
using ObjectId = Id<struct ObjectTag>;
using IslandId = Id<struct IslandTag>;

}  // namespace hullslam

template <typename Tag>
struct std::hash<hullslam::Id<Tag>> {
  size_t operator()(const hullslam::Id<Tag>& id) const noexcept {
    return std::hash<uint32_t>()(id.value);
  }
};
