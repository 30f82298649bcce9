// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
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
template <typename IdType, typename Value, size_t kChunkSize = 64>
class CowTable {
 public:
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
  const Value* Find(IdType id) const {
    const size_t chunk = id.value / kChunkSize;
    if (chunk >= chunks_.size() || chunks_[chunk] == nullptr) {
      return nullptr;
    }
    const std::optional<Value>& slot = chunks_[chunk]->slots[id.value % kChunkSize];
    return slot ? &*slot : nullptr;
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

  // Calls visit(id, const Value&) in the order of the ids.
  template <typename Visitor>
  void ForEach(Visitor&& visit) const {
    for (size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
      if (chunks_[chunk] == nullptr) {
        continue;
      }
      for (size_t slot = 0; slot < kChunkSize; ++slot) {
        if (const auto& value = chunks_[chunk]->slots[slot]) {
          visit(IdType(static_cast<uint32_t>(chunk * kChunkSize + slot)), *value);
        }
      }
    }
  }

 private:
  struct Chunk {
    std::array<std::optional<Value>, kChunkSize> slots;
    size_t used = 0;
  };

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
