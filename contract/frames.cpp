#include "contract/frames.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <system_error>

#include "contract/errors.h"

namespace peclet {

namespace {

constexpr std::string_view magic = "PCF1";
constexpr std::size_t header_size = 8;

bool is_message(const Json& message) {
  return message.is_object() && message.contains("type") && message.at("type").is_string();
}

// Calls write(2) without SIGPIPE for a closed pipe: blocks the signal in this thread, removes it if it came.
ssize_t write_without_signal(int descriptor, const char* bytes, std::size_t count) {
  sigset_t pipe_signal;
  sigset_t before;
  sigset_t pending;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  sigpending(&pending);
  const bool was_pending = sigismember(&pending, SIGPIPE) == 1;
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  const ssize_t written = ::write(descriptor, bytes, count);
  const int error = errno;
  if (written < 0 && error == EPIPE && !was_pending) {
    const timespec at_once{};
    while (sigtimedwait(&pipe_signal, nullptr, &at_once) < 0 && errno == EINTR) {
    }
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return written;
}

ssize_t write_some(int descriptor, const char* bytes, std::size_t count) {
  const ssize_t sent = ::send(descriptor, bytes, count, MSG_NOSIGNAL);
  return sent < 0 && errno == ENOTSOCK ? write_without_signal(descriptor, bytes, count) : sent;
}

void wait_until_writable(int descriptor) {
  pollfd waiting{descriptor, POLLOUT, 0};
  ::poll(&waiting, 1, -1);
}

// Waits for bytes; returns false if none came before the deadline, if there is one.
bool wait_until_readable(int descriptor,
                         const std::optional<std::chrono::steady_clock::time_point>& deadline) {
  using std::chrono::milliseconds;
  for (;;) {
    int patience = -1;
    if (deadline) {
      const auto left = std::chrono::ceil<milliseconds>(*deadline - std::chrono::steady_clock::now());
      patience = static_cast<int>(std::clamp<milliseconds::rep>(left.count(), 0, 3'600'000));
    }
    pollfd waiting{descriptor, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, patience);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "poll");
    if (deadline && std::chrono::steady_clock::now() >= *deadline) return false;
  }
}

}  // namespace

std::string encode_frame(const Json& message) {
  if (!is_message(message)) throw FrameError("a message is a JSON object with a \"type\"");
  // Launchers (srun) hold a line back until it is whole.
  const std::string payload = message.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  if (payload.size() > largest_frame) {
    throw FrameError(fmt::format("a message of {} bytes is longer than {}", payload.size(), largest_frame));
  }
  std::string frame(magic);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    frame += static_cast<char>((payload.size() >> shift) & 0xFFU);
  }
  return frame + payload;
}

void FrameDecoder::feed(const char* bytes, std::size_t count) {
  if (begin_ > 0) {
    buffer_.erase(0, begin_);
    begin_ = 0;
  }
  buffer_.append(bytes, count);
}

std::optional<Json> FrameDecoder::next() {
  const std::string_view unread = std::string_view(buffer_).substr(begin_);
  const std::size_t known = std::min(unread.size(), magic.size());
  if (unread.substr(0, known) != magic.substr(0, known)) {
    throw FrameError("the peer does not speak protocol PCF1");
  }
  if (unread.size() < header_size) return std::nullopt;

  std::size_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    length |= std::size_t{static_cast<unsigned char>(unread[magic.size() + i])} << (8 * i);
  }
  if (length > largest_) {
    throw FrameError(fmt::format("a frame announces {} bytes, more than {}", length, largest_));
  }
  if (unread.size() - header_size < length) return std::nullopt;

  Json message;
  try {
    message = parse_json(unread.substr(header_size, length), "frame");
  } catch (const InputError& error) {
    throw FrameError(error.what());
  }
  if (!is_message(message)) throw FrameError("frame: must be a JSON object with a \"type\"");
  begin_ += header_size + length;
  return message;
}

std::optional<std::string> FrameDecoder::take(std::size_t count) {
  if (buffer_.size() - begin_ < count) return std::nullopt;
  begin_ += count;
  return buffer_.substr(begin_ - count, count);
}

void FrameChannel::send(const Json& message) {
  const std::string frame = encode_frame(message);
  std::size_t sent = 0;
  while (sent < frame.size()) {
    const ssize_t count = write_some(descriptor_, frame.data() + sent, frame.size() - sent);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {
      wait_until_writable(descriptor_);
    } else if (errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "cannot send a frame");
    }
  }
}

FrameChannel::Status FrameChannel::receive(Json& message, std::chrono::milliseconds patience) {
  std::optional<std::chrono::steady_clock::time_point> deadline;
  if (patience.count() >= 0) deadline = std::chrono::steady_clock::now() + patience;
  std::array<char, 65536> chunk;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  for (;;) {
    if (auto whole = decoder_.next()) {
      message = std::move(*whole);
      return Status::message;
    }
    if (!wait_until_readable(descriptor_, deadline)) return Status::nothing;
    const ssize_t count = ::read(descriptor_, chunk.data(), chunk.size());
    if (count > 0) {
      decoder_.feed(chunk.data(), static_cast<std::size_t>(count));
    } else if (count == 0 || errno == ECONNRESET) {
      return Status::closed;  // even within a frame: its sender is gone
    } else if (errno != EINTR && errno != EAGAIN) {
      throw std::system_error(errno, std::generic_category(), "cannot receive a frame");
    }
  }
}

}  // namespace peclet
