// SPDX-License-Identifier: GPL-3.0-or-later
#include "bow/vocabulary_layout.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstring>

namespace hullslam {

uint64_t HashVocabulary(std::span<const std::byte> bytes) {
  VocabularyHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.hash = 0;
  const std::span<const std::byte> body = bytes.subspan(sizeof(header));
  return XXH3_64bits_withSeed(body.data(), body.size(), XXH3_64bits(&header, sizeof(header)));
}

}  // namespace hullslam
