// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "files/protobuf_reader.h"
#include "hullslam/util/error.h"
#include "segmentation/onnx_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

// The fields of TensorProto that have values.
enum Field : uint64_t {
  kFloats = 4,
  kIntegers = 5,
  kTexts = 6,
  kLongs = 7,
  kRaw = 9,
  kDoubles = 10,
  kUnsigned = 11,
};
constexpr std::array kValueFields = {kFloats, kIntegers, kTexts, kLongs, kRaw, kDoubles, kUnsigned};

// A row of TensorProto.DataType: the bytes of a value in the field kRaw, and the other field that
// may have the values.
struct DataType {
  int64_t number;
  const char* name;
  size_t bytes;
  Field field;
};
constexpr std::array kDataTypes = {
    DataType{1, "float", 4, kFloats},     DataType{2, "uint8", 1, kIntegers},
    DataType{3, "int8", 1, kIntegers},    DataType{4, "uint16", 2, kIntegers},
    DataType{5, "int16", 2, kIntegers},   DataType{6, "int32", 4, kIntegers},
    DataType{7, "int64", 8, kLongs},      DataType{8, "string", 0, kTexts},
    DataType{9, "bool", 1, kIntegers},    DataType{10, "float16", 2, kIntegers},
    DataType{11, "double", 8, kDoubles},  DataType{12, "uint32", 4, kUnsigned},
    DataType{13, "uint64", 8, kUnsigned}, DataType{16, "bfloat16", 2, kIntegers}};

// The number of values in a field of the message that is not kRaw.
size_t CountValues(std::string_view message, Field field) {
  size_t count = 0;
  for (ProtobufReader fields(message, kOnnxName); fields.Next();) {
    if (fields.field() != field) {
      continue;
    }
    const size_t size = fields.bytes().size();
    if (field == kTexts || !fields.has_bytes()) {
      ++count;
    } else if (field == kFloats || field == kDoubles) {
      count += size / (field == kFloats ? sizeof(float) : sizeof(double));
    } else {  // each packed number ends with a byte whose highest bit is 0
      count += static_cast<size_t>(std::ranges::count_if(
          fields.bytes(), [](char byte) { return static_cast<unsigned char>(byte) < 0x80; }));
    }
  }
  return count;
}

// The product of the sides; absent if OpenCV cannot count that far.
std::optional<size_t> CountOf(const std::vector<int64_t>& shape) {
  constexpr int64_t kMost = std::numeric_limits<int32_t>::max();
  int64_t count = 1;
  for (const int64_t side : shape) {
    if (side < 0 || side > kMost || (side > 0 && count > kMost / side)) {
      return std::nullopt;
    }
    count *= side;
  }
  return static_cast<size_t>(count);
}

// The values that the message has; absent if they are in a field that is not one of this type.
std::optional<size_t> CountPresent(std::string_view message, const DataType& type) {
  size_t present = 0;
  size_t sources = 0;
  for (const Field field : kValueFields) {
    size_t count = 0;
    if (field == kRaw) {
      size_t bytes = 0;
      for (ProtobufReader fields(message, kOnnxName); fields.Next();) {
        bytes = fields.field() == kRaw ? fields.bytes().size() : bytes;
      }
      if (bytes > 0 && (type.bytes == 0 || bytes % type.bytes != 0)) {
        return std::nullopt;
      }
      count = bytes > 0 ? bytes / type.bytes : 0;
    } else {
      count = CountValues(message, field);
      if (count > 0 && field != type.field) {
        return std::nullopt;
      }
    }
    present += count;
    sources += count > 0 ? 1 : 0;
  }
  return sources <= 1 ? std::optional(present) : std::nullopt;
}

void CheckValues(std::string_view message, const OnnxTensor& tensor, int64_t type_number) {
  const auto fail = [&](const std::string& fault) {
    throw InputError(fmt::format("the tensor '{}' of {} {}", Printable(tensor.name),
                                 tensor.shape.empty() ? "one value" : DescribeShape(tensor.shape),
                                 fault));
  };
  const auto* const type = std::ranges::find(kDataTypes, type_number, &DataType::number);
  if (type == kDataTypes.end()) {
    fail(fmt::format("has the data type {}, expected one of ONNX", type_number));
  }
  const std::optional<size_t> expected = CountOf(tensor.shape);
  if (!expected) {
    fail("has a shape with a negative or too large side");
  }
  const std::optional<size_t> present = CountPresent(message, *type);
  if (!present) {
    fail(fmt::format("has values of another type than {}", type->name));
  }
  if (*present != *expected) {
    fail(fmt::format("has {} values of the type {}, expected {}", *present, type->name, *expected));
  }
}

// The name of the file in an entry of external data; absent for another entry.
std::optional<std::string> LocationIn(std::string_view entry) {
  std::string key;
  std::string value;
  for (ProtobufReader fields(entry, kOnnxName); fields.Next();) {
    (fields.field() == 1 ? key : value) = fields.bytes();
  }
  return key == "location" ? std::optional(value) : std::nullopt;
}

}  // namespace

std::vector<int64_t> ReadIntegers(std::string_view message, uint64_t field) {
  std::vector<int64_t> values;
  for (ProtobufReader fields(message, kOnnxName); fields.Next();) {
    if (fields.field() != field) {
      continue;
    }
    if (!fields.has_bytes()) {
      values.push_back(static_cast<int64_t>(fields.number()));
    }
    // A packed list has no keys. With one before each number it is a message.
    for (std::string_view left = fields.bytes(); !left.empty();) {
      const auto* const end = std::ranges::find_if(
          left, [](char byte) { return static_cast<unsigned char>(byte) < 0x80; });
      const auto size = std::min<size_t>(static_cast<size_t>(end - left.begin()) + 1, left.size());
      const std::string number = '\x08' + std::string(left.substr(0, size));
      ProtobufReader reader(number, kOnnxName);
      reader.Next();
      values.push_back(static_cast<int64_t>(reader.number()));
      left.remove_prefix(size);
    }
  }
  return values;
}

OnnxTensor ReadTensor(std::string_view message) {
  OnnxTensor tensor;
  int64_t type = 0;
  for (ProtobufReader fields(message, kOnnxName); fields.Next();) {
    if (fields.field() == 2) {
      type = static_cast<int64_t>(fields.number());
    } else if (fields.field() == 8) {
      tensor.name = fields.bytes();
    } else if (fields.field() == 13) {
      const std::optional<std::string> location = LocationIn(fields.bytes());
      tensor.file = location ? location : tensor.file;
    }
  }
  tensor.shape = ReadIntegers(message, 1);
  if (!tensor.file) {
    CheckValues(message, tensor, type);
  }
  return tensor;
}

}  // namespace hullslam
