// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/http_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "support/expect_error.h"
#include "support/raw_client.h"

namespace hullslam {
namespace {

using namespace std::chrono_literals;

SharedMessage Shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

class HttpServerTest : public ::testing::Test {
 protected:
  void Start(const HttpLimits& limits = {}) {
    server_.emplace("127.0.0.1", 0, limits, hub_, [this](const HttpRequest& request) {
      ++requests_;
      if (request.path == "/stream") {
        return HttpReply{.is_stream = true};
      }
      return HttpReply{.status = request.path == "/" ? 200 : 404,
                       .body = Shared(request.method + " " + request.path + " " + request.host +
                                      " " + request.origin + " " + request.token)};
    });
  }
  void TearDown() override { server_.reset(); }

  int port() const { return server_->port(); }

  // A client that has begun to read the stream.
  std::unique_ptr<RawClient> OpenStream(int receive_buffer = 0) {
    const size_t before = hub_.reader_count();
    auto client = std::make_unique<RawClient>(port(), receive_buffer);
    client->Send("GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_NE(client->ReadUntil("\r\n\r\n").find("text/"), std::string::npos);
    WaitForReaders(before + 1);
    return client;
  }

  void WaitForReaders(size_t count) {
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (hub_.reader_count() != count && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(5ms);
    }
    EXPECT_EQ(hub_.reader_count(), count);
  }

  MessageHub hub_;
  std::atomic<int> requests_ = 0;
  std::optional<HttpServer> server_;
};

TEST_F(HttpServerTest, AnswersWithHeadersThatKeepOtherSitesOut) {
  Start();
  const std::string reply =
      Ask(port(), "GET /?token=ab", "Origin: http://x\r\nSec-Fetch-Site: none\r\n");
  EXPECT_EQ(reply.find("HTTP/1.1 200"), 0u);
  for (const char* text :
       {"GET / 127.0.0.1 http://x ab", "X-Content-Type-Options: nosniff", "X-Frame-Options: DENY",
        "Referrer-Policy: no-referrer", "Cache-Control: no-store",
        "Cross-Origin-Resource-Policy: same-origin"}) {
    EXPECT_NE(reply.find(text), std::string::npos) << text << '\n' << reply;
  }
  EXPECT_EQ(Ask(port(), "POST /x", "X-Hullslam-Token: cd\r\n").find("HTTP/1.1 404"), 0u);
}

TEST_F(HttpServerTest, AConnectionServesSeveralRequests) {
  Start();
  RawClient client(port());
  for (int i = 0; i < 3; ++i) {
    client.Send("GET / HTTP/1.1\r\nHost: h\r\n\r\n");
    EXPECT_NE(client.ReadUntil("GET / h  ").find("200"), std::string::npos);
  }
}

TEST_F(HttpServerTest, GarbageAndLongRequestsAreRefused) {
  Start({.header_bytes = 1000, .body_bytes = 100});
  RawClient garbage(port());
  garbage.Send(std::string("\x16\x03\x01\0\xff garbage\r\n\r\n", 17));
  EXPECT_EQ(garbage.ReadAll().find("HTTP/1.1 400"), 0u);
  EXPECT_TRUE(garbage.is_closed());
  EXPECT_EQ(Ask(port(), "GET /", "X: " + std::string(3000, 'a') + "\r\n").find("HTTP/1.1 413"), 0u);
  EXPECT_EQ(Ask(port(), "POST /", "Content-Length: 1000000\r\n").find("HTTP/1.1 413"), 0u);
  EXPECT_EQ(requests_, 0);
  EXPECT_EQ(Ask(port(), "GET /").find("HTTP/1.1 200"), 0u);
}

TEST_F(HttpServerTest, HalfARequestIsDropped) {
  Start({.idle = 1s});
  RawClient half(port());
  half.Send("GET / HTTP/1.1\r\nHost: loc");
  EXPECT_EQ(half.ReadAll(), "");
  EXPECT_TRUE(half.is_closed());
  { RawClient(port()).Send("GET / HT"); }
  EXPECT_EQ(Ask(port(), "GET /").find("HTTP/1.1 200"), 0u);
  EXPECT_EQ(requests_, 1);
}

TEST_F(HttpServerTest, TooManyConnectionsAreClosedAndOthersGoOn) {
  Start({.connections = 4});
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(std::make_unique<RawClient>(port()));
    clients.back()->Send("GET / HTTP/1.1\r\nHost: h\r\n\r\n");
    EXPECT_NE(clients.back()->ReadUntil("GET / h").size(), 0u);
  }
  RawClient more(port());
  EXPECT_EQ(more.ReadAll(), "");
  EXPECT_TRUE(more.is_closed());
  clients[0]->Send("GET / HTTP/1.1\r\nHost: again\r\n\r\n");
  EXPECT_NE(clients[0]->ReadUntil("GET / again").find("again"), std::string::npos);
}

TEST_F(HttpServerTest, AFloodOfRequestsIsSlowedDown) {
  Start({.requests_per_second = 200.0});
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::thread> floods;
  for (int thread = 0; thread < 4; ++thread) {
    floods.emplace_back([&] {
      RawClient client(port());
      std::string many;
      for (int i = 0; i < 60; ++i) {
        many += "GET / HTTP/1.1\r\nHost: h\r\n\r\n";
      }
      client.Send(many);
      client.ReadAll(1s);
    });
  }
  for (std::thread& flood : floods) {
    flood.join();
  }
  const std::chrono::duration<double> used = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(requests_, 0);
  EXPECT_LE(requests_, 50 + 200.0 * used.count() + 4);
}

TEST_F(HttpServerTest, AStreamGetsTheMessages) {
  Start();
  const auto client = OpenStream();
  hub_.GiveWhole(Shared("{\"whole\":1}"));
  EXPECT_EQ(client->ReadUntil("\n\n"), "data: {\"whole\":1}\n\n");
  hub_.GiveFrame(Shared("{\"frame\":1}"));
  EXPECT_EQ(client->ReadUntil("\n\n"), "data: {\"frame\":1}\n\n");
  EXPECT_GT(server_->bytes_sent(), 20u);
}

TEST_F(HttpServerTest, AQuietStreamGetsSignsOfLife) {
  Start({.sign_of_life = 1s});
  const auto client = OpenStream();
  EXPECT_EQ(client->ReadUntil(":\n\n"), ":\n\n");
  hub_.GiveWhole(Shared("{}"));
  EXPECT_NE(client->ReadUntil("data: {}\n\n").find("data: {}"), std::string::npos);
}

TEST_F(HttpServerTest, StreamsAreLimitedAndEndWhenTheBrowserGoes) {
  Start({.streams = 2});
  auto first = OpenStream();
  auto second = OpenStream();
  EXPECT_EQ(Ask(port(), "GET /stream").find("HTTP/1.1 503"), 0u);
  first.reset();
  WaitForReaders(1);
  const auto third = OpenStream();
  third->Send("a browser does not talk on a stream");
  WaitForReaders(1);
}

TEST_F(HttpServerTest, AReaderThatTakesNothingIsDroppedWithoutSlowingOthers) {
  Start({.write = 3s, .send_buffer_bytes = 4096});
  const auto stuck = OpenStream(2048);
  const auto good = OpenStream();
  hub_.GiveWhole(Shared(std::string(1'000'000, 'x')));
  EXPECT_EQ(good->ReadUntil("\n\n").size(), 1'000'008u);
  WaitForReaders(1);
  hub_.GiveFrame(Shared("frame"));
  EXPECT_EQ(good->ReadUntil("\n\n"), "data: frame\n\n");
}

TEST_F(HttpServerTest, ATakenPortAndAForeignAddressAreInputErrors) {
  Start();
  const auto handle = [](const HttpRequest&) { return HttpReply(); };
  MessageHub other;
  ExpectInputError([&] { HttpServer("127.0.0.1", port(), {}, other, handle); },
                   {"cannot listen on 127.0.0.1:" + std::to_string(port()), "in use", "--view 0"});
  ExpectInputError([&] { HttpServer("no address", 0, {}, other, handle); },
                   {"no address", "expected an IP address"});
  ExpectInputError([&] { HttpServer("192.0.2.1", 0, {}, other, handle); },
                   {"cannot listen on 192.0.2.1"});
}

TEST_F(HttpServerTest, EndsWithOpenConnections) {
  Start();
  const auto stream = OpenStream();
  RawClient idle(port());
  server_.reset();
  EXPECT_EQ(stream->ReadAll(), "");
  EXPECT_TRUE(stream->is_closed());
}

TEST(JoinAddress, PutsBracketsAroundIpv6) {
  EXPECT_EQ(JoinAddress("127.0.0.1", 80), "127.0.0.1:80");
  EXPECT_EQ(JoinAddress("::1", 80), "[::1]:80");
}

}  // namespace
}  // namespace hullslam
