// Encodes and decodes messages between runner and engine: a header of eight bytes, then JSON.
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

// Returns true if a realisation with this cause has means: it ran to its end, or until it jammed at a given
// stress. A jammed one counts as standing still.
inline bool has_results(std::string_view cause) { return cause == "completed" || cause == "jammed"; }

// Returns true if a realisation with this cause has jammed: it stood still under its stress, its overlaps
// exceeded the guard, or it could not be packed.
inline bool is_jam(std::string_view cause) {
  return cause == "jammed" || cause == "overlap" || cause == "packing";
}

// Longest payload [bytes]: a job may hold a scene of many particles.
constexpr std::size_t largest_frame = std::size_t{64} << 20;
// Longest payload of an engine [bytes], which leaves its result in a file.
constexpr std::size_t largest_answer = std::size_t{1} << 20;

// The peer sent bytes that are not a frame: wrong magic or version, too long, not a JSON object, no "type".
class FrameError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns the frame of a message. Throws FrameError if the message has no "type" or is too long.
std::string encode_frame(const Json& message);

// Collects bytes as they arrive and returns whole messages.
class FrameDecoder {
 public:
  // Frames with a payload longer than `largest` [bytes] are refused as soon as their header is read.
  explicit FrameDecoder(std::size_t largest = largest_frame) : largest_(largest) {}
  void feed(const char* bytes, std::size_t count);
  // Returns the next message, if it is complete. Throws FrameError; the stream is then unusable.
  std::optional<Json> next();
  // Takes the next `count` bytes as they are, if they have come.
  std::optional<std::string> take(std::size_t count);
  bool empty() const { return begin_ == buffer_.size(); }

 private:
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t largest_;
};

// The engine's end of a socket pair: sends and receives frames, blocking. Does not own the descriptor.
class FrameChannel {
 public:
  explicit FrameChannel(int descriptor, std::size_t largest = largest_frame)
      : descriptor_(descriptor), decoder_(largest) {}

  // Sends a whole frame. Throws std::system_error; a closed peer gives EPIPE, never a signal.
  void send(const Json& message);

  enum class Status { message, nothing, closed };
  // Waits up to `patience` for a message; without limit if negative. Throws FrameError, std::system_error.
  Status receive(Json& message, std::chrono::milliseconds patience);

 private:
  int descriptor_;
  FrameDecoder decoder_;
};

}  // namespace peclet
