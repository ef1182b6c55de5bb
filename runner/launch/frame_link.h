// FrameLink exchanges frames through a pair of descriptors, and never waits.
//
// The bytes of a file travel behind their frame: a frame of type "piece" has their number as "bytes", and
// they end with a line break, for which launchers may wait. In memory they are its "data".
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "contract/durable_file.h"
#include "contract/frames.h"

namespace peclet::runner {

// Returns another descriptor of the same file, which programs that are started do not inherit.
Descriptor duplicate(int descriptor);

// Longest piece of a file [bytes].
constexpr std::size_t largest_piece = std::size_t{384} << 10;

class FrameLink {
 public:
  using Clock = std::chrono::steady_clock;

  // Frames that come may have `largest` bytes. `noise` bytes may come before the first frame, as the greeting
  // of a machine; they are left out.
  FrameLink(Descriptor input, Descriptor output, std::size_t largest, std::size_t noise = 0);

  // Appends a frame to what is to be sent.
  void send(Json message);
  // Returns the number of bytes that have not been taken yet.
  std::size_t unsent() const { return unsent_.size(); }
  // Closes the output when everything is sent.
  void finish() { is_finishing_ = true; }

  // Returns the next frame that has come. Throws FrameError.
  std::optional<Json> next();
  // True if the peer has ended its stream; what came before may still be there for next().
  bool has_ended() const { return has_ended_; }
  // Sends a frame "alive" if nothing was sent for a sixth of the time after which the peer would doubt it.
  void keep_alive(std::chrono::duration<double> silence);
  // True if nothing has come for that time.
  bool is_silent(std::chrono::duration<double> silence) const { return Clock::now() - heard_ > silence; }

  // While it is on hold, nothing is read, and the peer waits.
  void hold(bool on) { is_on_hold_ = on; }

  // Waits until something can be read or written on a link, or on `other` (-1: none); then reads and writes
  // what is possible.
  static void exchange(std::span<FrameLink* const> links, int other, std::chrono::milliseconds patience);

 private:
  void read_some();
  void write_some();
  void leave_out_noise(std::string_view bytes);

  Descriptor input_, output_;
  FrameDecoder decoder_;
  std::optional<Json> incomplete_;  // a piece whose bytes have not come
  std::size_t noise_;
  bool has_begun_;
  std::string before_;  // what came before the first frame
  std::string unsent_;
  bool is_finishing_ = false, has_ended_ = false, is_on_hold_ = false;
  Clock::time_point heard_ = Clock::now(), spoke_ = heard_;
};

}  // namespace peclet::runner
