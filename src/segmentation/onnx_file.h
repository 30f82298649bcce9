// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
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

// Looks through the graph of a network (a GraphProto) for what OpenCV would not notice before it
// reads or writes memory that is not its own: tensors without their values, and attributes of nodes
// that are out of range. Throws InputError with the name of the tensor or node. Adds the names of
// the files that have values of tensors to `weight_files`.
void CheckGraph(std::string_view graph, std::set<std::string>& weight_files);

// An input or output of a network.
struct OnnxValue {
  std::string name;
  int64_t type = 0;            // TensorProto.DataType: 1 is float, 10 is half precision
  std::vector<int64_t> shape;  // -1 for a size that the file leaves open
};

// A file of ONNX, as far as it can be read without running it.
struct OnnxFile {
  std::string bytes;
  std::vector<OnnxValue> inputs;  // without the weights, which older files list among the inputs
  std::vector<OnnxValue> outputs;
  std::map<std::string, std::string> metadata;
};

// Reads a network in ONNX (onnx/onnx.proto has the numbers of the fields). Throws InputError for
// another file, with what it seems to be, and for weights that are in files of their own.
OnnxFile ReadOnnx(const std::filesystem::path& path);

// "1x3x480x640"; an open size is "?".
std::string DescribeShape(const std::vector<int64_t>& shape);

}  // namespace hullslam
