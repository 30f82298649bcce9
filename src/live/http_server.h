// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "live/http_access.h"
#include "live/message_hub.h"

namespace hullslam {

struct HttpReply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  SharedMessage body = {};  // null: empty
  // Instead of a body, the messages of the hub as server-sent events (WHATWG HTML, section 9.2)
  // until the browser or this server ends.
  bool is_stream = false;
};

// A reply of one line.
HttpReply TextReply(int status, std::string_view text);

// The limits that keep a browser from slowing or growing the run.
struct HttpLimits {
  size_t connections = 32;  // more are closed at once
  size_t streams = 8;       // of these connections; more are refused with 503
  uint32_t header_bytes = 8192;
  uint64_t body_bytes = 1024;
  double requests_per_second = 100.0;     // of all browsers; more have to wait
  std::chrono::seconds idle{15};          // a request that has not arrived by then is dropped
  std::chrono::seconds write{30};         // a message that was not taken by then is the last one
  std::chrono::seconds sign_of_life{10};  // time without a message, after which a comment is sent
  int send_buffer_bytes = 256 * 1024;     // of the system, so that a slow browser is noticed early
};

// A small HTTP/1.1 server in one thread of low priority. The address is an IP address.
class HttpServer {
 public:
  // `handle` is called in the thread of the server and must return soon. Messages of `hub`, which
  // must outlive the server, go to the streams. `port` 0: any free one. Throws InputError if the
  // address is none of this computer or if the port is taken.
  HttpServer(const std::string& address, int port, const HttpLimits& limits, MessageHub& hub,
             std::function<HttpReply(const HttpRequest&)> handle);
  // Ends all connections.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  // Bytes of the bodies that were sent so far.
  uint64_t bytes_sent() const;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

// "127.0.0.1:8320", with brackets around an address of IPv6.
std::string JoinAddress(const std::string& address, int port);

}  // namespace hullslam
