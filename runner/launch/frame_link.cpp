#include "runner/launch/frame_link.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

namespace peclet::runner {
namespace {

constexpr std::string_view first_letters = "PCF1";

void never_wait(const Descriptor& descriptor) {
  const int flags = fcntl(descriptor.number(), F_GETFL);
  if (flags < 0 || fcntl(descriptor.number(), F_SETFL, flags | O_NONBLOCK) != 0)
    throw std::system_error(errno, std::generic_category(), "fcntl");
}

// Throws FrameError.
std::size_t size_of_piece(const Json& piece) {
  const auto size = piece.find("bytes");
  if (size == piece.end() || !size->is_number_unsigned() || *size > largest_piece)
    throw FrameError(fmt::format("a piece of a file must have at most {} bytes", largest_piece));
  return size->get<std::size_t>();
}

}  // namespace

Descriptor duplicate(int descriptor) {
  const int number = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
  if (number < 0) throw std::system_error(errno, std::generic_category(), "dup");
  return Descriptor(number);
}

FrameLink::FrameLink(Descriptor input, Descriptor output, std::size_t largest, std::size_t noise)
    : input_(std::move(input)),
      output_(std::move(output)),
      decoder_(largest),
      noise_(noise),
      has_begun_(noise == 0) {
  never_wait(input_);
  never_wait(output_);
}

void FrameLink::send(Json message) {
  std::string bytes;
  if (message.at("type") == "piece") {
    bytes = std::move(message.at("data").get_ref<std::string&>());
    message.erase("data");
    message["bytes"] = bytes.size();
    bytes += '\n';
  }
  unsent_ += encode_frame(message);
  unsent_ += bytes;
  spoke_ = Clock::now();
}

void FrameLink::keep_alive(std::chrono::duration<double> silence) {
  constexpr double signs_of_life = 6;
  if (Clock::now() - spoke_ > silence / signs_of_life) send({{"type", "alive"}});
}

std::optional<Json> FrameLink::next() {
  if (!incomplete_) incomplete_ = decoder_.next();
  if (incomplete_ && incomplete_->at("type") == "piece") {
    std::optional<std::string> bytes = decoder_.take(size_of_piece(*incomplete_) + 1);
    if (!bytes) return std::nullopt;
    bytes->pop_back();
    (*incomplete_)["data"] = std::move(*bytes);
  }
  return std::exchange(incomplete_, std::nullopt);
}

void FrameLink::leave_out_noise(std::string_view bytes) {
  before_ += bytes;
  const std::size_t begin = before_.find(first_letters);
  if (begin != std::string::npos) {
    has_begun_ = true;
    decoder_.feed(before_.data() + begin, before_.size() - begin);
    before_.clear();
  } else if (before_.size() > noise_) {
    throw FrameError(fmt::format("no frame begins in the first {} bytes", before_.size()));
  }
}

void FrameLink::read_some() {
  // Bounded, so that one peer cannot keep the process from the other.
  constexpr int most_reads = 8;
  std::array<char, 65536> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  for (int reads = 0; reads < most_reads; ++reads) {
    const ssize_t count = ::read(input_.number(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) {
      has_ended_ = true;
      return;
    }
    heard_ = Clock::now();
    if (has_begun_) {
      decoder_.feed(bytes.data(), static_cast<std::size_t>(count));
    } else {
      leave_out_noise({bytes.data(), static_cast<std::size_t>(count)});
    }
  }
}

void FrameLink::write_some() {
  std::size_t written = 0;
  while (written < unsent_.size()) {
    const ssize_t count = ::write(output_.number(), unsent_.data() + written, unsent_.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) break;
    if (count < 0) {  // the peer is gone; the end of its stream follows
      written = unsent_.size();
      break;
    }
    written += static_cast<std::size_t>(count);
  }
  unsent_.erase(0, written);
}

void FrameLink::exchange(std::span<FrameLink* const> links, int other, std::chrono::milliseconds patience) {
  std::vector<pollfd> watched{{other, POLLIN, 0}};
  for (FrameLink* const link : links) {
    const bool reads = !link->has_ended_ && !link->is_on_hold_;
    watched.push_back({reads ? link->input_.number() : -1, POLLIN, 0});
    watched.push_back({link->unsent_.empty() ? -1 : link->output_.number(), POLLOUT, 0});
  }
  if (::poll(watched.data(), watched.size(), static_cast<int>(patience.count())) < 0 && errno != EINTR)
    throw std::system_error(errno, std::generic_category(), "poll");
  for (std::size_t i = 0; i < links.size(); ++i) {
    FrameLink& link = *links[i];
    if (watched[2 * i + 1].revents != 0) link.read_some();
    if (watched[2 * i + 2].revents != 0) link.write_some();
    if (link.is_finishing_ && link.unsent_.empty()) link.output_.close();
  }
}

}  // namespace peclet::runner
