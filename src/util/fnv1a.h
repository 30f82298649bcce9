// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>

namespace hullslam {

// The hash FNV-1a (Fowler, Noll, Vo) of the bytes of a text, with as many bits as the type has: 32
// or 64. It is the same on every platform.
template <std::unsigned_integral T>
constexpr T Fnv1a(std::string_view text) {
  static_assert(sizeof(T) == 4 || sizeof(T) == 8);
  T hash = sizeof(T) == 4 ? T{2166136261U} : static_cast<T>(0xcbf29ce484222325U);
  for (const char byte : text) {
    hash = (hash ^ static_cast<unsigned char>(byte)) *
           (sizeof(T) == 4 ? T{16777619U} : static_cast<T>(0x100000001b3U));
  }
  return hash;
}

}  // namespace hullslam
