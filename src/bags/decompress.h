// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <utility>

namespace hullslam {

// The compression of the chunks and messages of bags.
enum class Compression { kNone, kBzip2, kLz4, kZstd };

// The limit for a chunk or a message, decompressed. A few bytes can claim to be any number.
constexpr uint64_t kMostBagBytes = 256'000'000;

// Limits the bytes that all compressed parts of a file become together, because reading them takes
// time: they may be a hundred times the bytes of the file, and kMostBagBytes more. Images, which
// are most of a recording, compress by less than that; streams of zeros by a thousand and more.
class ExpansionLimit {
 public:
  // `beside`: the bytes of other files that belong to the file.
  explicit ExpansionLimit(std::filesystem::path file, uint64_t beside = 0);
  // Throws InputError with the file if there are too many.
  void Add(uint64_t decompressed);

 private:
  std::filesystem::path file_;
  uint64_t most_ = 0;
  uint64_t sum_ = 0;
};

// The compression with this name in a bag: "", "none", "bz2", "lz4" or "zstd". Throws InputError
// that begins with `place` for another name.
Compression ParseCompression(std::string_view name, const std::string& place);

// Decompresses all of `bytes`: one stream of bzip2, or frames of LZ4 or Zstandard. Memory grows
// with what is really there. Throws InputError that begins with `place`, the name of the file and
// the position in it, if the bytes are broken or cut off or give more than `most_bytes`.
std::string Decompress(Compression compression, std::string_view bytes, uint64_t most_bytes,
                       const std::string& place);

// Compresses with Zstandard as one frame. The same bytes and the same library give the same result.
std::string CompressZstd(std::string_view bytes);

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
