#include "runner/live/http_request.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace peclet::runner {
namespace {

// RFC 9110, 5.6.2.
bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("!#$%&'*+-.^_`|~").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

// Nothing that a line of a head may not have.
bool is_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return (c >= 0x20 && c != 0x7f) || c == '\t'; });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string made(text);
  for (char& c : made) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return made;
}

// Takes the text up to `mark` off its front, and the mark; all of it where there is none.
std::string_view take_until(std::string_view& text, std::string_view mark) {
  const std::size_t at = text.find(mark);
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + mark.size());
  return part;
}

// %41 is A; nothing for what is no such code.
std::optional<std::string> decoded(std::string_view text) {
  std::string made;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      made += text[i];
      continue;
    }
    const auto digit = [&](std::size_t place) -> int {
      if (place >= text.size()) return -1;
      const auto at = std::string_view("0123456789abcdef").find(lower(text.substr(place, 1)));
      return at == std::string_view::npos ? -1 : static_cast<int>(at);
    };
    const int high = digit(i + 1), low = digit(i + 2);
    if (high < 0 || low < 0) return std::nullopt;
    made += static_cast<char>(16 * high + low);
    i += 2;
  }
  return made;
}

// "/point?hash=ab&x=1" into path and query; false for what is none.
bool read_target(std::string_view target, HttpRequest& request) {
  if (!target.starts_with('/')) return false;
  const std::optional<std::string> path = decoded(take_until(target, "?"));
  if (!path) return false;
  request.path = *path;
  while (!target.empty()) {
    std::string_view value = take_until(target, "&");
    const std::optional<std::string> name = decoded(take_until(value, "=")), text = decoded(value);
    if (!name || !text) return false;
    request.query.emplace(*name, *text);
  }
  return true;
}

}  // namespace

std::size_t end_of_head(std::string_view text) {
  const std::size_t at = text.find("\r\n\r\n");
  return at == std::string_view::npos ? at : at + 4;
}

std::variant<HttpRequest, int> read_head(std::string_view head) {
  constexpr int bad_request = 400, other_version = 505;
  HttpRequest request;
  std::string_view first = take_until(head, "\r\n");
  if (!is_text(first)) return bad_request;
  const std::string_view method = take_until(first, " "), target = take_until(first, " ");
  if (!is_token(method) || !first.starts_with("HTTP/")) return bad_request;
  if (first != "HTTP/1.1" && first != "HTTP/1.0") return other_version;
  request.method = method;
  if (!read_target(target, request)) return bad_request;
  int hosts = 0;
  for (;;) {
    std::string_view line = take_until(head, "\r\n");
    if (line.empty()) break;
    if (!is_text(line) || line.find(':') == std::string_view::npos) return bad_request;
    const std::string_view name = take_until(line, ":");
    if (!is_token(name)) return bad_request;  // also a line that goes on with the one before
    if (lower(name) != "host") continue;
    request.host = trimmed(line);
    ++hosts;
  }
  if (hosts != 1) return bad_request;
  return request;
}

bool is_loopback_name(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos) {
    const std::string_view port = host.substr(colon + 1);
    if (!std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
      return false;
    host = host.substr(0, colon);
  }
  const std::string name = lower(host);
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

}  // namespace peclet::runner
