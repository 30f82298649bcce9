// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace hullslam {

// Appends numbers to a string of bytes, little-endian on every computer. ByteReader reads them.
class ByteWriter {
 public:
  template <typename Number>
  void Put(Number number) {
    static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if constexpr (std::endian::native == std::endian::big) {
      std::reverse(bytes.begin(), bytes.end());
    }
    bytes_.append(bytes.data(), bytes.size());
  }
  void PutFlag(bool flag) { Put(static_cast<uint8_t>(flag ? 1 : 0)); }
  // A number of elements that follow.
  void PutCount(size_t count) { Put(static_cast<uint32_t>(count)); }
  void PutText(std::string_view text) {
    PutCount(text.size());
    bytes_.append(text);
  }
  // Bytes whose number the reader knows.
  void PutRaw(std::string_view bytes) { bytes_.append(bytes); }

  // The numbers of an Eigen matrix, column by column.
  template <typename Matrix>
  void PutMatrix(const Matrix& matrix) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        Put(matrix(row, column));
      }
    }
  }

  const std::string& bytes() const { return bytes_; }
  void Clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

}  // namespace hullslam
