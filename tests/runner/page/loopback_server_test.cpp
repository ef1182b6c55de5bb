// Valid and invalid requests, sent whole and in pieces to the server of a campaign with two points, and the
// status of the answers. tests/pages/live_server_test.py has more of them.
#include "runner/page/loopback_server.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "contract/durable_file.h"
#include "contract/json.h"
#include "tests/runner/runner_fixture.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

using namespace std::string_view_literals;

// Sends a request in pieces of equal length, at least one byte, and returns the answer.
std::string exchange(int port, const std::string& request, std::size_t pieces) {
  const auto check = [](bool good, const char* doing) {
    if (!good) throw std::system_error(errno, std::generic_category(), doing);
  };
  const Descriptor connection(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  check(connect(connection.number(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0,
        "connect");
  const timeval patience{15, 0};
  setsockopt(connection.number(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  const std::size_t step = request.size() / pieces + 1;
  for (std::size_t at = 0; at < request.size(); at += step) {
    // The server may have answered and hung up already.
    if (send(connection.number(), request.data() + at, std::min(step, request.size() - at), MSG_NOSIGNAL) < 0)
      break;
  }
  shutdown(connection.number(), SHUT_WR);
  std::string answer;
  std::array<char, 65536> bytes{};
  for (;;) {
    const ssize_t count = recv(connection.number(), bytes.data(), bytes.size(), 0);
    check(count >= 0 || errno == ECONNRESET, "no answer in time");
    if (count <= 0) return answer;
    answer.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

class LoopbackServerTest : public testing::Test {
 protected:
  LoopbackServerTest() {
    for (int seed = 0; seed < 4; ++seed) campaign_.complete(0, seed, 10 + 0.01 * seed);
    campaign_.complete(1, 0, 12);
    live_.emplace(campaign_.directory().root(), "");
    const Json state = Json::parse(*live_->changes_since(""));
    token_ = state["live"]["token"];
    point_ = state["points"]["0"]["hash"];
    thread_ = std::thread([this] {
      server_.serve(stop_.number(), [this](const HttpRequest& request) { return answer(*live_, request); });
    });
  }
  ~LoopbackServerTest() override {
    EXPECT_EQ(eventfd_write(stop_.number(), 1), 0);
    thread_.join();
  }

  std::string ask(const std::string& request, std::size_t pieces = 1) const {
    return exchange(server_.port(), request, pieces);
  }

  StoredCampaign campaign_{2, 4, 8};
  std::optional<LiveCampaign> live_;
  std::string token_, point_;
  Descriptor stop_{eventfd(0, EFD_CLOEXEC)};
  LoopbackServer server_{0};
  std::thread thread_;
};

TEST_F(LoopbackServerTest, AnswersEachRequestWithItsStatus) {
  const std::string host = " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const std::vector<std::pair<std::string, int>> cases{
      {"GET / HTTP/1.1\r\nHost: localhost:7325\r\n\r\n", 200},
      {"HEAD / HTTP/1.0\r\nHost: 127.0.0.1\r\nConnection: keep-alive\r\n\r\n", 200},
      {"GET /state?since= HTTP/1.1\r\nhOST:\t [::1]:1 \r\nAccept: */*\r\n\r\n", 200},
      {"GET /state?since=" + token_ + host, 204},
      {"GET /state?since=18446744073709551616" + host, 200},
      {"GET /point?hash=" + point_ + host, 200},
      {"GET /point?hash=-1" + host, 404},
      {"GET /favicon.ico HTTP/1.1\r\nHost: localhost\r\nCookie: a=b; c=d\r\n\r\n", 204},
      {"GET /../../etc/passwd" + host, 404},
      {"GET /%2e%2e%2fpasswd" + host, 404},
      {"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello", 405},
      {"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\nhello", 405},
      {"POST /state HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n",
       405},
      {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", 403},
      {"GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost : localhost\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nX: \x01\r\nHost: localhost\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nContent-Length: -1\r\nHost: localhost\r\n\r\n", 400},
      // RFC 9112, 5.2: a line that continues the one before is refused or becomes part of it.
      {"GET / HTTP/1.1\r\nHost: localhost\r\n folded\r\n\r\n", 403},
      {"GET http://localhost/" + host, 400},
      {"OPTIONS *" + host, 400},
      {"GET x" + host, 400},
      {"GET  /" + host, 400},
      {std::string("GET /\0"sv) + host, 400},
      {"GET / HTTP/1.1\r\n\r\n", 400},
      {"GET /\r\n\r\n", 400},
      {"GET\r\n\r\n", 400},
      {"\r\n\r\n", 400},
      {"\x16\x03\x01\x02" + std::string("\0\x01\0\x01\xfc\x03\x03\r\n\r\n"sv), 400},
      {"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 505},
      {"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n", 505},
      {"GET / HTTP/1.1 \r\nHost: localhost\r\n\r\n", 505},
      {"G T /" + host, 505},  // of the version "/ HTTP/1.1"
      {"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(9000, 'x') + "\r\n\r\n", 431},
      {"GET /" + std::string(20000, '%') + host, 431},
  };
  for (const auto& [request, status] : cases) {
    for (const std::size_t pieces : {1U, 3U, 50U}) {
      const std::string answer = ask(request, pieces);
      EXPECT_TRUE(answer.starts_with("HTTP/1.1 " + std::to_string(status) + " "))
          << status << " in " << pieces << " pieces: " << request << "\nis answered by\n"
          << answer.substr(0, 100);
      EXPECT_TRUE(says(answer, "\r\nX-Content-Type-Options: nosniff\r\n") &&
                  says(answer, "\r\nContent-Security-Policy: default-src 'none'"))
          << request << "\nis answered by\n"
          << answer.substr(0, 1000);
      const std::size_t body = answer.find("\r\n\r\n") + 4;
      if (status != 200)
        EXPECT_LT(answer.size() - body, 50U) << request;
      else
        EXPECT_EQ(answer.size() > body, !request.starts_with("HEAD")) << request;
    }
  }
}

TEST_F(LoopbackServerTest, ClosesAConnectionThatEndsBeforeItsHead) {
  for (const std::string request : {"", "GET / HTTP/1.1\r\n", "GET / HTTP/1.1\r\nHost: localhost\r\n"})
    EXPECT_EQ(ask(request), "") << request;
}

TEST(LiveSite, OnlyNamesOfThisMachineAreItsOwn) {
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

}  // namespace
}  // namespace peclet::runner
