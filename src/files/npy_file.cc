// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/npy_file.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/bytes.h"
#include "files/read_file.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr size_t kMostNpyBytes = 64'000'000;
constexpr double kMostValue = 1e30;  // far beyond any value of a vector; its square fits a double

// The text after "'key':" in the header, which is a dictionary of Python.
std::string_view ValueOf(std::string_view header, std::string_view key,
                         const std::filesystem::path& path) {
  const std::string quoted = fmt::format("'{}':", key);
  const size_t at = header.find(quoted);
  if (at == std::string_view::npos) {
    throw InputError(fmt::format("{}: the header has no {}", path.string(), quoted));
  }
  return Trim(header.substr(at + quoted.size()));
}

// "(3, 512)" or "(512,)".
std::vector<size_t> ReadShape(std::string_view text, const std::filesystem::path& path) {
  std::vector<size_t> shape;
  const size_t close = text.find(')');
  std::string_view rest = text.substr(0, close);
  bool is_valid = close != std::string_view::npos && rest.starts_with('(');
  while (is_valid && rest.size() > 1) {
    rest = Trim(rest.substr(1));
    if (rest.empty()) {
      break;
    }
    size_t size = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), size);
    is_valid = error == std::errc();
    shape.push_back(size);
    rest = Trim(rest.substr(static_cast<size_t>(end - rest.data())));
    is_valid = is_valid && (rest.empty() || rest.starts_with(','));
  }
  if (!is_valid || shape.empty() || shape.size() > 2) {
    throw InputError(fmt::format("{}: 'shape' is '{}', expected one or two dimensions",
                                 path.string(), Printable(std::string(text.substr(0, 40)))));
  }
  return shape;
}

template <typename Number>
void ReadValues(ByteReader& in, FloatRows& result) {
  for (float& value : result.values) {
    if constexpr (sizeof(Number) == 2) {
      value = static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(in.Get<uint16_t>()));
      in.Require(std::abs(value) <= kMostValue, "has a number that is out of range or not finite");
    } else {
      value = static_cast<float>(in.GetFinite(static_cast<Number>(kMostValue)));
    }
  }
}

size_t BytesOf(std::string_view type, const std::filesystem::path& path) {
  for (const size_t bytes : {size_t{2}, size_t{4}, size_t{8}}) {
    if (type.starts_with(fmt::format("'<f{}'", bytes))) {
      return bytes;
    }
  }
  throw InputError(fmt::format("{}: 'descr' is {}, expected '<f2', '<f4' or '<f8'", path.string(),
                               Printable(std::string(type.substr(0, type.find(','))))));
}

}  // namespace

FloatRows ReadNpy(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path, kMostNpyBytes);
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + 4) {
    throw InputError(path.string() + ": is no array of numpy.save()");
  }
  const auto version = static_cast<uint8_t>(bytes[kMagic.size()]);
  const std::string_view rest = std::string_view(bytes).substr(kMagic.size() + 2);
  ByteReader in(rest, path.string());
  in.Require(version >= 1 && version <= 3, "is of an unknown version, expected 1 to 3");
  const size_t size = version == 1 ? in.Get<uint16_t>() : in.Get<uint32_t>();
  in.Require(size <= in.left(), "is cut off");
  const std::string_view header = rest.substr(rest.size() - in.left(), size);
  const size_t bytes_each = BytesOf(ValueOf(header, "descr", path), path);
  if (!ValueOf(header, "fortran_order", path).starts_with("False")) {
    throw InputError(path.string() + ": 'fortran_order' is not False, expected the order of C");
  }
  const std::vector<size_t> shape = ReadShape(ValueOf(header, "shape", path), path);
  ByteReader data(rest.substr(rest.size() - in.left() + size), path.string());
  FloatRows result;
  result.columns = shape.back();
  result.rows = shape.size() == 2 ? shape.front() : result.columns == 0 ? 0 : 1;
  const size_t count = data.left() / bytes_each;
  const bool fits = result.columns == 0
                        ? count == 0
                        : count % result.columns == 0 && count / result.columns == result.rows &&
                              count * bytes_each == data.left();
  data.Require(fits, "has not as many numbers as its shape tells");
  result.values.resize(count);
  if (bytes_each == 2) {
    ReadValues<uint16_t>(data, result);
  } else if (bytes_each == 4) {
    ReadValues<float>(data, result);
  } else {
    ReadValues<double>(data, result);
  }
  return result;
}

}  // namespace hullslam
