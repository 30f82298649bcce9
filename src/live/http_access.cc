// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/http_access.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

#include "util/text.h"

namespace hullslam {
namespace {

constexpr std::string_view kScheme = "http://";

// The name or address in a Host header, without the port and without the brackets of IPv6. Empty if
// anything else than a port follows it.
std::string NameOfHost(std::string_view host) {
  const bool has_brackets = host.starts_with('[');
  const size_t end = has_brackets ? host.find(']') : std::min(host.find(':'), host.size());
  if (end == std::string_view::npos) {
    return {};
  }
  const std::string_view port = host.substr(has_brackets ? end + 1 : end);
  const bool is_port = port.empty() || (port.size() > 1 && port[0] == ':' &&
                                        port.find_first_not_of("0123456789", 1) == port.npos);
  return is_port ? LowerCase(host.substr(has_brackets ? 1 : 0, end - (has_brackets ? 1 : 0)))
                 : std::string();
}

bool IsAddress(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

bool IsOwnHost(const HttpAccessRules& rules, std::string_view host) {
  const std::string name = NameOfHost(host);
  if (name == "localhost" || IsLoopback(name)) {
    return true;
  }
  const std::string own = LowerCase(rules.host_name);
  return !rules.is_loopback &&
         (IsAddress(name) || (!own.empty() && (name == own || name == own + ".local")));
}

// Takes the same time wherever the texts differ, so that a token cannot be found piece by piece.
bool AreEqual(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) {
    return false;
  }
  unsigned difference = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

bool IsOwnPage(const HttpRequest& request) {
  if (!request.origin.empty() &&
      LowerCase(request.origin) != std::string(kScheme) + LowerCase(request.host)) {
    return false;
  }
  return request.path == "/" || request.fetch_site.empty() || request.fetch_site == "same-origin" ||
         request.fetch_site == "none";
}

}  // namespace

void SplitTarget(std::string_view target, HttpRequest& request) {
  constexpr std::string_view kToken = "token=";
  const size_t mark = target.find('?');
  request.path = target.substr(0, mark);
  std::string_view query =
      mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  while (!query.empty()) {
    const size_t end = query.find('&');
    const std::string_view part = query.substr(0, end);
    if (part.starts_with(kToken)) {
      request.token = part.substr(kToken.size());
    }
    query = end == std::string_view::npos ? std::string_view() : query.substr(end + 1);
  }
}

HttpAccess JudgeRequest(const HttpAccessRules& rules, const HttpRequest& request, bool is_control) {
  if (!IsOwnHost(rules, request.host)) {
    return HttpAccess::kForeignHost;
  }
  if (!IsOwnPage(request)) {
    return HttpAccess::kForeignOrigin;
  }
  const bool needs_token = is_control || !rules.is_loopback;
  return needs_token && (rules.token.empty() || !AreEqual(request.token, rules.token))
             ? HttpAccess::kWrongToken
             : HttpAccess::kAllowed;
}

std::string_view Explain(HttpAccess access) {
  switch (access) {
    case HttpAccess::kForeignHost:
      return "The header Host names another computer. Open the address that the program has "
             "printed.";
    case HttpAccess::kForeignOrigin:
      return "The request comes from a page of another web site.";
    case HttpAccess::kWrongToken:
      return "The token is missing or wrong. Open the whole address that the program has printed.";
    default:
      return "The request is allowed.";
  }
}

std::string MakeToken() {
  std::random_device random;
  std::string token;
  for (int word = 0; word < 4; ++word) {
    token += fmt::format("{:08x}", random());
  }
  return token;
}

bool IsLoopback(std::string_view address) {
  const std::string text(address);
  in_addr v4{};
  if (inet_pton(AF_INET, text.c_str(), &v4) == 1) {
    return ntohl(v4.s_addr) >> 24 == 127;
  }
  in6_addr v6{};
  return inet_pton(AF_INET6, text.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6) != 0;
}

}  // namespace hullslam
