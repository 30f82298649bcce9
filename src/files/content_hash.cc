// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/content_hash.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

namespace hullslam {

std::string ContentHash(const void* bytes, size_t size) {
  return fmt::format("{:016x}", XXH3_64bits(bytes, size));
}

}  // namespace hullslam
