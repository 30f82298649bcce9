// SPDX-License-Identifier: GPL-3.0-or-later
// The program hullslam_network, which open_network.cc starts: it runs a network for its caller.
// OpenCV trusts what a network says and may crash with one that is broken or made by an attacker;
// then only this program ends.

#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "segmentation/network_protocol.h"

namespace hullslam {
namespace {

// The caller has closed the connection.
struct Closed {};

void Receive(void* bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    const ssize_t count =
        ::recv(kNetworkDescriptor, static_cast<char*>(bytes) + done, size - done, 0);
    if (count == 0 || (count < 0 && errno != EINTR)) {
      throw Closed();
    }
    done += count > 0 ? static_cast<size_t>(count) : 0;
  }
}

void Send(const void* bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    const ssize_t count = ::send(kNetworkDescriptor, static_cast<const char*>(bytes) + done,
                                 size - done, MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) {
      throw Closed();
    }
    done += count > 0 ? static_cast<size_t>(count) : 0;
  }
}

// A network that asks for more than half of the memory of the computer fails, instead of that the
// system ends some program.
void LimitMemory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  constexpr rlim_t kLeast = rlim_t{1} << 30;
  const auto physical =
      static_cast<rlim_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  rlimit limit{};
  ::getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min(limit.rlim_max, std::max(kLeast, physical / 2));
  ::setrlimit(RLIMIT_DATA, &limit);
#endif
  const rlimit no_core{.rlim_cur = 0, .rlim_max = 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

uint64_t PeakMemory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

void SendReply(NetworkStatus status, const std::string& text, size_t outputs) {
  const NetworkReply reply{.status = status,
                           .text = static_cast<uint32_t>(text.size()),
                           .outputs = static_cast<uint32_t>(outputs),
                           .peak_memory = PeakMemory()};
  Send(&reply, sizeof(reply));
  Send(text.data(), text.size());
}

// Calls `work` and replies that it failed if it throws an exception.
template <typename Work>
bool Try(const Work& work) {
  NetworkStatus status = NetworkStatus::kFailed;
  std::string text;
  try {
    work();
    return true;
  } catch (const cv::Exception& error) {
    status = error.code == cv::Error::StsNoMem ? NetworkStatus::kNoMemory : NetworkStatus::kFailed;
    text = error.err;
  } catch (const std::bad_alloc&) {
    status = NetworkStatus::kNoMemory;
  } catch (const std::exception& error) {
    text = error.what();
  }
  SendReply(status, text, 0);
  return false;
}

struct LoadedNetwork {
  cv::dnn::Net net;
  std::vector<std::string> names;  // of the outputs
};

LoadedNetwork Load(const std::vector<char>& bytes) {
  LoadedNetwork loaded;
  loaded.net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
  loaded.names = loaded.net.getUnconnectedOutLayersNames();
  loaded.net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  loaded.net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  return loaded;
}

void CheckOutputs(const LoadedNetwork& network, const std::vector<cv::Mat>& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i].type() != CV_32F || !values[i].isContinuous() ||
        values[i].dims > kMostDimensions) {
      throw std::runtime_error("the output '" + network.names.at(i) + "' has no values of float");
    }
  }
}

void SendOutputs(const LoadedNetwork& network, const std::vector<cv::Mat>& values) {
  SendReply(NetworkStatus::kDone, "", values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    NetworkReplyOutput output{.name = static_cast<uint32_t>(network.names[i].size()),
                              .dimensions = values[i].dims};
    std::copy_n(values[i].size.p, values[i].dims, output.shape.begin());
    Send(&output, sizeof(output));
    Send(network.names[i].data(), network.names[i].size());
    Send(values[i].data, values[i].total() * sizeof(float));
  }
}

void AnswerRequest(LoadedNetwork& network) {
  NetworkRequest request;
  Receive(&request, sizeof(request));
  cv::Mat input(static_cast<int>(request.shape.size()), request.shape.data(), CV_32F);
  Receive(input.data, input.total() * sizeof(float));
  if (request.threads > 0 && request.threads != cv::getNumThreads()) {
    cv::setNumThreads(request.threads);
  }
  ::setpriority(PRIO_PROCESS, 0, request.niceness);
  std::vector<cv::Mat> values;
  const bool is_done = Try([&] {
    network.net.setInput(input);
    network.net.forward(values, network.names);
    CheckOutputs(network, values);
  });
  if (is_done) {
    SendOutputs(network, values);
  }
}

void Serve() {
  uint64_t size = 0;
  Receive(&size, sizeof(size));
  std::vector<char> bytes(size);
  Receive(bytes.data(), bytes.size());
  LoadedNetwork network;
  if (!Try([&] { network = Load(bytes); })) {
    return;
  }
  bytes = {};
  SendReply(NetworkStatus::kDone, "", 0);
  while (true) {
    AnswerRequest(network);
  }
}

}  // namespace
}  // namespace hullslam

int main() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  hullslam::LimitMemory();
  try {
    hullslam::Serve();
  } catch (const hullslam::Closed&) {
  }
  // Memory that a network has written over is not freed any more.
  std::_Exit(0);
}
