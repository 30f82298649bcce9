// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {

// A table from ids to values, stored in chunks that are copied on write. Each group of kFan chunks
// has a block with pointers to them. Snapshot() shares all blocks with the original table and costs
// one pointer copy per block. The first write to a shared chunk clones that chunk and the block
// with its pointers only. Iteration is in the order of ids. Ids are never reused, so an erased id
// stays empty (util/recycling_table.h uses ids again). A chunk without values is freed, and so is a
// block without chunks.
//
// A table has one writer. Other threads may read a snapshot, or write to it as their own table.
//
//   for (const auto& [id, value] : table) { ... }
template <typename IdType, typename Value, size_t kChunkSize = 64>
class CowTable {
 public:
  // Visits the values in the order of their ids. Like the pointer of Find(), it is valid until the
  // next write. operator* returns a temporary pair, so there is no operator->.
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
    bool operator==(std::default_sentinel_t) const { return index_ >= table_->Capacity(); }

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
    owned_.assign(blocks_.size(), false);
    CowTable copy;
    copy.blocks_ = blocks_;
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
  // From now on Insert() returns no id below `next`: they were used by values that were erased.
  void SkipIds(IdType next) { next_id_ = std::max(next_id_, next.value); }

  IdType Insert(Value value) {
    const IdType id = NextId();
    Put(id, std::move(value));
    return id;
  }

  // Stores a value under an id that has none. Later ids from Insert() are larger.
  void Put(IdType id, Value value) {
    Check(id.IsValid() && !Contains(id), "the id is invalid or has a value");
    Block& block = WritableBlock(id.value / kBlockSize);
    const size_t chunk_index = IndexInBlock(id.value);
    if (block.chunks[chunk_index] == nullptr) {
      block.chunks[chunk_index] = std::make_shared<Chunk>();
      block.owned.set(chunk_index);
      ++block.used;
    }
    Chunk& chunk = WritableChunk(block, chunk_index);
    chunk.slots[id.value % kChunkSize].emplace(std::move(value));
    ++chunk.used;
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
    Block& block = WritableBlock(id.value / kBlockSize);
    return *WritableChunk(block, IndexInBlock(id.value)).slots[id.value % kChunkSize];
  }

  void Erase(IdType id) {
    Check(Find(id) != nullptr, "no value with this id");
    Block& block = WritableBlock(id.value / kBlockSize);
    const size_t chunk_index = IndexInBlock(id.value);
    if (block.chunks[chunk_index]->used > 1) {
      Chunk& chunk = WritableChunk(block, chunk_index);
      chunk.slots[id.value % kChunkSize].reset();
      --chunk.used;
    } else if (block.used > 1) {
      block.chunks[chunk_index] = nullptr;
      --block.used;
    } else {
      blocks_[id.value / kBlockSize] = nullptr;
    }
    --size_;
  }

  // The nearest id after or before `id` that has a value; an invalid one if there is none. Ranges
  // without values are skipped quickly.
  IdType After(IdType id) const {
    const size_t next = NextUsed(size_t{id.value} + 1);
    return next < Capacity() ? IdType(static_cast<uint32_t>(next)) : IdType();
  }
  IdType Before(IdType id) const {
    size_t end = std::min<size_t>(id.value, Capacity());
    while (end > 0) {
      const size_t index = end - 1;
      const Block* const block = blocks_[index / kBlockSize].get();
      const Chunk* const chunk =
          block != nullptr ? block->chunks[IndexInBlock(index)].get() : nullptr;
      if (chunk != nullptr && chunk->slots[index % kChunkSize]) {
        return IdType(static_cast<uint32_t>(index));
      }
      end = block == nullptr   ? index / kBlockSize * kBlockSize
            : chunk == nullptr ? index / kChunkSize * kChunkSize
                               : index;
    }
    return IdType();
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
  static constexpr size_t kFan = 64;
  static constexpr size_t kBlockSize = kFan * kChunkSize;

  struct Chunk {
    std::array<std::optional<Value>, kChunkSize> slots;
    size_t used = 0;
  };

  struct Block {
    std::array<std::shared_ptr<Chunk>, kFan> chunks;
    // The chunks that were created after the last snapshot; no other table can see them. The use
    // counts of the shared pointers cannot replace these flags, because readers that release a
    // snapshot change them at the same time. Only the table that owns the block reads the flags.
    std::bitset<kFan> owned;
    size_t used = 0;  // chunks that exist
  };

  static size_t IndexInBlock(size_t index) { return index / kChunkSize % kFan; }
  size_t Capacity() const { return kBlockSize * blocks_.size(); }

  // Null if there is no value under the id with this number.
  const Value* ValueAt(size_t index) const {
    if (index >= Capacity()) {
      return nullptr;
    }
    const Block* block = blocks_[index / kBlockSize].get();
    const Chunk* chunk = block != nullptr ? block->chunks[IndexInBlock(index)].get() : nullptr;
    if (chunk == nullptr) {
      return nullptr;
    }
    const std::optional<Value>& slot = chunk->slots[index % kChunkSize];
    return slot ? &*slot : nullptr;
  }

  // The first number that is at least `index` and has a value; Capacity() if there is none.
  size_t NextUsed(size_t index) const {
    while (index < Capacity()) {
      const Block* block = blocks_[index / kBlockSize].get();
      if (block == nullptr) {
        index = (index / kBlockSize + 1) * kBlockSize;  // skips the whole block
        continue;
      }
      const Chunk* chunk = block->chunks[IndexInBlock(index)].get();
      if (chunk == nullptr) {
        index = (index / kChunkSize + 1) * kChunkSize;  // skips the whole chunk
      } else if (chunk->slots[index % kChunkSize]) {
        return index;
      } else {
        ++index;
      }
    }
    return Capacity();
  }

  // The block with this number. Makes it if there is none, and clones it if a snapshot shares it.
  Block& WritableBlock(size_t number) {
    if (number >= blocks_.size()) {
      blocks_.resize(number + 1);
      owned_.resize(number + 1, false);
    }
    std::shared_ptr<Block>& block = blocks_[number];
    if (block == nullptr) {
      block = std::make_shared<Block>();
    } else if (!owned_[number]) {
      block = std::make_shared<Block>(*block);
      block->owned.reset();
    }
    owned_[number] = true;
    return *block;
  }

  // A chunk of a block that this table owns.
  static Chunk& WritableChunk(Block& block, size_t chunk_index) {
    if (!block.owned[chunk_index]) {
      block.chunks[chunk_index] = std::make_shared<Chunk>(*block.chunks[chunk_index]);
      block.owned.set(chunk_index);
    }
    return *block.chunks[chunk_index];
  }

  std::vector<std::shared_ptr<Block>> blocks_;
  std::vector<bool> owned_;  // one per block: whether it was created after the last snapshot
  size_t size_ = 0;
  uint32_t next_id_ = 0;
};

}  // namespace hullslam
