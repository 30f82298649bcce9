// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that includes Boost.Beast, because its headers take long to compile.
#include "live/http_server.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <thread>
#include <utility>

#include "hullslam/util/error.h"
#include "live/http_access.h"
#include "util/task_runner.h"

namespace hullslam {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

class Connection;

// The data that the connections of a server share. Only the thread of the server uses it.
struct Shared {
  asio::io_context& context;
  const HttpLimits limits;
  MessageHub& hub;
  const std::function<HttpReply(const HttpRequest&)> handle;
  RateLimit rate;
  std::set<std::shared_ptr<Connection>> connections;
  size_t streams = 0;
  std::atomic<uint64_t> bytes_sent = 0;
};

HttpRequest ReadRequest(const http::request<http::string_body>& parsed) {
  const auto field = [&](beast::string_view name) {
    const auto found = parsed.find(name);
    return found != parsed.end() ? std::string(found->value()) : std::string();
  };
  HttpRequest request{.method = std::string(parsed.method_string()),
                      .path = {},
                      .token = {},
                      .host = field("Host"),
                      .origin = field("Origin"),
                      .fetch_site = field("Sec-Fetch-Site")};
  SplitTarget({parsed.target().data(), parsed.target().size()}, request);
  if (std::string token = field("X-Hullslam-Token"); !token.empty()) {
    request.token = std::move(token);
  }
  return request;
}

// The bytes of the header of a reply.
std::string TextOf(const http::response<http::empty_body>& header) {
  const auto text_of = [](beast::string_view text) {
    return std::string_view(text.data(), text.size());
  };
  std::string text = fmt::format("HTTP/1.1 {} {}\r\n", header.result_int(),
                                 text_of(http::obsolete_reason(header.result())));
  for (const auto& field : header) {
    text += fmt::format("{}: {}\r\n", text_of(field.name_string()), text_of(field.value()));
  }
  return text + "\r\n";
}

// One browser. It lives as long as an operation of it is under way.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Tcp::socket socket, Shared& shared)
      : shared_(shared),
        stream_(std::move(socket)),
        timer_(shared.context),
        buffer_(shared.limits.header_bytes + shared.limits.body_bytes) {}

  void Read() {
    parser_.emplace();
    parser_->header_limit(shared_.limits.header_bytes);
    parser_->body_limit(shared_.limits.body_bytes);
    stream_.expires_after(shared_.limits.idle);
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](const Error& error, size_t) { self->OnRequest(error); });
  }

  void Close() {
    shared_.connections.erase(shared_from_this());
    timer_.cancel();
    Error ignored;
    stream_.socket().shutdown(Tcp::socket::shutdown_both, ignored);
    stream_.close();
    if (reader_) {
      shared_.hub.RemoveReader(*std::exchange(reader_, std::nullopt));
      --shared_.streams;
    }
  }

  // Sends the next message to a stream, if there is one and nothing is being sent.
  void Pump() {
    if (!reader_ || is_writing_) {
      return;
    }
    message_ = shared_.hub.Take(*reader_);
    if (message_ == nullptr) {
      AwaitSignOfLife();
      return;
    }
    static constexpr std::string_view kBegin = "data: ";
    static constexpr std::string_view kEnd = "\n\n";
    Write(std::array{asio::buffer(kBegin.data(), kBegin.size()), asio::buffer(*message_),
                     asio::buffer(kEnd.data(), kEnd.size())},
          [this] { Pump(); });
  }

 private:
  void OnRequest(const Error& error) {
    const bool is_gone = error == http::error::end_of_stream || error == beast::error::timeout ||
                         error == asio::error::eof ||
                         (error && error.category() == asio::error::get_system_category());
    if (is_gone) {
      Close();
      return;
    }
    // A flood of requests waits here, so it takes no core from the run.
    timer_.expires_after(shared_.rate.Take(RateLimit::Clock::now()));
    timer_.async_wait([self = shared_from_this(), error](const Error& cancelled) {
      if (!cancelled) {
        self->Answer(error);
      }
    });
  }

  void Answer(const Error& error) {
    if (error) {
      const bool is_long = error == http::error::header_limit || error == http::error::body_limit ||
                           error == http::error::buffer_overflow;
      Reply(TextReply(is_long ? 413 : 400, "expected a small HTTP/1.1 request"), false);
      return;
    }
    const HttpRequest request = ReadRequest(parser_->get());
    HttpReply reply = shared_.handle(request);
    if (reply.is_stream && shared_.streams >= shared_.limits.streams) {
      reply = TextReply(503, fmt::format("{} browsers watch this run already, which is the most",
                                         shared_.streams));
    }
    Reply(reply, parser_->get().keep_alive() && !reply.is_stream);
  }

  void Reply(const HttpReply& reply, bool keep_alive) {
    http::response<http::empty_body> header(static_cast<http::status>(reply.status), 11);
    header.set(http::field::content_type, reply.type);
    header.set(http::field::cache_control, "no-store");
    header.set("X-Content-Type-Options", "nosniff");
    header.set("X-Frame-Options", "DENY");
    header.set("Referrer-Policy", "no-referrer");
    header.set("Cross-Origin-Resource-Policy", "same-origin");
    header.keep_alive(keep_alive);
    message_ = reply.is_stream ? nullptr : reply.body;
    if (!reply.is_stream) {
      header.content_length(message_ != nullptr ? message_->size() : 0);
    }
    header_ = TextOf(header);
    const asio::const_buffer body =
        message_ != nullptr ? asio::buffer(*message_) : asio::const_buffer();
    const bool is_stream = reply.is_stream;
    Write(std::array{asio::const_buffer(asio::buffer(header_)), body},
          [this, keep_alive, is_stream] {
            if (is_stream) {
              BeginStream();
            } else if (keep_alive) {
              Read();
            } else {
              Close();
            }
          });
  }

  template <typename Buffers, typename Next>
  void Write(const Buffers& buffers, Next next) {
    is_writing_ = true;
    timer_.cancel();
    stream_.expires_after(shared_.limits.write);
    asio::async_write(stream_, buffers,
                      [self = shared_from_this(), next](const Error& error, size_t size) {
                        self->is_writing_ = false;
                        self->message_ = nullptr;
                        self->shared_.bytes_sent += size;
                        if (error) {
                          self->Close();
                        } else {
                          next();
                        }
                      });
  }

  void BeginStream() {
    if (shared_.connections.count(shared_from_this()) == 0) {
      return;
    }
    reader_ = shared_.hub.AddReader();
    ++shared_.streams;
    AwaitEnd();
    Pump();
  }

  // A browser has nothing to say on a stream, so a read ends only when it goes away.
  void AwaitEnd() {
    stream_.socket().async_read_some(
        asio::buffer(unread_),
        [self = shared_from_this()](const Error&, size_t) { self->Close(); });
  }

  void AwaitSignOfLife() {
    timer_.expires_after(shared_.limits.sign_of_life);
    timer_.async_wait([self = shared_from_this()](const Error& cancelled) {
      if (!cancelled && self->reader_ && !self->is_writing_) {
        static constexpr std::string_view kComment = ":\n\n";
        self->Write(std::array{asio::buffer(kComment.data(), kComment.size())},
                    [connection = self.get()] { connection->Pump(); });
      }
    });
  }

  Shared& shared_;
  beast::tcp_stream stream_;
  asio::steady_timer timer_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::string header_;
  SharedMessage message_;  // what is being sent
  std::array<char, 64> unread_{};
  std::optional<MessageHub::ReaderId> reader_;  // of a stream
  bool is_writing_ = false;
};

}  // namespace

class HttpServer::Engine {
 public:
  Engine(const std::string& address, int port, const HttpLimits& limits, MessageHub& hub,
         std::function<HttpReply(const HttpRequest&)> handle)
      : shared_{.context = context_,
                .limits = limits,
                .hub = hub,
                .handle = std::move(handle),
                .rate = RateLimit(limits.requests_per_second, limits.requests_per_second / 4.0),
                .connections = {}},
        acceptor_(context_),
        accept_timer_(context_),
        accepts_(limits.requests_per_second, limits.requests_per_second / 4.0) {
    Listen(address, port);
    hub.SetNotification([this] { NotifyStreams(); });
    Accept();
    thread_ = std::thread([this] {
      RunInBackground();
      context_.run();
    });
  }

  ~Engine() {
    shared_.hub.SetNotification({});
    context_.stop();
    thread_.join();
    while (!shared_.connections.empty()) {
      (*shared_.connections.begin())->Close();
    }
  }
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  int port() const { return acceptor_.local_endpoint().port(); }
  uint64_t bytes_sent() const { return shared_.bytes_sent; }

 private:
  void Listen(const std::string& address, int port) {
    Error error;
    const asio::ip::address parsed = asio::ip::make_address(address, error);
    if (error) {
      throw InputError(fmt::format(
          "--view-address is '{}', expected an IP address such as 127.0.0.1 or 0.0.0.0", address));
    }
    const Tcp::endpoint endpoint(parsed, static_cast<uint16_t>(port));
    acceptor_.open(endpoint.protocol(), error);
    if (!error) {
      acceptor_.set_option(Tcp::acceptor::reuse_address(true));
      acceptor_.set_option(asio::socket_base::send_buffer_size(shared_.limits.send_buffer_bytes));
      acceptor_.bind(endpoint, error);
    }
    if (!error) {
      acceptor_.listen(static_cast<int>(shared_.limits.connections), error);
    }
    if (error) {
      throw InputError(fmt::format(
          "the live view cannot listen on {}: {}; choose another port with --view PORT, or "
          "--view 0 for any free one",
          JoinAddress(address, port), error.message()));
    }
  }

  void Accept() {
    acceptor_.async_accept([this](const Error& error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) {
        return;
      }
      if (!error && shared_.connections.size() < shared_.limits.connections) {
        const auto connection = std::make_shared<Connection>(std::move(socket), shared_);
        shared_.connections.insert(connection);
        connection->Read();
      }
      accept_timer_.expires_after(accepts_.Take(RateLimit::Clock::now()));
      accept_timer_.async_wait([this](const Error& cancelled) {
        if (!cancelled) {
          Accept();
        }
      });
    });
  }

  // Called by the threads that give messages. One task in the queue is enough for all of them.
  void NotifyStreams() {
    if (!is_notified_.exchange(true)) {
      asio::post(context_, [this] {
        is_notified_ = false;
        const auto connections = shared_.connections;
        for (const std::shared_ptr<Connection>& connection : connections) {
          connection->Pump();
        }
      });
    }
  }

  asio::io_context context_{1};
  Shared shared_;
  Tcp::acceptor acceptor_;
  asio::steady_timer accept_timer_;
  RateLimit accepts_;
  std::atomic<bool> is_notified_ = false;
  std::thread thread_;
};

HttpReply TextReply(int status, std::string_view text) {
  return {.status = status, .body = std::make_shared<const std::string>(std::string(text) + "\n")};
}

HttpServer::HttpServer(const std::string& address, int port, const HttpLimits& limits,
                       MessageHub& hub, std::function<HttpReply(const HttpRequest&)> handle)
    : engine_(std::make_unique<Engine>(address, port, limits, hub, std::move(handle))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return engine_->port(); }

uint64_t HttpServer::bytes_sent() const { return engine_->bytes_sent(); }

std::string JoinAddress(const std::string& address, int port) {
  return address.find(':') == std::string::npos ? fmt::format("{}:{}", address, port)
                                                : fmt::format("[{}]:{}", address, port);
}

}  // namespace hullslam
