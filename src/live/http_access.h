// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

namespace hullslam {

// A request, as far as the pages of this program need it. Header fields that are missing are empty.
struct HttpRequest {
  std::string method;      // "GET"
  std::string path;        // "/stream": the target without its query
  std::string token;       // of the header X-Hullslam-Token, else of the query
  std::string host;        // header Host: name and port, as the browser knows this server
  std::string origin;      // header Origin: the page that sends the request
  std::string fetch_site;  // header Sec-Fetch-Site: the relation of that page to this server
};

// Splits a request target such as "/stream?token=0a1b" into path and token.
void SplitTarget(std::string_view target, HttpRequest& request);

// The answer to whether a request may be served.
enum class HttpAccess { kAllowed, kForeignHost, kForeignOrigin, kWrongToken };

// The rules by which other web sites in the same browser, and other people in the network, are kept
// away from a run.
struct HttpAccessRules {
  // Whether only this computer can reach the server. Watching then needs no token.
  bool is_loopback = true;
  std::string token;      // must not be empty
  std::string host_name;  // the name of this computer in the network; may be empty
};

// Judges a request. `is_control` says that it changes the run, which always needs the token.
//   host    A foreign web site can give its own name the address 127.0.0.1 (DNS rebinding), and the
//           browser then takes this server for a part of that site. So names in Host other than
//           localhost and this computer's name are refused, and on the loopback all addresses but
//           the loopback's own. The port may be any, because it can be forwarded.
//   origin  If the browser names the page that sends the request, this must be a page of this
//           server.
HttpAccess JudgeRequest(const HttpAccessRules& rules, const HttpRequest& request, bool is_control);

// A sentence for the reply to a request that is refused.
std::string_view Explain(HttpAccess access);

// 128 random bits in hexadecimal digits.
std::string MakeToken();

// Whether an IP address in text form is one of the loopback: 127.0.0.0/8 or ::1.
bool IsLoopback(std::string_view address);

// Spreads events out in time: at most `burst` of them at once, and `per_second` in the long run.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  RateLimit(double per_second, double burst)
      : interval_(1.0 / per_second), burst_(burst * interval_) {}

  // Counts one event that is to happen at `now`, which must not decrease from call to call. Returns
  // how long the event has to wait.
  Clock::duration Take(Clock::time_point now) {
    const Seconds since_start = now - start_;
    next_ = std::max(next_, since_start - burst_) + interval_;
    const Seconds wait = std::max(Seconds(0.0), next_ - since_start);
    return std::chrono::duration_cast<Clock::duration>(wait);
  }

 private:
  using Seconds = std::chrono::duration<double>;

  Seconds interval_;
  Seconds burst_;
  Clock::time_point start_ = Clock::now();
  Seconds next_ = -burst_;  // when the events so far are over, at their mean rate
};

}  // namespace hullslam
