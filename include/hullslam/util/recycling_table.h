// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/cow_table.h"
#include "hullslam/util/id.h"

namespace hullslam {

// A table like CowTable whose ids are used again: the slot of an erased value is given to a later
// value with the next generation. So the table has as many slots as it ever had values at one time.
// The id of an erased value never finds another value, neither in this table nor in its snapshots,
// because a slot whose generations are used up is not used again.
//
// The slot that was freed last is used first, so the same calls give the same ids. Iteration is in
// the order of ids, which is the order of their slots.
template <typename IdType, typename Value, size_t kChunkSize = 64>
class RecyclingTable {
  static constexpr uint32_t kNone = UINT32_MAX;

  struct Cell {
    IdType id;                   // id of the value, or of the next value that gets this slot
    std::optional<Value> value;  // absent if the slot is free
    uint32_t next_free = kNone;  // the slot that was freed before this one
  };

  using SlotId = Id<struct SlotTag>;
  using Cells = CowTable<SlotId, Cell, kChunkSize>;

 public:
  // Like CowTable::Iterator.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = std::pair<IdType, const Value&>;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = value_type;

    Iterator() = default;
    value_type operator*() const {
      const Cell& cell = (*cell_).second;
      return {cell.id, *cell.value};
    }
    Iterator& operator++() {
      ++cell_;
      SkipFree();
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Iterator&) const = default;
    bool operator==(std::default_sentinel_t end) const { return cell_ == end; }

   private:
    friend class RecyclingTable;
    explicit Iterator(typename Cells::Iterator cell) : cell_(cell) { SkipFree(); }

    void SkipFree() {
      while (cell_ != std::default_sentinel && !(*cell_).second.value) {
        ++cell_;
      }
    }

    typename Cells::Iterator cell_;
  };

  RecyclingTable() = default;
  RecyclingTable(RecyclingTable&&) noexcept = default;
  RecyclingTable& operator=(RecyclingTable&&) noexcept = default;
  RecyclingTable(const RecyclingTable&) = delete;
  RecyclingTable& operator=(const RecyclingTable&) = delete;

  // Returns a table with the same values, see CowTable::Snapshot. If values are inserted into both
  // tables afterwards, the same id can stand for different values in the two.
  RecyclingTable Snapshot() {
    RecyclingTable copy;
    copy.cells_ = cells_.Snapshot();
    copy.size_ = size_;
    copy.first_free_ = first_free_;
    return copy;
  }

  // Number of values; erased ones do not count.
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  // Number of slots that hold a value or wait for one.
  size_t slots() const { return cells_.size(); }
  // Number of slots that were ever used: slots() plus those whose generations are used up.
  uint32_t used_slots() const { return cells_.NextId().value; }
  // The id of the value in a used slot, or of the next one that gets it.
  IdType IdInSlot(uint32_t slot) const { return cells_.At(SlotId(slot)).id; }
  // The ids that the next values get in free slots, in this order.
  std::vector<IdType> FreeIds() const {
    std::vector<IdType> ids;
    for (uint32_t slot = first_free_; slot != kNone;) {
      const Cell& cell = cells_.At(SlotId(slot));
      ids.push_back(cell.id);
      slot = cell.next_free;
    }
    return ids;
  }

  // Throws CheckError if all slots are used.
  IdType Insert(Value value) {
    if (first_free_ == kNone) {
      const uint32_t slot = cells_.NextId().value;
      Check(slot < IdType::kMaxSlot, "the table is full");
      cells_.Insert({.id = IdType(slot, 0), .value = std::move(value)});
      ++size_;
      return IdType(slot, 0);
    }
    Cell& cell = cells_.Mutable(SlotId(first_free_));
    first_free_ = cell.next_free;
    cell.value.emplace(std::move(value));
    ++size_;
    return cell.id;
  }

  // The next three functions restore a table from its values, FreeIds() and used_slots(). The first
  // two throw CheckError if the slot of the id is used.

  // Stores a value under an id whose slot has not been used.
  void Put(IdType id, Value value) {
    Check(id.slot() < IdType::kMaxSlot, "the id is invalid");
    cells_.Put(SlotId(id.slot()), {.id = id, .value = std::move(value)});
    ++size_;
  }
  // Frees a slot that has not been used. The next value gets this id.
  void PutFree(IdType id) {
    Check(id.slot() < IdType::kMaxSlot, "the id is invalid");
    cells_.Put(SlotId(id.slot()), {.id = id, .value = std::nullopt, .next_free = first_free_});
    first_free_ = id.slot();
  }
  // After this call, slots below `count` that neither hold a value nor are free will not be used
  // again.
  void SkipSlots(uint32_t count) { cells_.SkipIds(SlotId(count)); }

  // Null if the id was never used or was erased. The pointer is valid until the next write.
  const Value* Find(IdType id) const {
    const Cell* cell = cells_.Find(SlotId(id.slot()));
    return cell != nullptr && cell->id == id && cell->value ? &*cell->value : nullptr;
  }

  bool Contains(IdType id) const { return Find(id) != nullptr; }

  // Throws CheckError if there is no value.
  const Value& At(IdType id) const {
    const Value* value = Find(id);
    Check(value != nullptr, "no value with this id");
    return *value;
  }

  // The value for writing. Clones its chunk if a snapshot shares it. Throws like At().
  Value& Mutable(IdType id) {
    Check(Contains(id), "no value with this id");
    return *cells_.Mutable(SlotId(id.slot())).value;
  }

  void Erase(IdType id) {
    Check(Contains(id), "no value with this id");
    if (id.generation() == IdType::kMaxGeneration) {
      cells_.Erase(SlotId(id.slot()));
    } else {
      Cell& cell = cells_.Mutable(SlotId(id.slot()));
      cell.value.reset();
      cell.id = IdType(id.slot(), id.generation() + 1);
      cell.next_free = first_free_;
      first_free_ = id.slot();
    }
    --size_;
  }

  Iterator begin() const { return Iterator(cells_.begin()); }
  std::default_sentinel_t end() const { return {}; }

  // Calls visit(id, const Value&) in the order of the ids.
  template <typename Visitor>
  void ForEach(Visitor&& visit) const {
    for (const auto& [id, value] : *this) {
      visit(id, value);
    }
  }

 private:
  Cells cells_;
  size_t size_ = 0;
  uint32_t first_free_ = kNone;  // the slot that was freed last
};

}  // namespace hullslam
