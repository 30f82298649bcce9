// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

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

// Reads what ByteWriter wrote. All functions throw InputError if the bytes end too early or if a
// value is not allowed.
class ByteReader {
 public:
  // `bytes` must outlive the reader. Error messages begin with `name`: the file and the part of it.
  ByteReader(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  template <typename Number>
  Number Get() {
    static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
    Require(sizeof(Number) <= bytes_.size(), "is cut off");
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), bytes_.data(), bytes.size());
    if constexpr (std::endian::native == std::endian::big) {
      std::reverse(bytes.begin(), bytes.end());
    }
    bytes_.remove_prefix(bytes.size());
    return std::bit_cast<Number>(bytes);
  }
  // A finite number from -most to most.
  template <typename Number>
  Number GetFinite(Number most) {
    const auto number = Get<Number>();
    Require(std::abs(number) <= most, "has a number that is out of range or not finite");
    return number;
  }
  // A matrix of such numbers.
  template <typename Matrix>
  Matrix GetMatrix(typename Matrix::Scalar most) {
    Matrix matrix;
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        matrix(row, column) = GetFinite(most);
      }
    }
    return matrix;
  }
  bool GetFlag() {
    const auto flag = Get<uint8_t>();
    Require(flag <= 1, "has a flag that is neither 0 nor 1");
    return flag == 1;
  }
  // The number of elements that follow. Throws if less than `bytes_each` bytes per element are
  // left, so that it is safe to allocate memory for them.
  size_t GetCount(size_t bytes_each) {
    const size_t count = Get<uint32_t>();
    Require(count <= bytes_.size() / bytes_each, "has more elements than bytes");
    return count;
  }
  std::string GetText() {
    const size_t size = GetCount(1);
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }
  // The next `count` bytes, as a view of the constructor's bytes.
  std::string_view GetRaw(size_t count) {
    Require(count <= bytes_.size(), "is cut off");
    const std::string_view raw = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return raw;
  }
  size_t left() const { return bytes_.size(); }
  // To be called after the last value.
  void ExpectEnd() const { Require(bytes_.empty(), "has bytes after its end"); }

  void Require(bool condition, const char* fault) const {
    if (!condition) {
      Fail(fault);
    }
  }
  [[noreturn]] void Fail(const char* fault) const;

 private:
  std::string_view bytes_;  // those that were not read yet
  std::string name_;
};

}  // namespace hullslam
