// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hullslam {

// A connection to a server on this computer that sends and reads bytes as they are, so that tests
// can also send what no browser would.
class RawClient {
 public:
  explicit RawClient(int port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      ::close(socket_);
      throw std::runtime_error("cannot connect");
    }
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void Send(std::string_view text) const {
    ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }

  // Reads until the text contains `end` or the server closes the connection, at most so long.
  std::string ReadUntil(std::string_view end,
                        std::chrono::seconds longest = std::chrono::seconds(60)) {
    const auto deadline = std::chrono::steady_clock::now() + longest;
    std::array<char, 65536> chunk{};
    size_t at = read_.find(end);
    while (at == std::string::npos && !is_closed_ && std::chrono::steady_clock::now() < deadline) {
      pollfd ready{socket_, POLLIN, 0};
      if (::poll(&ready, 1, 50) <= 0) {
        continue;
      }
      const ssize_t size = ::recv(socket_, chunk.data(), chunk.size(), 0);
      is_closed_ = size <= 0;
      const size_t searched = read_.size() - std::min(read_.size(), end.size());
      read_.append(chunk.data(), size > 0 ? static_cast<size_t>(size) : 0);
      at = read_.find(end, searched);
    }
    const size_t size = at == std::string::npos ? read_.size() : at + end.size();
    std::string text = read_.substr(0, size);
    read_.erase(0, size);
    return text;
  }

  // All that comes until the server closes the connection.
  std::string ReadAll(std::chrono::seconds longest = std::chrono::seconds(60)) {
    return ReadUntil(std::string_view("\0never\0", 7), longest);
  }
  bool is_closed() const { return is_closed_; }

 private:
  int socket_ = -1;
  std::string read_;
  bool is_closed_ = false;
};

// The reply to one request, with its header.
inline std::string Ask(int port, const std::string& line, const std::string& fields = {}) {
  RawClient client(port);
  client.Send(line + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n" + fields + "\r\n");
  return client.ReadAll();
}

}  // namespace hullslam
