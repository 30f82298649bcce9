// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/decompress.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <memory>
#include <system_error>
#include <utility>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

// The result of one call of a decompressor.
struct Step {
  size_t used = 0;
  size_t made = 0;
  bool is_end = false;  // of the stream or frame
  bool is_broken = false;
};

// Calls `call(bytes, room)` until all bytes are decompressed.
template <typename Call>
std::string RunSteps(std::string_view bytes, uint64_t most_bytes, const std::string& place,
                     const Call& call) {
  constexpr size_t kRoom = 1 << 18;
  std::string decompressed;
  std::string room(kRoom, '\0');
  while (true) {
    const Step step = call(bytes, room);
    if (step.is_broken) {
      throw InputError(place + ": the compressed bytes are broken");
    }
    if (step.made > most_bytes - decompressed.size()) {
      throw InputError(fmt::format("{}: more than {} bytes when decompressed", place, most_bytes));
    }
    bytes.remove_prefix(step.used);
    decompressed.append(room.data(), step.made);
    if (step.is_end && bytes.empty()) {
      return decompressed;
    }
    if (step.used == 0 && step.made == 0) {
      throw InputError(place + ": the compressed bytes are cut off");
    }
  }
}

std::string DecompressBzip2(std::string_view bytes, uint64_t most_bytes, const std::string& place) {
  const auto release = [](bz_stream* stream) { BZ2_bzDecompressEnd(stream); };
  bz_stream stream{};
  Check(BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK, "bzip2 has no memory");
  const std::unique_ptr<bz_stream, decltype(release)> owner(&stream, release);
  return RunSteps(bytes, most_bytes, place, [&](std::string_view left, std::string& room) {
    stream.next_in = const_cast<char*>(left.data());  // bzip2 only reads it
    stream.avail_in = static_cast<unsigned int>(left.size());
    stream.next_out = room.data();
    stream.avail_out = static_cast<unsigned int>(room.size());
    const int state = BZ2_bzDecompress(&stream);
    return Step{.used = left.size() - stream.avail_in,
                .made = room.size() - stream.avail_out,
                .is_end = state == BZ_STREAM_END,
                .is_broken = state != BZ_OK && state != BZ_STREAM_END};
  });
}

std::string DecompressLz4(std::string_view bytes, uint64_t most_bytes, const std::string& place) {
  LZ4F_dctx* context = nullptr;
  Check(LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0,
        "lz4 has no memory");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
      context, LZ4F_freeDecompressionContext);
  return RunSteps(bytes, most_bytes, place, [&](std::string_view left, std::string& room) {
    Step step{.used = left.size(), .made = room.size()};
    const size_t state =
        LZ4F_decompress(context, room.data(), &step.made, left.data(), &step.used, nullptr);
    step.is_end = state == 0;
    step.is_broken = LZ4F_isError(state) != 0;
    return step;
  });
}

std::string DecompressZstd(std::string_view bytes, uint64_t most_bytes, const std::string& place) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     ZSTD_freeDCtx);
  Check(context != nullptr, "zstd has no memory");
  return RunSteps(bytes, most_bytes, place, [&](std::string_view left, std::string& room) {
    ZSTD_inBuffer input{left.data(), left.size(), 0};
    ZSTD_outBuffer output{room.data(), room.size(), 0};
    const size_t state = ZSTD_decompressStream(context.get(), &output, &input);
    return Step{.used = input.pos,
                .made = output.pos,
                .is_end = state == 0,
                .is_broken = ZSTD_isError(state) != 0};
  });
}

}  // namespace

ExpansionLimit::ExpansionLimit(std::filesystem::path file, uint64_t beside)
    : file_(std::move(file)) {
  constexpr uint64_t kMostExpansion = 100;
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(file_, error);
  most_ = kMostBagBytes + kMostExpansion * (beside + (error ? 0 : size));
}

void ExpansionLimit::Add(uint64_t decompressed) {
  sum_ += decompressed;
  if (sum_ > most_) {
    throw InputError(fmt::format(
        "{}: its compressed parts have more than {} bytes, expected at most a hundred times the "
        "size of the file, and {} bytes more",
        file_.string(), most_, kMostBagBytes));
  }
}

Compression ParseCompression(std::string_view name, const std::string& place) {
  if (name.empty() || name == "none") {
    return Compression::kNone;
  }
  if (name == "bz2") {
    return Compression::kBzip2;
  }
  if (name == "lz4") {
    return Compression::kLz4;
  }
  if (name == "zstd") {
    return Compression::kZstd;
  }
  throw InputError(fmt::format("{}: the compression is '{}', expected none, bz2, lz4 or zstd",
                               place, Printable(name.substr(0, 40))));
}

std::string Decompress(Compression compression, std::string_view bytes, uint64_t most_bytes,
                       const std::string& place) {
  switch (compression) {
    case Compression::kBzip2:
      return DecompressBzip2(bytes, most_bytes, place);
    case Compression::kLz4:
      return DecompressLz4(bytes, most_bytes, place);
    case Compression::kZstd:
      return DecompressZstd(bytes, most_bytes, place);
    default:
      return std::string(bytes);
  }
}

std::string CompressZstd(std::string_view bytes) {
  constexpr int kLevel = 1;  // images are compressed already
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const size_t size =
      ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), kLevel);
  Check(ZSTD_isError(size) == 0, "zstd cannot compress");
  compressed.resize(size);
  return compressed;
}

}  // namespace hullslam
