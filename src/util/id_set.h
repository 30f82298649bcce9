// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/id.h"
#include "util/id_map.h"

namespace hullslam {

// A set of ids of one map. At most one id of the set may have a given slot. The set has one bit per
// slot, but only for those groups of 64 slots that contain a member. So adding an id is cheap, and
// its cost does not depend on the number of ids in the map.
template <typename IdType>
class IdSet {
 public:
  // Returns whether the id is new in the set. Throws CheckError if the set has another id with this
  // slot.
  bool Insert(IdType id) {
    Group& group = groups_[GroupOf(id)];
    const uint64_t bit = BitOf(id);
    if ((group.bits & bit) != 0) {
      Check(group.IdAt(id.slot()) == id, "two ids with the same slot are from different maps");
      return false;
    }
    group.bits |= bit;
    group.Remember(id);
    ++size_;
    return true;
  }

  bool Contains(IdType id) const {
    const Group* group = groups_.Find(GroupOf(id));
    return group != nullptr && (group->bits & BitOf(id)) != 0 && group->IdAt(id.slot()) == id;
  }

  size_t size() const { return size_; }

  // All members by increasing id.
  std::vector<IdType> Sorted() const {
    std::vector<uint32_t> numbers;
    for (const auto& [number, group] : groups_.entries()) {
      numbers.push_back(number.value);
    }
    std::sort(numbers.begin(), numbers.end());
    std::vector<IdType> ids;
    ids.reserve(size_);
    for (const uint32_t number : numbers) {
      const Group& group = *groups_.Find(GroupId(number));
      for (uint64_t left = group.bits; left != 0; left &= left - 1) {
        const auto bit = static_cast<uint32_t>(std::countr_zero(left));
        ids.push_back(group.IdAt(number * kGroupSize + bit));
      }
    }
    return ids;
  }

 private:
  static constexpr uint32_t kGroupSize = 64;
  using GroupId = Id<struct IdGroupTag>;

  struct WithoutGenerations {
    uint64_t bits = 0;
    void Remember(IdType) {}
    IdType IdAt(uint32_t slot) const { return IdType(slot); }
  };
  struct WithGenerations {
    uint64_t bits = 0;
    std::array<uint8_t, kGroupSize> generations;  // only valid for slots whose bit is set
    void Remember(IdType id) {
      generations[id.slot() % kGroupSize] = static_cast<uint8_t>(id.generation());
    }
    IdType IdAt(uint32_t slot) const { return IdType(slot, generations[slot % kGroupSize]); }
  };
  using Group = std::conditional_t<IdType::kHasGeneration, WithGenerations, WithoutGenerations>;

  static GroupId GroupOf(IdType id) { return GroupId(id.slot() / kGroupSize); }
  static uint64_t BitOf(IdType id) { return uint64_t{1} << (id.slot() % kGroupSize); }

  IdMap<GroupId, Group> groups_;
  size_t size_ = 0;
};

}  // namespace hullslam
