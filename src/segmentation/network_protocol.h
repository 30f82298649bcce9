// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace hullslam {

// What the program hullslam_network and its caller send each other. Both belong to one build and
// run on one computer, so the structs are sent as they are in memory.
//
// The caller sends the size of a file of ONNX (uint64_t) and its bytes, and gets a NetworkReply.
// Then it sends a NetworkRequest and the numbers of the input, gets a NetworkReply and so on.
// Closing the connection ends the program.

// The descriptor of the program's end of the connection.
inline constexpr int kNetworkDescriptor = 3;
inline constexpr int kMostDimensions = 32;  // of OpenCV

struct NetworkRequest {
  std::array<int32_t, 4> shape = {};  // of the input, whose numbers (float) follow
  int32_t threads = 0;                // of OpenCV
  int32_t niceness = 0;               // of the caller's thread
};

enum class NetworkStatus : uint32_t { kDone, kFailed, kNoMemory };

struct NetworkReply {
  NetworkStatus status = NetworkStatus::kDone;
  uint32_t text = 0;         // bytes of a message that follow, if it has failed
  uint32_t outputs = 0;      // that follow
  uint64_t peak_memory = 0;  // of the program, bytes
};

// An output: this struct, its name and its numbers (float).
struct NetworkReplyOutput {
  uint32_t name = 0;  // bytes
  int32_t dimensions = 0;
  std::array<int32_t, kMostDimensions> shape = {};
};

}  // namespace hullslam
