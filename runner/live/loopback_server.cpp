#include "runner/live/loopback_server.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <list>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "contract/descriptor.h"

namespace peclet::runner {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds patience{10};  // for the next bytes, either way
constexpr std::size_t most_connections = 64;

[[noreturn]] void fail(const char* doing) { throw std::system_error(errno, std::generic_category(), doing); }

bool is_only_delayed() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

// A connection reads one request, writes one answer, and waits for the other side to hang up: whoever closes
// with bytes unread takes back what was sent.
class Exchange {
 public:
  explicit Exchange(int socket) : socket_(socket) {}

  int socket() const { return socket_.number(); }
  short awaits() const { return state_ == State::writing ? POLLOUT : POLLIN; }
  bool is_over(Clock::time_point now) const { return state_ == State::over || now > deadline_; }
  Clock::time_point deadline() const { return deadline_; }

  // To be called when the socket is ready.
  void go_on(const LoopbackServer::Handler& handler) {
    if (state_ == State::writing) {
      write();
    } else {
      read(handler);
    }
  }

 private:
  enum class State { reading, writing, draining, over };

  void read(const LoopbackServer::Handler& handler) {
    std::array<char, 4096> bytes{};
    const ssize_t got = recv(socket(), bytes.data(), bytes.size(), 0);
    if (got < 0 && is_only_delayed()) return;
    if (got <= 0) {
      state_ = State::over;
      return;
    }
    if (state_ == State::draining) return;  // whatever a body says; the deadline stays
    head_.append(bytes.data(), static_cast<std::size_t>(got));
    const std::size_t end = end_of_head(head_);
    if (end == std::string::npos && head_.size() <= longest_head) return;
    const bool whole = end <= longest_head;  // npos is not
    answer(whole ? answer_to(head_.substr(0, end), handler) : refusal(431));
  }

  HttpAnswer answer_to(const std::string& head, const LoopbackServer::Handler& handler) {
    const std::variant<HttpRequest, int> request = read_head(head);
    if (const int* const status = std::get_if<int>(&request)) return refusal(*status);
    without_body_ = std::get<HttpRequest>(request).method == "HEAD";
    return handler(std::get<HttpRequest>(request));
  }

  void answer(const HttpAnswer& answer) {
    head_ = head_text(answer);
    if (!without_body_) body_ = answer.body;
    state_ = State::writing;
    deadline_ = Clock::now() + patience;
    write();
  }

  void write() {
    const std::size_t whole = head_.size() + (body_ ? body_->size() : 0);
    while (sent_ < whole) {
      const bool in_head = sent_ < head_.size();
      const std::string& part = in_head ? head_ : *body_;
      const std::size_t from = in_head ? sent_ : sent_ - head_.size();
      const ssize_t took = send(socket(), part.data() + from, part.size() - from, MSG_NOSIGNAL);
      if (took < 0 && is_only_delayed()) return;
      if (took <= 0) {
        state_ = State::over;
        return;
      }
      sent_ += static_cast<std::size_t>(took);
      deadline_ = Clock::now() + patience;
    }
    shutdown(socket(), SHUT_WR);
    state_ = State::draining;
    deadline_ = Clock::now() + std::chrono::seconds(1);
  }

  Descriptor socket_;
  State state_ = State::reading;
  Clock::time_point deadline_ =
      Clock::now() + patience;  // of a whole head, so that bytes one by one gain nothing
  std::string head_;            // of the request, then of the answer
  std::shared_ptr<const std::string> body_;
  std::size_t sent_ = 0;
  bool without_body_ = false;
};

std::list<Exchange>::const_iterator soonest_to_end(const std::list<Exchange>& exchanges) {
  return std::min_element(exchanges.begin(), exchanges.end(),
                          [](const Exchange& a, const Exchange& b) { return a.deadline() < b.deadline(); });
}

// Until the next deadline; without connections as long as it takes.
int wait_milliseconds(const std::list<Exchange>& exchanges) {
  if (exchanges.empty()) return -1;
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(soonest_to_end(exchanges)->deadline() - Clock::now());
  return static_cast<int>(std::max<std::chrono::milliseconds::rep>(left.count() + 1, 0));
}

}  // namespace

LoopbackServer::LoopbackServer(int port) {
  Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (listener.number() < 0) fail("socket");
  const int yes = 1;
  if (setsockopt(listener.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) != 0) fail("setsockopt");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof(address);
  auto* const general = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener.number(), general, size) != 0 || listen(listener.number(), SOMAXCONN) != 0) {
    if (errno != EADDRINUSE && errno != EACCES) fail("bind");
    throw std::runtime_error(fmt::format("port {} {}; `--port 0` takes one that is free", port,
                                         errno == EACCES ? "may not be used by you" : "is in use"));
  }
  if (getsockname(listener.number(), general, &size) != 0) fail("getsockname");
  port_ = ntohs(address.sin_port);
  listener_ = listener.take();
}

LoopbackServer::~LoopbackServer() { close(listener_); }

void LoopbackServer::serve(int stop, const Handler& handler) {
  std::list<Exchange> exchanges;
  std::vector<pollfd> watched;
  for (;;) {
    watched = {{stop, POLLIN, 0}, {listener_, POLLIN, 0}};
    for (const Exchange& one : exchanges) watched.push_back({one.socket(), one.awaits(), 0});
    if (poll(watched.data(), watched.size(), wait_milliseconds(exchanges)) < 0 && errno != EINTR)
      fail("poll");
    if (watched[0].revents != 0) return;
    std::size_t place = 2;
    for (Exchange& one : exchanges) {
      if (watched[place++].revents != 0) one.go_on(handler);
    }
    const Clock::time_point now = Clock::now();
    exchanges.remove_if([&](const Exchange& one) { return one.is_over(now); });
    if (watched[1].revents == 0) continue;
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) continue;
    // Slow connections make no other wait: the one that has got on least makes room.
    if (exchanges.size() >= most_connections) exchanges.erase(soonest_to_end(exchanges));
    exchanges.emplace_back(socket);
  }
}

}  // namespace peclet::runner
