// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace hullslam {

// Memory that grows by whole pages and whose content is in a temporary file without a name, so
// that the computer can take it back while nobody reads it. The file is in the folder for
// temporary files (TMPDIR). If it cannot be written there, the memory is ordinary memory.
class MappedMemory {
 public:
  MappedMemory() = default;
  ~MappedMemory() { Clear(); }
  MappedMemory(MappedMemory&& other) noexcept { *this = std::move(other); }
  MappedMemory& operator=(MappedMemory&& other) noexcept;

  // Makes it at least this large. The content is kept, but its address may change. Throws
  // std::bad_alloc if there is no memory.
  void Grow(size_t bytes);
  // Gives whole pages of the first bytes back: the last kMostGivenBack bytes of these, and as many
  // of the others in turn, so that a call takes no longer when much was read. Their content stays,
  // and is read from the file when it is needed.
  static constexpr size_t kMostGivenBack = size_t{16} << 20;
  void GiveBack(size_t bytes);
  void Clear();

  void* data() const { return data_; }
  size_t size() const { return size_; }
  bool has_file() const { return file_ >= 0; }

 private:
  bool GrowFile(size_t bytes);
  void GrowWithoutFile(size_t bytes);

  int file_ = -1;
  bool is_without_file_ = false;
  void* data_ = nullptr;
  size_t size_ = 0;
  size_t given_back_ = 0;  // where the next turn begins
};

// A vector that only grows at its end, for records of a run that may last for hours: the first
// `kMostInMemory` elements are in memory, and more of them in MappedMemory. Elements are moved as
// bytes when it grows.
template <typename T>
class MappedVector {
 public:
  static constexpr size_t kMostInMemory = 1024;

  MappedVector() = default;
  MappedVector(MappedVector&& other) noexcept { *this = std::move(other); }
  MappedVector& operator=(MappedVector&& other) noexcept {
    few_ = std::exchange(other.few_, {});
    memory_ = std::move(other.memory_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  size_t size() const { return is_mapped() ? size_ : few_.size(); }
  bool empty() const { return size() == 0; }
  const T& back() const { return all().back(); }
  // Valid until the next change of the vector.
  std::span<const T> all() const {
    return is_mapped() ? std::span<const T>(static_cast<const T*>(memory_.data()), size_)
                       : std::span<const T>(few_);
  }
  std::span<T> all() {
    return is_mapped() ? std::span<T>(static_cast<T*>(memory_.data()), size_) : std::span<T>(few_);
  }

  void push_back(const T& element) {
    if (!is_mapped() && few_.size() < kMostInMemory) {
      few_.push_back(element);
      return;
    }
    const size_t count = size();
    if ((count + 1) * sizeof(T) > memory_.size()) {
      Grow(count);
    }
    new (static_cast<T*>(memory_.data()) + count) T(element);
    size_ = count + 1;
  }

  void clear() {
    few_.clear();
    memory_.Clear();
    size_ = 0;
  }

 private:
  static_assert(std::is_trivially_destructible_v<T>, "the elements are moved as bytes");

  bool is_mapped() const { return size_ > 0; }

  // Makes room behind `count` elements.
  void Grow(size_t count) {
    const bool is_first = !is_mapped();
    memory_.Grow((count + kMostInMemory) * sizeof(T));
    if (is_first) {
      std::uninitialized_copy(few_.begin(), few_.end(), static_cast<T*>(memory_.data()));
      few_ = std::vector<T>();
    }
    memory_.GiveBack(count * sizeof(T));
  }

  std::vector<T> few_;  // empty once the elements are mapped
  MappedMemory memory_;
  size_t size_ = 0;  // 0 until then
};

}  // namespace hullslam
