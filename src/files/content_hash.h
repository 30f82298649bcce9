// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

namespace hullslam {

// The 64-bit XXH3 hash of these bytes as 16 hexadecimal digits. It tells contents apart that differ
// by chance; it is no protection against somebody who wants two contents to have one hash.
std::string ContentHash(const void* bytes, size_t size);

}  // namespace hullslam
