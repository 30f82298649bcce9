// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/id.h"

namespace hullslam {

// A hash table from ids to values, with open addressing. Its size depends only on the number of its
// entries, not on the number of ids in the map. The entries are in the order in which they were
// added, so the same calls give the same results.
template <typename IdType, typename Value>
class IdMap {
 public:
  // The value of an id. A new value is added if there is none. The reference is valid until the
  // next value is added.
  Value& operator[](IdType id) {
    if (2 * (entries_.size() + 1) > places_.size()) {
      Grow();
    }
    uint32_t& place = places_[PlaceOf(id)];
    if (place == kFree) {
      place = static_cast<uint32_t>(entries_.size());
      entries_.emplace_back(id, Value());
    }
    return entries_[place].second;
  }

  // Null if the id has no value.
  const Value* Find(IdType id) const {
    const uint32_t place = places_.empty() ? kFree : places_[PlaceOf(id)];
    return place != kFree ? &entries_[place].second : nullptr;
  }

  const std::vector<std::pair<IdType, Value>>& entries() const { return entries_; }

  // Returns all entries and leaves the table empty.
  std::vector<std::pair<IdType, Value>> Take() {
    places_.clear();
    return std::exchange(entries_, {});
  }

 private:
  static constexpr uint32_t kFree = UINT32_MAX;

  // Where the id is in places_, or where it should be put: the first place from its hash on that
  // has this id or is free. The factor is 2^32 over the golden ratio (Knuth, The Art of Computer
  // Programming 3, 6.4).
  size_t PlaceOf(IdType id) const {
    const size_t mask = places_.size() - 1;
    size_t place = ((id.value * uint32_t{2654435769}) >> 7) & mask;
    while (places_[place] != kFree && !(entries_[places_[place]].first == id)) {
      place = (place + 1) & mask;
    }
    return place;
  }

  void Grow() {
    places_.assign(std::max<size_t>(16, 2 * places_.size()), kFree);
    for (uint32_t i = 0; i < entries_.size(); ++i) {
      places_[PlaceOf(entries_[i].first)] = i;
    }
  }

  std::vector<uint32_t>
      places_;  // indices into entries_; as many as a power of two, half of them free
  std::vector<std::pair<IdType, Value>> entries_;
};

// A set of ids of one map. At most one id of the set may have a given slot. The set has one bit per
// slot for those groups of 64 slots that contain a member, and four bytes for every group up to its
// largest member. So a set that is needed for a moment is cheap, also in a large map.
template <typename IdType>
class IdSet {
 public:
  // Returns whether the id is new in the set. Throws CheckError if the id is not valid, or if the
  // set has another id with this slot.
  bool Insert(IdType id) {
    Check(id.IsValid(), "an id that is not valid cannot be in a set");
    const uint32_t number = id.slot() / kGroupSize;
    if (number >= places_.size()) {
      places_.resize(number + 1, 0);
    }
    if (places_[number] == 0) {
      places_[number] = static_cast<uint32_t>(groups_.size());
      groups_.emplace_back();
    }
    Group& group = groups_[places_[number]];
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
    const uint32_t number = id.slot() / kGroupSize;
    const Group& group = groups_[number < places_.size() ? places_[number] : 0];
    return (group.bits & BitOf(id)) != 0 && group.IdAt(id.slot()) == id;
  }

  size_t size() const { return size_; }

  // All members by increasing id.
  std::vector<IdType> Sorted() const {
    std::vector<IdType> ids;
    ids.reserve(size_);
    for (uint32_t number = 0; number < places_.size(); ++number) {
      const Group& group = groups_[places_[number]];
      for (uint64_t left = group.bits; left != 0; left &= left - 1) {
        const auto bit = static_cast<uint32_t>(std::countr_zero(left));
        ids.push_back(group.IdAt(number * kGroupSize + bit));
      }
    }
    return ids;
  }

 private:
  static constexpr uint32_t kGroupSize = 64;

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

  static uint64_t BitOf(IdType id) { return uint64_t{1} << (id.slot() % kGroupSize); }

  std::vector<uint32_t> places_;                       // of the groups in groups_; 0: no member
  std::vector<Group> groups_ = std::vector<Group>(1);  // the first one stays empty
  size_t size_ = 0;
};

// The indices of the ids that are valid, in increasing order.
template <typename IdType>
std::vector<uint32_t> IndicesOfValid(const std::vector<IdType>& ids) {
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < ids.size(); ++i) {
    if (ids[i].IsValid()) {
      indices.push_back(i);
    }
  }
  return indices;
}

}  // namespace hullslam
