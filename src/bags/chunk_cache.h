// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <utility>

namespace hullslam {

// The position that stands for "in no chunk": every file begins with its magic bytes.
inline constexpr uint64_t kNoChunk = 0;

// The chunks that were used last, decompressed. Images and depth images of the same moment are
// usually in the same chunk or in neighbours.
class ChunkCache {
 public:
  // The chunk at this position of the file, from `load` if it is not in the cache. The result is
  // valid until the next call.
  const std::string& Get(uint64_t position, const std::function<std::string()>& load) {
    for (auto chunk = chunks_.begin(); chunk != chunks_.end(); ++chunk) {
      if (chunk->first == position) {
        chunks_.splice(chunks_.begin(), chunks_, chunk);
        return chunks_.front().second;
      }
    }
    if (chunks_.size() == kMost) {
      chunks_.pop_back();
    }
    chunks_.emplace_front(position, load());
    return chunks_.front().second;
  }

 private:
  static constexpr size_t kMost = 3;
  std::list<std::pair<uint64_t, std::string>> chunks_;  // the one that was used last comes first
};

}  // namespace hullslam
