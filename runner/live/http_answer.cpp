#include "runner/live/http_answer.h"

#include <fmt/format.h>

#include <utility>

namespace peclet::runner {
namespace {

// RFC 9110, 15.
const char* reason(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 431:
      return "Request Header Fields Too Large";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Internal Server Error";
  }
}

}  // namespace

HttpAnswer with_body(std::string body, std::string type) {
  HttpAnswer answer;
  answer.type = std::move(type);
  answer.body = std::make_shared<const std::string>(std::move(body));
  return answer;
}

HttpAnswer refusal(int status) {
  HttpAnswer answer = with_body(fmt::format("{} {}\n", status, reason(status)), "text/plain; charset=utf-8");
  answer.status = status;
  return answer;
}

std::string head_text(const HttpAnswer& answer) {
  std::string head = fmt::format(
      "HTTP/1.1 {} {}\r\n"
      "Connection: close\r\n"
      "Cache-Control: no-store\r\n"
      "Content-Security-Policy: {}\r\n"
      "Cross-Origin-Opener-Policy: same-origin\r\n"
      "Cross-Origin-Resource-Policy: same-origin\r\n"
      "Referrer-Policy: no-referrer\r\n"
      "X-Content-Type-Options: nosniff\r\n"
      "X-Frame-Options: DENY\r\n",
      answer.status, reason(answer.status), answer.policy);
  if (answer.status == 405) head += "Allow: GET, HEAD\r\n";
  if (answer.body)
    head += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n", answer.type, answer.body->size());
  return head + "\r\n";
}

}  // namespace peclet::runner
