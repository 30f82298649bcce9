// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "hullslam/util/id.h"

namespace hullslam {

// A hash table from ids to values. Its size depends on the number of its entries only, not on how
// many ids there are in the map. The entries are in the order in which they were added, so the same
// calls give the same results.
template <typename IdType, typename Value>
class IdMap {
 public:
  // The value of an id. It is added if there is none. Valid until the next one is added.
  Value& operator[](IdType id) {
    if (2 * (entries_.size() + 1) > places_.size()) {
      Grow();
    }
    uint32_t& place = places_[PlaceOf(id)];
    if (place == kNone) {
      place = static_cast<uint32_t>(entries_.size());
      entries_.emplace_back(id, Value());
    }
    return entries_[place].second;
  }

  // Null if the id has no value.
  const Value* Find(IdType id) const {
    if (entries_.empty()) {
      return nullptr;
    }
    const uint32_t place = places_[PlaceOf(id)];
    return place != kNone ? &entries_[place].second : nullptr;
  }

  const std::vector<std::pair<IdType, Value>>& entries() const { return entries_; }

  // Returns all entries and leaves the table empty.
  std::vector<std::pair<IdType, Value>> Take() {
    places_.clear();
    return std::exchange(entries_, {});
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;
  static constexpr size_t kFirstPlaces = 64;

  // Where the index of the id's entry is or should be. The number of places is a power of two, and
  // at least half of them are free.
  size_t PlaceOf(IdType id) const {
    const size_t last = places_.size() - 1;
    size_t place = (id.value * uint64_t{0x9E3779B97F4A7C15}) >> 32 & last;  // Fibonacci hashing
    while (places_[place] != kNone && entries_[places_[place]].first != id) {
      place = (place + 1) & last;
    }
    return place;
  }

  void Grow() {
    places_.assign(places_.empty() ? kFirstPlaces : 2 * places_.size(), kNone);
    for (uint32_t i = 0; i < entries_.size(); ++i) {
      places_[PlaceOf(entries_[i].first)] = i;
    }
  }

  std::vector<uint32_t> places_;  // indices into entries_
  std::vector<std::pair<IdType, Value>> entries_;
};

}  // namespace hullslam
