// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/open_network.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "files/paths.h"
#include "hullslam/util/check.h"
#include "segmentation/child_process.h"
#include "segmentation/network_protocol.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "hullslam_network";

// Finds the program in the installation that this code is in, in the one of the configuration, or
// where it was built.
fs::path FindProgram() {
  std::vector<fs::path> files;
  for (fs::path folder = FileOfThisCode().parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    files.push_back(folder / HULLSLAM_NETWORK_LIBDIR / kProgram);
  }
  files.push_back(fs::path(HULLSLAM_NETWORK_INSTALLED) / kProgram);
  files.push_back(fs::path(HULLSLAM_NETWORK_BUILT) / kProgram);
  std::error_code error;
  const auto found =
      std::ranges::find_if(files, [&](const fs::path& file) { return fs::exists(file, error); });
  if (found == files.end()) {
    throw std::runtime_error(
        fmt::format("masks need {}, which belongs to HullSLAM and is not installed", kProgram));
  }
  return *found;
}

class NetworkProcess final : public Network {
 public:
  NetworkProcess(std::string bytes, int threads)
      : bytes_(std::move(bytes)), threads_(threads), program_(FindProgram()) {
    Begin();
  }

  std::vector<NetworkOutput> Run(const cv::Mat& input) override {
    NetworkRequest request{.threads = threads_, .niceness = ThreadNiceness()};
    Check(input.type() == CV_32F && input.isContinuous() &&
              input.dims == static_cast<int>(request.shape.size()),
          "the input is not CV_32F with four dimensions");
    std::copy_n(input.size.p, request.shape.size(), request.shape.begin());
    if (child_ == nullptr || !child_->IsOwn()) {
      Begin();
    }
    try {
      child_->Send(&request, sizeof(request));
      child_->Send(input.data, input.total() * sizeof(float));
      return ReceiveOutputs(ReceiveReply());
    } catch (const ChildProcess::Ended& error) {
      child_ = nullptr;
      throw NetworkError(error.what());
    }
  }

 private:
  // Starts the program and lets it read the network.
  void Begin() {
    child_ = std::make_unique<ChildProcess>(program_, kNetworkDescriptor);
    try {
      const uint64_t size = bytes_.size();
      child_->Send(&size, sizeof(size));
      child_->Send(bytes_.data(), bytes_.size());
      ReceiveReply();
    } catch (const ChildProcess::Ended& error) {
      child_ = nullptr;
      throw NetworkError(error.what());
    } catch (const NetworkError&) {
      child_ = nullptr;
      throw;
    }
  }

  static int ThreadNiceness() {
    return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)));
  }

  template <typename Value>
  Value Receive() {
    Value value;
    child_->Receive(&value, sizeof(value));
    return value;
  }

  std::string ReceiveText(size_t size) {
    constexpr size_t kMost = 1'000'000;
    Require(size <= kMost);
    std::string text(size, '\0');
    child_->Receive(text.data(), text.size());
    return text;
  }

  // The program may be one whose memory a network has written over.
  void Require(bool is_sensible) {
    if (!is_sensible) {
      child_ = nullptr;
      throw NetworkError("its answer makes no sense");
    }
  }

  NetworkReply ReceiveReply() {
    const auto reply = Receive<NetworkReply>();
    const std::string text = ReceiveText(reply.text);
    if (reply.status == NetworkStatus::kNoMemory) {
      throw NetworkError("it needs more than half of this computer's memory");
    }
    if (reply.status != NetworkStatus::kDone) {
      throw NetworkError(text);
    }
    return reply;
  }

  std::vector<NetworkOutput> ReceiveOutputs(const NetworkReply& reply) {
    constexpr uint32_t kMostOutputs = 10'000;
    constexpr int64_t kMostValues = int64_t{1} << 30;  // of all outputs
    Require(reply.outputs <= kMostOutputs);
    std::vector<NetworkOutput> outputs;
    int64_t left = kMostValues;
    for (uint32_t i = 0; i < reply.outputs; ++i) {
      const auto header = Receive<NetworkReplyOutput>();
      Require(header.dimensions > 0 && header.dimensions <= kMostDimensions);
      int64_t count = 1;
      for (int k = 0; k < header.dimensions; ++k) {
        const int64_t side = header.shape.at(static_cast<size_t>(k));
        Require(side >= 0 && (side == 0 || count <= left / side));
        count *= side;
      }
      left -= count;
      NetworkOutput output{.name = ReceiveText(header.name), .values = {}};
      output.values.create(header.dimensions, header.shape.data(), CV_32F);
      child_->Receive(output.values.data, static_cast<size_t>(count) * sizeof(float));
      outputs.push_back(std::move(output));
    }
    return outputs;
  }

  const std::string bytes_;  // to start the program again
  const int threads_;
  const fs::path program_;
  std::unique_ptr<ChildProcess> child_;  // null after it has ended
};

}  // namespace

std::unique_ptr<Network> OpenNetwork(std::string bytes, int threads) {
  return std::make_unique<NetworkProcess>(std::move(bytes), threads);
}

}  // namespace hullslam
