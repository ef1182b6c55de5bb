// An HTTP server that only this machine can reach: one thread, one request per connection.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "runner/page/live_campaign.h"

namespace peclet::runner {

struct HttpRequest {
  std::string method;  // "GET"
  std::string target;  // path and query as sent: "/state?since=2"
  std::string host;    // the browser's name for this server, with its port
};

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = nullptr;  // shared by all connections that get it; null if none
  // The Content-Security-Policy, which by default allows nothing.
  std::string policy = "default-src 'none'; frame-ancestors 'none'";
};

// Returns an answer whose body is one line: the status and its reason.
HttpAnswer refusal(int status);

class LoopbackServer {
 public:
  // Listens on 127.0.0.1; port 0 takes any free one. Throws std::system_error, and std::runtime_error with a
  // cure if the port is in use or not allowed.
  explicit LoopbackServer(int port);
  ~LoopbackServer();
  LoopbackServer(const LoopbackServer&) = delete;
  LoopbackServer& operator=(const LoopbackServer&) = delete;

  int port() const;

  using Handler = std::function<HttpAnswer(const HttpRequest&)>;
  // Answers until `stop` is readable. A request by HEAD gets no body. A malformed request is refused by
  // status 400, 431 (head of more than 8192 bytes) or 505. A connection without progress for 10 s is closed;
  // so is the slowest of 64 connections when another one comes. An exception of the handler ends the server.
  void serve(int stop, const Handler& handler);

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

// Answers a request for the live page:
// clang-format off
//   /                   the page
//   /state?since=TOKEN  the changes; status 204 if there are none
//   /point?hash=HASH    the details of a point
// clang-format on
// The status is 404 for any other address, 405 for methods other than GET and HEAD, 403 if the request calls
// this machine by a name from elsewhere, and 500 if the database cannot be read, which the page shows.
HttpAnswer answer(LiveCampaign& campaign, const HttpRequest& request);

// True if `host` is 127.0.0.1, localhost or [::1], with any port, because ssh may forward it. A page from
// elsewhere whose name was made to lead here (DNS rebinding) has another host.
bool is_loopback_name(std::string_view host);

}  // namespace peclet::runner
