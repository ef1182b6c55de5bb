#include "tests/fuzz/http_fuzzing.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <random>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>

#include "contract/descriptor.h"
#include "contract/json.h"
#include "runner/live/live_site.h"
#include "runner/live/loopback_server.h"
#include "tests/fuzz/http_corpus.h"
#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

constexpr std::size_t most_findings = 10, most_kept = 2000, longest_request = 20000;
constexpr std::size_t longest_answered_head = 8192;
constexpr timeval patience{15, 0};

[[noreturn]] void fail(const char* doing) { throw std::system_error(errno, std::generic_category(), doing); }

// A server of a campaign with two points, one of them decided.
class ServedCampaign {
 public:
  ServedCampaign() : stop_(eventfd(0, EFD_CLOEXEC)) {
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
  ~ServedCampaign() {
    const std::uint64_t one = 1;
    if (write(stop_.number(), &one, sizeof(one)) != sizeof(one)) std::abort();
    thread_.join();
  }
  ServedCampaign(const ServedCampaign&) = delete;
  ServedCampaign& operator=(const ServedCampaign&) = delete;

  int port() const { return server_.port(); }
  // The words POINT and TOKEN replaced.
  std::string filled_in(std::string text) const {
    for (const auto& [word, value] : {std::pair{"POINT", &point_}, std::pair{"TOKEN", &token_}}) {
      for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += value->size())
        text.replace(at, 5, *value);
    }
    return text;
  }

 private:
  StoredCampaign campaign_{2, 4, 8};
  std::optional<LiveCampaign> live_;
  Descriptor stop_;
  LoopbackServer server_{0};
  std::string token_, point_;
  std::thread thread_;
};

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed), kept_(http_corpus.begin(), http_corpus.end()) {}

  std::string next() {
    std::string text = kept_[below(kept_.size())];
    for (std::size_t changes = below(9); changes > 0; --changes) change(text);
    text.resize(std::min(text.size(), longest_request));
    return text;
  }
  void keep(const std::string& text) {
    if (kept_.size() < most_kept) kept_.push_back(text);
  }
  // The same on every platform, other than std::uniform_int_distribution.
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

 private:
  void change(std::string& text) {
    const std::size_t at = below(text.size() + 1),
                      length = below(std::min<std::size_t>(text.size() - at, 64) + 1);
    switch (below(7)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.insert(at, http_pieces[below(http_pieces.size())]);
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(at, length));
        break;
      case 4: {
        const std::string& other = kept_[below(kept_.size())];
        text = text.substr(0, at) + other.substr(below(other.size() + 1));
        break;
      }
      case 5: {
        const std::string_view piece = http_pieces[below(http_pieces.size())];
        std::string many;
        for (std::size_t times = below(300); times > 0; --times) many += piece;
        text.insert(at, many);
        break;
      }
      default:
        text.insert(at, std::string(below(10000), static_cast<char>(random_())));
    }
  }

  std::mt19937_64 random_;
  std::vector<std::string> kept_;
};

// What is answered to the request, which is sent in so many pieces; nothing if no answer came in time.
std::optional<std::string> ask(int port, const std::string& request, std::size_t pieces) {
  const Descriptor connection(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (connection.number() < 0 ||
      connect(connection.number(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    fail("connect");
  setsockopt(connection.number(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  const std::size_t step = request.size() / pieces + 1;
  for (std::size_t at = 0; at < request.size(); at += step) {
    const std::size_t length = std::min(step, request.size() - at);
    // The server may have answered and hung up already.
    if (send(connection.number(), request.data() + at, length, MSG_NOSIGNAL) < 0) break;
  }
  shutdown(connection.number(), SHUT_WR);
  std::string answer;
  std::array<char, 65536> bytes{};
  for (;;) {
    const ssize_t count = recv(connection.number(), bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EAGAIN) return std::nullopt;
    if (count <= 0) return answer;
    answer.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  return text;
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

// The kind of an answer: its status and type; "" if there was none. `fault` says what is wrong with it.
std::string judge(const std::string& request, const std::string& answer, std::string& fault) {
  const std::size_t end = request.find("\r\n\r\n");
  const bool must_be_answered = end != std::string::npos || request.size() > longest_answered_head + 1;
  if (answer.empty()) {
    if (must_be_answered) fault = "no answer to a whole head";
    return "";
  }
  const std::size_t head_end = answer.find("\r\n\r\n");
  const std::string head = answer.substr(0, head_end),
                    body = head_end == std::string::npos ? "" : answer.substr(head_end + 4);
  static const std::set<std::string> statuses{"200 OK",
                                              "204 No Content",
                                              "400 Bad Request",
                                              "403 Forbidden",
                                              "404 Not Found",
                                              "405 Method Not Allowed",
                                              "431 Request Header Fields Too Large",
                                              "505 HTTP Version Not Supported"};
  const std::string status = head.substr(0, head.find("\r\n"));
  if (head_end == std::string::npos || !status.starts_with("HTTP/1.1 ") ||
      !statuses.contains(status.substr(9))) {
    fault = "its first line is " + status;
    return "";
  }
  if (has(head, "\n\n") || std::count(head.begin(), head.end(), '\n') > 11)
    fault = "its head has foreign lines";
  if (!has(head, "\r\nX-Content-Type-Options: nosniff") ||
      !has(head, "\r\nContent-Security-Policy: default-src 'none'"))
    fault = "its head lacks what it always has";
  const std::size_t at = head.find("\r\nContent-Length: ");
  const bool is_head = request.starts_with("HEAD ");
  const std::size_t length = at == std::string::npos ? 0 : std::strtoul(head.c_str() + at + 18, nullptr, 10);
  if (body.size() != length && !(is_head && body.empty()))
    fault = fmt::format("it has {} bytes and says {}", body.size(), length);
  const bool is_given = status.starts_with("HTTP/1.1 20");
  const std::string asked = lower(request);
  const bool is_of_here = has(asked, "localhost") || has(asked, "127.0.0.1") || has(asked, "[::1]");
  if (is_given && !(request.starts_with("GET /") || is_head)) fault = "something is given for another method";
  if (is_given && !is_of_here) fault = "something is given under another name";
  const std::size_t type = head.find("\r\nContent-Type: ");
  return status + (type == std::string::npos ? "" : head.substr(type, 24)) + (is_head ? " HEAD" : "");
}

}  // namespace

FuzzReport fuzz_live_server(std::uint64_t seed, const std::function<bool(const FuzzReport&)>& goes_on) {
  ServedCampaign served;
  Mutator mutator(seed);
  FuzzReport report;
  std::set<std::string> kinds, answers;
  while (report.findings.size() < most_findings && goes_on(report)) {
    const std::string made = mutator.next(), request = served.filled_in(made);
    const std::optional<std::string> answer = ask(served.port(), request, 1 + mutator.below(4));
    ++report.requests;
    std::string fault = answer ? "" : "no answer and no end in time";
    const std::string kind = answer ? judge(request, *answer, fault) : "";
    if (!kind.empty()) answers.insert(kind);
    // How long the request is and how many lines it has belong to its kind, too, roughly.
    const auto lines = std::count(request.begin(), request.end(), '\n');
    if (kinds.insert(fmt::format("{} {} {}", kind, std::min<std::ptrdiff_t>(lines, 8), request.size() / 4096))
            .second)
      mutator.keep(made);
    if (!fault.empty())
      report.findings.push_back(
          fmt::format("{}: {}", fault, Json(request).dump(-1, ' ', true, Json::error_handler_t::replace)));
  }
  report.answers = answers.size();
  return report;
}

}  // namespace peclet::runner
