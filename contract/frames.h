// Messages between runner and engine: a header of eight bytes, then JSON.
//
//   bytes 0-3  "PCF1": the letters PCF and the version of this format
//   bytes 4-7  length of the payload, unsigned, little-endian, at most 64 MiB
//   then       the payload: one JSON object in UTF-8 whose "type" names the message
//
// schema/README.md lists the messages.
#pragma once

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "contract/json.h"

namespace peclet {

// Returns whether a realisation with this cause has means: it ran to its end, or until it jammed under a
// stress, after which it counts as standing still.
inline bool has_results(std::string_view cause) { return cause == "completed" || cause == "jammed"; }

// Returns whether a realisation with this cause has jammed: it stood still under its stress, was pressed
// together further than the guard allows, or could not be packed.
inline bool is_jam(std::string_view cause) {
  return cause == "jammed" || cause == "overlap" || cause == "packing";
}

constexpr std::size_t largest_frame = std::size_t{64} << 20;
// Of what an engine says. A job may hold a scene of many particles; a result is a file.
constexpr std::size_t largest_answer = std::size_t{1} << 20;

// The peer sent something that is no frame: wrong magic or version, oversize, no JSON object, no "type".
class FrameError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string encode_frame(const Json& message);

// Collects bytes as they come and hands out whole messages.
class FrameDecoder {
 public:
  // Frames longer than `largest` are refused when they are announced.
  explicit FrameDecoder(std::size_t largest = largest_frame) : largest_(largest) {}
  void feed(const char* bytes, std::size_t count);
  // The next whole message, or nothing yet. Throws FrameError; the stream is then unusable.
  std::optional<Json> next();
  bool empty() const { return begin_ == buffer_.size(); }

 private:
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t largest_;
};

// Blocking use of one end of a socket pair; the engine's side. Does not own the descriptor.
class FrameChannel {
 public:
  // As FrameDecoder.
  explicit FrameChannel(int descriptor, std::size_t largest = largest_frame)
      : descriptor_(descriptor), decoder_(largest) {}

  // Sends a whole frame. Throws std::system_error; a closed peer is EPIPE, never a signal.
  void send(const Json& message);

  enum class Status { message, nothing, closed };
  // Waits up to `patience` for a message (a negative one waits for ever).
  Status receive(Json& message, std::chrono::milliseconds patience);

 private:
  int descriptor_;
  FrameDecoder decoder_;
};

}  // namespace peclet
