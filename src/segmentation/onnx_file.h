// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hullslam {

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
