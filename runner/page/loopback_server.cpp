// The only file that includes Boost.Asio and Boost.Beast, which take seconds to compile.
#include "runner/page/loopback_server.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <exception>
#include <limits>
#include <list>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "runner/page/page_html.h"

namespace peclet::runner {
namespace {

HttpAnswer nothing_new() { return {.status = 204}; }

HttpAnswer page(LiveCampaign& campaign) {
  campaign.refresh();
  return {.type = "text/html; charset=utf-8",
          .body = campaign.page(),
          .policy = page_policy(true) + "; frame-ancestors 'none'"};
}

HttpAnswer json_or(std::shared_ptr<const std::string> text, HttpAnswer otherwise) {
  return text ? HttpAnswer{.type = "application/json", .body = std::move(text)} : std::move(otherwise);
}

}  // namespace

HttpAnswer answer(LiveCampaign& campaign, const HttpRequest& request) {
  if (!is_loopback_name(request.host)) return refusal(403);
  if (request.method != "GET" && request.method != "HEAD") return refusal(405);
  const std::size_t mark = std::min(request.target.find('?'), request.target.size());
  const std::string path = request.target.substr(0, mark);
  // The page sends one parameter. Tokens and hashes have no characters that are percent-encoded.
  const auto value_of = [&](const std::string& start) {
    return request.target.compare(mark, start.size(), start) == 0 ? request.target.substr(mark + start.size())
                                                                  : "";
  };
  try {
    if (path == "/") return page(campaign);
    if (path == "/state") {
      campaign.refresh();
      return json_or(campaign.changes_since(value_of("?since=")), nothing_new());
    }
    if (path == "/point") return json_or(campaign.details(value_of("?hash=")), refusal(404));
  } catch (const std::exception&) {
    return refusal(500);
  }
  // Browsers ask for an icon, and report an error if there is none.
  return path == "/favicon.ico" ? nothing_new() : refusal(404);
}

bool is_loopback_name(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos) {
    const std::string_view port = host.substr(colon + 1);
    if (!std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
      return false;
    host = host.substr(0, colon);
  }
  std::string name(host);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using beast::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds patience{10};  // for a whole head, and for each part of the answer
constexpr std::size_t most_connections = 64;
constexpr std::size_t longest_head = 8192;

// Returns the status that refuses what was read; nothing if the other side is gone or too slow.
std::optional<int> refused_by(const error_code& error) {
  if (error == http::error::end_of_stream || error == http::error::partial_message) return std::nullopt;
  if (error == http::error::header_limit || error == http::error::buffer_overflow) return 431;
  if (error == http::error::bad_version) return 505;
  if (error.category() == make_error_code(http::error::bad_method).category()) return 400;
  return std::nullopt;
}

}  // namespace

// An HTTP connection. Reads the head of one request, writes one answer and waits for the other side to hang
// up, because closing a socket with unread bytes takes back what was sent.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, const LoopbackServer::Handler& handler)
      : stream_(std::move(socket)), handler_(handler) {
    parser_.header_limit(longest_head);
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // the body is never read
  }

  Clock::time_point deadline() const { return deadline_; }
  void close() { stream_.close(); }

  void start() {
    expire_after(patience);  // for the whole head, so that single bytes gain no time
    http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, auto) {
      if (!error) {
        self->answer(self->answer_to(self->parser_.get()));
      } else if (const std::optional<int> status = refused_by(error)) {
        self->answer(refusal(*status));
      }
    });
  }

 private:
  using Body = http::span_body<const char>;

  HttpAnswer answer_to(const http::request<http::empty_body>& request) const {
    if (request.count(http::field::host) != 1 || !request.target().starts_with('/')) return refusal(400);
    return handler_({request.method_string().to_string(), request.target().to_string(),
                     request[http::field::host].to_string()});
  }

  // Sends the answer, with headers that forbid caches, frames, guessed types and referrers.
  void answer(const HttpAnswer& answer) {
    response_.result(static_cast<unsigned>(answer.status));
    response_.keep_alive(false);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy", answer.policy);
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    if (answer.status == 405) response_.set(http::field::allow, "GET, HEAD");
    body_ = answer.body;
    if (body_) {
      response_.set(http::field::content_type, answer.type);
      response_.content_length(body_->size());
      response_.body() = {body_->data(), body_->size()};
    }
    serializer_.split(is_head());
    write();
  }

  bool is_head() const { return parser_.get().method() == http::verb::head; }

  void write() {
    expire_after(patience);
    http::async_write_some(stream_, serializer_, [self = shared_from_this()](error_code error, auto) {
      if (error) return;
      const bool is_over = self->is_head() ? self->serializer_.is_header_done() : self->serializer_.is_done();
      if (!is_over) return self->write();
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
      self->expire_after(std::chrono::seconds(1));
      self->drain();
    });
  }

  void drain() {
    stream_.async_read_some(asio::buffer(drained_), [self = shared_from_this()](error_code error, auto) {
      if (!error) self->drain();
    });
  }

  void expire_after(Clock::duration time) {
    deadline_ = Clock::now() + time;
    stream_.expires_after(time);
  }

  beast::tcp_stream stream_;
  const LoopbackServer::Handler& handler_;
  Clock::time_point deadline_;
  beast::flat_static_buffer<longest_head> buffer_;
  http::request_parser<http::empty_body> parser_;
  std::shared_ptr<const std::string> body_;
  http::response<Body> response_;
  http::response_serializer<Body> serializer_{response_};
  std::array<char, 4096> drained_{};
};

HttpAnswer refusal(int status) {
  const auto reason = http::obsolete_reason(http::int_to_status(static_cast<unsigned>(status)));
  return {.status = status,
          .body = std::make_shared<const std::string>(fmt::format("{} {}\n", status, reason.to_string()))};
}

class LoopbackServer::Listener {
 public:
  explicit Listener(int port) {
    const tcp::endpoint here(asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port));
    acceptor_.open(here.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    error_code error;
    acceptor_.bind(here, error);
    if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
    const bool is_denied = error == asio::error::access_denied;
    if (is_denied || error == asio::error::address_in_use) {
      throw std::runtime_error(fmt::format("port {} {}; `--port 0` takes one that is free", port,
                                           is_denied ? "may not be used by you" : "is in use"));
    }
    if (error) throw std::system_error(error, "bind");
  }

  int port() const { return acceptor_.local_endpoint().port(); }

  void serve(int stop, const Handler& handler) {
    const int duplicate = fcntl(stop, F_DUPFD_CLOEXEC, 0);
    if (duplicate < 0) throw std::system_error(errno, std::generic_category(), "fcntl");
    asio::posix::stream_descriptor stopping(context_, duplicate);
    stopping.async_wait(asio::posix::stream_descriptor::wait_read, [this](error_code) { context_.stop(); });
    accept(handler);
    context_.run();
  }

 private:
  void accept(const Handler& handler) {
    acceptor_.async_accept([this, &handler](error_code error, tcp::socket socket) {
      if (!error) admit(std::make_shared<HttpConnection>(std::move(socket), handler));
      accept(handler);
    });
  }

  // Starts the connection. If there are too many, closes the one whose time ends first.
  void admit(const std::shared_ptr<HttpConnection>& connection) {
    connections_.remove_if([](const auto& one) { return one.expired(); });
    if (connections_.size() >= most_connections) {
      const auto soonest = std::min_element(
          connections_.begin(), connections_.end(),
          [](const auto& a, const auto& b) { return a.lock()->deadline() < b.lock()->deadline(); });
      soonest->lock()->close();
      connections_.erase(soonest);
    }
    connections_.push_back(connection);
    connection->start();
  }

  asio::io_context context_{1};  // for one thread
  tcp::acceptor acceptor_{context_};
  std::list<std::weak_ptr<HttpConnection>> connections_;
};

LoopbackServer::LoopbackServer(int port) : listener_(std::make_unique<Listener>(port)) {}

LoopbackServer::~LoopbackServer() = default;

int LoopbackServer::port() const { return listener_->port(); }

void LoopbackServer::serve(int stop, const Handler& handler) { listener_->serve(stop, handler); }

}  // namespace peclet::runner
