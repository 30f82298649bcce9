// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/onnx_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "files/protobuf_reader.h"
#include "files/read_file.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr size_t kMostBytes = size_t{1} << 31;  // a message of protobuf is not longer

// The bytes of the first field with this number; empty if there is none.
std::string_view FindField(std::string_view message, uint64_t field) {
  ProtobufReader fields(message, "the file");
  while (fields.Next()) {
    if (fields.field() == field) {
      return fields.bytes();
    }
  }
  return {};
}

// StringStringEntryProto.
std::pair<std::string, std::string> ReadEntry(std::string_view message) {
  return {std::string(FindField(message, 1)), std::string(FindField(message, 2))};
}

int64_t ReadDimension(std::string_view message) {
  ProtobufReader fields(message, "the file");
  int64_t size = -1;
  while (fields.Next()) {
    if (fields.field() == 1 && fields.number() > 0 && fields.number() <= kMostBytes) {
      size = static_cast<int64_t>(fields.number());
    }
  }
  return size;
}

// ValueInfoProto.
OnnxValue ReadValue(std::string_view message) {
  OnnxValue value;
  value.name = FindField(message, 1);
  ProtobufReader tensor(FindField(FindField(message, 2), 1), "the file");
  while (tensor.Next()) {
    if (tensor.field() == 1) {
      value.type = static_cast<int64_t>(tensor.number());
    } else if (tensor.field() == 2) {
      ProtobufReader dimensions(tensor.bytes(), "the file");
      while (dimensions.Next()) {
        value.shape.push_back(ReadDimension(dimensions.bytes()));
      }
    }
  }
  return value;
}

// GraphProto.
void ReadGraph(std::string_view message, OnnxFile& file) {
  std::set<std::string> weights;
  ProtobufReader fields(message, "the file");
  while (fields.Next()) {
    if (fields.field() == 5) {
      weights.emplace(FindField(fields.bytes(), 8));
    } else if (fields.field() == 11) {
      file.inputs.push_back(ReadValue(fields.bytes()));
    } else if (fields.field() == 12) {
      file.outputs.push_back(ReadValue(fields.bytes()));
    }
  }
  std::erase_if(file.inputs, [&](const OnnxValue& value) { return weights.contains(value.name); });
}

// ModelProto.
void ReadModel(OnnxFile& file) {
  ProtobufReader fields(file.bytes, "the file");
  while (fields.Next()) {
    if (fields.field() == 7) {
      ReadGraph(fields.bytes(), file);
    } else if (fields.field() == 14) {
      file.metadata.insert(ReadEntry(fields.bytes()));
    }
  }
  if (file.inputs.empty() || file.outputs.empty()) {
    throw InputError("the file has no graph");
  }
}

// What a file that is no ONNX seems to be, for the message.
std::string Guess(std::string_view bytes) {
  if (bytes.empty()) {
    return "is empty";
  }
  if (bytes.starts_with("PK")) {
    return "seems to be a network of PyTorch";
  }
  const auto is_text = [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\t'; };
  return std::ranges::all_of(bytes.substr(0, 256), is_text) ? "is a text"
                                                            : "is no network in ONNX, or cut off";
}

}  // namespace

OnnxFile ReadOnnx(const std::filesystem::path& path) {
  OnnxFile file{.bytes = ReadFile(path, kMostBytes), .inputs = {}, .outputs = {}, .metadata = {}};
  try {
    ReadModel(file);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {} ({}), expected a network in ONNX", path.string(),
                                 Guess(file.bytes), error.what()));
  }
  std::set<std::string> weight_files;
  try {
    for (ProtobufReader fields(file.bytes, "the file"); fields.Next();) {
      if (fields.field() == 7) {
        CheckGraph(fields.bytes(), weight_files);
      }
    }
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}; expected a network whose parts fit together",
                                 path.string(), error.what()));
  }
  if (!weight_files.empty()) {
    constexpr size_t kShown = 200;  // bytes of a name, which may be anything in a broken file
    throw InputError(fmt::format(
        "{}: the weights are in {}, first '{}', expected one file; scripts/prepare_network.py "
        "joins them",
        path.string(), Counted(weight_files.size(), "other file"),
        Printable(weight_files.begin()->substr(0, kShown))));
  }
  return file;
}

std::string DescribeShape(const std::vector<int64_t>& shape) {
  std::string text;
  for (const int64_t size : shape) {
    text += fmt::format("{}{}", text.empty() ? "" : "x", size < 0 ? "?" : std::to_string(size));
  }
  return text;
}

}  // namespace hullslam
