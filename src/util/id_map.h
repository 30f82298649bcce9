// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include "hullslam/util/id.h"

namespace hullslam {

// A hash table from ids to values. Its size depends only on the number of its entries, not on the
// number of ids in the map. The entries are in the order in which they were added, so the same
// calls give the same results.
template <typename IdType, typename Value>
class IdMap {
 public:
  // The value of an id. A new value is added if there is none. The reference is valid until the
  // next value is added.
  Value& operator[](IdType id) {
    const auto [it, is_new] = indices_.try_emplace(id, entries_.size());
    if (is_new) {
      entries_.emplace_back(id, Value());
    }
    return entries_[it->second].second;
  }

  // Null if the id has no value.
  const Value* Find(IdType id) const {
    const auto it = indices_.find(id);
    return it != indices_.end() ? &entries_[it->second].second : nullptr;
  }

  const std::vector<std::pair<IdType, Value>>& entries() const { return entries_; }

  // Returns all entries and leaves the table empty.
  std::vector<std::pair<IdType, Value>> Take() {
    indices_.clear();
    return std::exchange(entries_, {});
  }

 private:
  std::unordered_map<IdType, size_t> indices_;  // indices into entries_
  std::vector<std::pair<IdType, Value>> entries_;
};

}  // namespace hullslam
