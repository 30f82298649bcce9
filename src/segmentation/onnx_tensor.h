// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// Begins the messages of readers of a file of ONNX.
inline constexpr const char* kOnnxName = "the file";

// The values of a repeated field of integers with this number (onnx/onnx.proto), which may be
// packed.
std::vector<int64_t> ReadIntegers(std::string_view message, uint64_t field);

// What is read of a tensor in a file of ONNX, whose message there is a TensorProto.
struct OnnxTensor {
  std::string name;
  std::vector<int64_t> shape;
  std::optional<std::string> file;  // that has the values, if they are not in the message
};

// Throws InputError unless the tensor has as many values as its shape says: OpenCV does not count
// them before it reads them.
OnnxTensor ReadTensor(std::string_view message);

}  // namespace hullslam
