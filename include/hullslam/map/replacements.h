// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hullslam {

// Remembers by which id another id was replaced. It is needed for messages that have ids of older
// snapshots of a map. Each replacement has the revision of the map at the time: the number of the
// last snapshot in which the replaced id was still in use. There are few replacements, because
// those that are older than all messages are forgotten.
template <typename IdType>
class Replacements {
 public:
  // `revision` does not decrease from call to call. An id is replaced at most once.
  void Add(IdType replaced, IdType by, uint32_t revision) {
    entries_.insert(LowerBound(replaced), {replaced, by, revision});
  }

  // The id that has replaced `replaced`; null if it was not replaced.
  const IdType* Find(IdType replaced) const {
    const auto it = LowerBound(replaced);
    return it != entries_.end() && it->replaced == replaced ? &it->by : nullptr;
  }

  // The id to which `id` leads in a table: `id` itself if the table has it, else that of what has
  // replaced it, step by step; invalid if that was erased.
  template <typename Table>
  IdType Resolve(const Table& table, IdType id) const {
    while (id.IsValid() && !table.Contains(id)) {
      const IdType* const next = Find(id);
      id = next != nullptr ? *next : IdType();
    }
    return id;
  }

  // Forgets replacements with an older revision, but keeps all of ids before `kept`. These then
  // lead to the id that is in use now, so they do not need the forgotten ones.
  void Forget(uint32_t revision, IdType kept = IdType(0)) {
    for (Entry& entry : entries_) {
      while (const IdType* const next = entry.replaced < kept ? Find(entry.by) : nullptr) {
        entry.by = *next;
      }
    }
    std::erase_if(entries_, [&](const Entry& entry) {
      return entry.revision < revision && !(entry.replaced < kept);
    });
  }

  size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    IdType replaced;
    IdType by;
    uint32_t revision = 0;
  };

  auto LowerBound(IdType id) const {
    return std::lower_bound(
        entries_.begin(), entries_.end(), id,
        [](const Entry& entry, IdType wanted) { return entry.replaced < wanted; });
  }

  std::vector<Entry> entries_;  // by increasing replaced id
};

}  // namespace hullslam
