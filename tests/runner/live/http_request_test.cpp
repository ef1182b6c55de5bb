// Heads of requests, good and bad. What a server makes of them over a socket:
// tests/pages/live_server_test.py.
#include "runner/live/http_request.h"

#include <gtest/gtest.h>

#include "runner/live/http_answer.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

HttpRequest good(const std::string& head) {
  const std::variant<HttpRequest, int> read = read_head(head);
  EXPECT_TRUE(std::holds_alternative<HttpRequest>(read)) << head;
  return std::holds_alternative<HttpRequest>(read) ? std::get<HttpRequest>(read) : HttpRequest{};
}

TEST(HttpRequest, HasMethodPathQueryAndHost) {
  const HttpRequest request = good(
      "GET /state?since=a%2fb.1&x=&since=2&y HTTP/1.1\r\nAccept: */*\r\nhOST:\t localhost:7325 \r\n\r\n");
  EXPECT_EQ(request.method, "GET");
  EXPECT_EQ(request.path, "/state");
  const std::map<std::string, std::string> query{{"since", "a/b.1"}, {"x", ""}, {"y", ""}};
  EXPECT_EQ(request.query, query);
  EXPECT_EQ(request.host, "localhost:7325");
  EXPECT_EQ(good("HEAD /%41%c3%b6 HTTP/1.0\r\nHost: x\r\n\r\n").path, "/A\xc3\xb6");
}

TEST(HttpRequest, WhatIsNoneIsRefusedWithTheStatusThatSaysWhy) {
  const std::string host = "Host: localhost\r\n\r\n";
  for (const auto& [head, status] : std::map<std::string, int>{
           {"\r\n\r\n", 400},
           {"GET\r\n" + host, 400},
           {"GET /\r\n" + host, 400},
           {"G T / HTTP/1.1\r\n" + host, 400},
           {"GET x HTTP/1.1\r\n" + host, 400},
           {"GET  / HTTP/1.1\r\n" + host, 400},
           {"GET /%4 HTTP/1.1\r\n" + host, 400},
           {"GET /%g0 HTTP/1.1\r\n" + host, 400},
           {"GET /?a=%zz HTTP/1.1\r\n" + host, 400},
           {"GET / HTTP/1.1\r\n\r\n", 400},
           {"GET / HTTP/1.1\r\nHost : localhost\r\n\r\n", 400},
           {"GET / HTTP/1.1\r\nX: \x01\r\n" + host, 400},
           {"GET / HTTP/1.1\r\nHost: a\r\n" + host, 400},
           {"GET / HTTP/3\r\n" + host, 505},
           {"GET / HTTP/1.1 \r\n" + host, 505},
       }) {
    const std::variant<HttpRequest, int> read = read_head(head);
    ASSERT_TRUE(std::holds_alternative<int>(read)) << head;
    EXPECT_EQ(std::get<int>(read), status) << head;
  }
}

TEST(HttpRequest, AHeadEndsWithAnEmptyLine) {
  EXPECT_EQ(end_of_head("GET / HTTP/1.1\r\nHost: x\r\n"), std::string::npos);
  EXPECT_EQ(end_of_head("a\r\n\r\nbody\r\n\r\n"), 5U);
}

TEST(HttpRequest, OnlyNamesOfThisMachineAreItsOwn) {
  for (const char* const name :
       {"localhost", "LocalHost:80", "127.0.0.1", "127.0.0.1:7325", "[::1]", "[::1]:1"}) {
    EXPECT_TRUE(is_loopback_name(name)) << name;
  }
  for (const char* const name :
       {"", ":80", "localhost.", "localhost.example", "evil.example:7325", "127.0.0.1.nip.io",
        "localhost:80:80", "localhost:x", "::1", "[::1", "192.168.0.1", "0.0.0.0"}) {
    EXPECT_FALSE(is_loopback_name(name)) << name;
  }
}

TEST(HttpAnswer, AHeadSaysWhatFollowsAndAllowsNothing) {
  const std::string head = head_text(with_body("{}", "application/json"));
  EXPECT_TRUE(head.starts_with("HTTP/1.1 200 OK\r\n"));
  EXPECT_TRUE(head.ends_with("Content-Type: application/json\r\nContent-Length: 2\r\n\r\n"));
  EXPECT_TRUE(says(head, "Content-Security-Policy: default-src 'none'; frame-ancestors 'none'\r\n"));
  EXPECT_TRUE(says(head_text(refusal(405)), "Allow: GET, HEAD\r\n"));
}

}  // namespace
}  // namespace peclet::runner
