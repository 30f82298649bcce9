// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/http_access.h"

#include <gtest/gtest.h>

#include <set>

namespace hullslam {
namespace {

const HttpAccessRules kLocal = {.is_loopback = true, .token = "0123abcd", .host_name = "desk"};
const HttpAccessRules kNetwork = {.is_loopback = false, .token = "0123abcd", .host_name = "Desk"};

HttpRequest RequestTo(const std::string& host, const std::string& origin = {},
                      const std::string& token = {}) {
  HttpRequest request;
  request.method = "GET";
  request.path = "/stream";
  request.host = host;
  request.origin = origin;
  request.token = token;
  return request;
}

TEST(HttpAccess, TheTargetIsSplit) {
  HttpRequest request;
  SplitTarget("/stream?a=1&token=0a1b&token2=no", request);
  EXPECT_EQ(request.path, "/stream");
  EXPECT_EQ(request.token, "0a1b");
  HttpRequest plain;
  SplitTarget("/", plain);
  EXPECT_EQ(plain.path, "/");
  EXPECT_EQ(plain.token, "");
}

TEST(HttpAccess, OnTheLoopbackOnlyItsOwnNamesAreServed) {
  for (const char* host :
       {"127.0.0.1:8320", "localhost", "LOCALHOST:9000", "[::1]:8320", "127.3.2.1"}) {
    EXPECT_EQ(JudgeRequest(kLocal, RequestTo(host), false), HttpAccess::kAllowed) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:8320", "192.168.1.7:8320",
                           "localhost.evil.example", "127.0.0.1.evil.example", "desk:8320", "[::1",
                           "[fe80::1]:8320", "[::1].evil.example", "[::1]evil.example:8320",
                           "localhost:evil.example", "127.0.0.1:", "[::1]:8320.evil.example"}) {
    EXPECT_EQ(JudgeRequest(kLocal, RequestTo(host), false), HttpAccess::kForeignHost) << host;
  }
}

TEST(HttpAccess, InTheNetworkAddressesAndTheOwnNameAreServedWithTheToken) {
  for (const char* host :
       {"192.168.1.7:8320", "[fe80::1]:8320", "desk:8320", "DESK.local", "localhost:8320"}) {
    EXPECT_EQ(JudgeRequest(kNetwork, RequestTo(host, {}, "0123abcd"), false), HttpAccess::kAllowed)
        << host;
    EXPECT_EQ(JudgeRequest(kNetwork, RequestTo(host), false), HttpAccess::kWrongToken) << host;
  }
  EXPECT_EQ(JudgeRequest(kNetwork, RequestTo("evil.example", {}, "0123abcd"), false),
            HttpAccess::kForeignHost);
}

TEST(HttpAccess, PagesOfOtherSitesAreRefused) {
  const std::string host = "127.0.0.1:8320";
  EXPECT_EQ(JudgeRequest(kLocal, RequestTo(host, "http://127.0.0.1:8320"), false),
            HttpAccess::kAllowed);
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8320",
                             "http://127.0.0.1:9999", "http://localhost:8320"}) {
    EXPECT_EQ(JudgeRequest(kLocal, RequestTo(host, origin), false), HttpAccess::kForeignOrigin)
        << origin;
  }
  HttpRequest image = RequestTo(host);
  image.fetch_site = "cross-site";
  EXPECT_EQ(JudgeRequest(kLocal, image, false), HttpAccess::kForeignOrigin);
  image.path = "/";  // a link to the page itself may be anywhere
  EXPECT_EQ(JudgeRequest(kLocal, image, false), HttpAccess::kAllowed);
}

TEST(HttpAccess, AControlNeedsTheWholeToken) {
  for (const char* token : {"", "0123abc", "0123abcde", "0123abcD"}) {
    EXPECT_EQ(JudgeRequest(kLocal, RequestTo("localhost", {}, token), true),
              HttpAccess::kWrongToken)
        << token;
  }
  EXPECT_EQ(JudgeRequest(kLocal, RequestTo("localhost", {}, "0123abcd"), true),
            HttpAccess::kAllowed);
  HttpAccessRules without = kLocal;
  without.token.clear();
  EXPECT_EQ(JudgeRequest(without, RequestTo("localhost"), true), HttpAccess::kWrongToken);
}

TEST(HttpAccess, TokensAreLongAndDiffer) {
  std::set<std::string> tokens;
  for (int i = 0; i < 50; ++i) {
    tokens.insert(MakeToken());
    EXPECT_EQ(tokens.begin()->size(), 32u);
  }
  EXPECT_EQ(tokens.size(), 50u);
}

TEST(HttpAccess, KnowsTheLoopback) {
  EXPECT_TRUE(IsLoopback("127.0.0.1"));
  EXPECT_TRUE(IsLoopback("127.9.9.9"));
  EXPECT_TRUE(IsLoopback("::1"));
  EXPECT_FALSE(IsLoopback("0.0.0.0"));
  EXPECT_FALSE(IsLoopback("10.0.0.1"));
  EXPECT_FALSE(IsLoopback("localhost"));
  EXPECT_FALSE(IsLoopback(""));
}

using namespace std::chrono_literals;

TEST(RateLimit, LetsABurstPassAndThenSpreadsEventsOut) {
  RateLimit limit(10.0, 3.0);
  const auto now = RateLimit::Clock::now() + 1h;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(limit.Take(now), 0ns) << i;
  }
  EXPECT_NEAR(std::chrono::duration<double>(limit.Take(now)).count(), 0.1, 1e-6);
  EXPECT_NEAR(std::chrono::duration<double>(limit.Take(now)).count(), 0.2, 1e-6);
}

TEST(RateLimit, RestAllowsNoMoreThanTheBurst) {
  RateLimit limit(10.0, 3.0);
  const auto now = RateLimit::Clock::now() + 1h;
  limit.Take(now);
  const auto later = now + 1h;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(limit.Take(later), 0ns) << i;
  }
  EXPECT_GT(limit.Take(later), 0ns);
}

}  // namespace

}  // namespace hullslam
