// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

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

}  // namespace hullslam
