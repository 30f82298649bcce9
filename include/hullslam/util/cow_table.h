// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {

// A table from ids to values, stored in chunks that are copied on write. Snapshot() shares all
// chunks with the original table and costs one pointer copy per chunk. The first write to a shared
// chunk clones that chunk only. Iteration is in the order of ids. Ids are never reused, so an
// erased id stays empty. A chunk without values is freed.
//
// A table has one writer. Other threads may read a snapshot, or write to it as their own table.
//
//   for (const auto& [id, value] : table) { ... }
template <typename IdType, typename Value, size_t kChunkSize = 64>
class CowTable {
 public:
  // Visits the values in the order of their ids. Like the pointer of Find(), it is valid until the
  // next write. What it points to is a pair that is made on the spot, so it has no operator->.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = std::pair<IdType, const Value&>;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = value_type;

    Iterator() = default;
    value_type operator*() const {
      return {IdType(static_cast<uint32_t>(index_)), *table_->ValueAt(index_)};
    }
    Iterator& operator++() {
      index_ = table_->NextUsed(index_ + 1);
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Iterator&) const = default;
    bool operator==(std::default_sentinel_t) const {
      return index_ >= kChunkSize * table_->chunks_.size();
    }

   private:
    friend class CowTable;
    Iterator(const CowTable* table, size_t index) : table_(table), index_(index) {}

    const CowTable* table_ = nullptr;
    size_t index_ = 0;
  };

  CowTable() = default;
  CowTable(CowTable&&) noexcept = default;
  CowTable& operator=(CowTable&&) noexcept = default;
  CowTable(const CowTable&) = delete;
  CowTable& operator=(const CowTable&) = delete;

  // Returns a table with the same values. After this call a write to either table clones the shared
  // chunk first.
  CowTable Snapshot() {
    owned_.assign(chunks_.size(), false);
    CowTable copy;
    copy.chunks_ = chunks_;
    copy.owned_ = owned_;
    copy.size_ = size_;
    copy.next_id_ = next_id_;
    return copy;
  }

  // Number of values; erased ones do not count.
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  // The id that the next Insert() returns. It is larger than every id used so far.
  IdType NextId() const { return IdType(next_id_); }

  IdType Insert(Value value) {
    const IdType id = NextId();
    Put(id, std::move(value));
    return id;
  }

  // Stores a value under an id that has none. Later ids from Insert() are larger.
  void Put(IdType id, Value value) {
    Check(id.IsValid() && !Contains(id), "the id is invalid or has a value");
    const size_t chunk = id.value / kChunkSize;
    if (chunk >= chunks_.size()) {
      chunks_.resize(chunk + 1);
      owned_.resize(chunk + 1, false);
    }
    if (chunks_[chunk] == nullptr) {
      chunks_[chunk] = std::make_shared<Chunk>();
      owned_[chunk] = true;
    }
    Chunk& writable = WritableChunk(chunk);
    writable.slots[id.value % kChunkSize].emplace(std::move(value));
    ++writable.used;
    ++size_;
    next_id_ = std::max(next_id_, id.value + 1);
  }

  // Null if the id was never used or was erased. The pointer is valid until the next write.
  const Value* Find(IdType id) const { return ValueAt(id.value); }

  bool Contains(IdType id) const { return Find(id) != nullptr; }

  // Throws CheckError if there is no value.
  const Value& At(IdType id) const {
    const Value* value = Find(id);
    Check(value != nullptr, "no value with this id");
    return *value;
  }

  // The value for writing. Clones its chunk if a snapshot shares it. Throws like At().
  Value& Mutable(IdType id) {
    Check(Find(id) != nullptr, "no value with this id");
    return *WritableChunk(id.value / kChunkSize).slots[id.value % kChunkSize];
  }

  void Erase(IdType id) {
    Check(Find(id) != nullptr, "no value with this id");
    const size_t chunk = id.value / kChunkSize;
    if (chunks_[chunk]->used == 1) {
      chunks_[chunk] = nullptr;
    } else {
      Chunk& writable = WritableChunk(chunk);
      writable.slots[id.value % kChunkSize].reset();
      --writable.used;
    }
    --size_;
  }

  Iterator begin() const { return {this, NextUsed(0)}; }
  std::default_sentinel_t end() const { return {}; }

  // Calls visit(id, const Value&) in the order of the ids.
  template <typename Visitor>
  void ForEach(Visitor&& visit) const {
    for (const auto& [id, value] : *this) {
      visit(id, value);
    }
  }

 private:
  struct Chunk {
    std::array<std::optional<Value>, kChunkSize> slots;
    size_t used = 0;
  };

  // Null if there is no value under the id with this number.
  const Value* ValueAt(size_t index) const {
    const size_t chunk = index / kChunkSize;
    if (chunk >= chunks_.size() || chunks_[chunk] == nullptr) {
      return nullptr;
    }
    const std::optional<Value>& slot = chunks_[chunk]->slots[index % kChunkSize];
    return slot ? &*slot : nullptr;
  }

  // The first number from `index` on under which there is a value; beyond all chunks if there is
  // none.
  size_t NextUsed(size_t index) const {
    const size_t end = kChunkSize * chunks_.size();
    while (index < end) {
      const auto& chunk = chunks_[index / kChunkSize];
      if (chunk == nullptr) {
        index = (index / kChunkSize + 1) * kChunkSize;  // skips the whole chunk
      } else if (chunk->slots[index % kChunkSize]) {
        return index;
      } else {
        ++index;
      }
    }
    return end;
  }

  Chunk& WritableChunk(size_t chunk) {
    if (!owned_[chunk]) {
      chunks_[chunk] = std::make_shared<Chunk>(*chunks_[chunk]);
      owned_[chunk] = true;
    }
    return *chunks_[chunk];
  }

  std::vector<std::shared_ptr<Chunk>> chunks_;
  // True for chunks that were created after the last snapshot; no other table can see them. The use
  // count of the shared pointers would not do: reading it races with readers that release a
  // snapshot.
  std::vector<bool> owned_;
  size_t size_ = 0;
  uint32_t next_id_ = 0;
};

}  // namespace hullslam
