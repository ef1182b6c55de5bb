// A small HTTP server that only this machine can reach: one thread, one request a connection.
#pragma once

#include <functional>

#include "runner/live/http_answer.h"
#include "runner/live/http_request.h"

namespace peclet::runner {

class LoopbackServer {
 public:
  // Listens on 127.0.0.1; port 0 is any that is free. Throws std::system_error, and std::runtime_error with a
  // cure for a port that is in use.
  explicit LoopbackServer(int port);
  ~LoopbackServer();
  LoopbackServer(const LoopbackServer&) = delete;
  LoopbackServer& operator=(const LoopbackServer&) = delete;

  int port() const { return port_; }

  using Handler = std::function<HttpAnswer(const HttpRequest&)>;
  // Answers until `stop` can be read from. Of a request with HEAD the body is not sent. A connection that
  // does not get on for some seconds is closed; what the handler throws is the server's end.
  void serve(int stop, const Handler& handler);

 private:
  int listener_ = -1, port_ = 0;
};

}  // namespace peclet::runner
