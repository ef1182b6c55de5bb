// What keeps a campaign's owner from booking for a while, and whether that is over: a full disk, a lock of
// another program, a disk that fails. No engine is to blame for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "runner/campaign/paths.h"

namespace peclet::runner {

struct Hindrance {
  std::string text;   // a sentence without its end: what it is
  std::string end;    // "when there is room"
  fs::path folder{};  // that lacks room for `bytes`; empty: it is not room that is lacking
  std::uint64_t bytes = 0;

  // Returns what is in the way, the same text for as long as it is: `text` has figures that change. A full
  // file system is one hindrance, whichever of its folders is named.
  std::string kind() const;
};

// Too little room for `bytes` in `folder`, for which `error` is ENOSPC or EDQUOT.
Hindrance lack_of_room_in(const fs::path& folder, std::uint64_t bytes, int error);

// The hindrance that an exception tells of, in the way of an owner whose database is in `root`; nothing if it
// is none that passes. `bytes` were to be written where the exception does not say how many.
std::optional<Hindrance> hindrance_in(const std::exception& error, const fs::path& root,
                                      std::uint64_t bytes = 0);

class Pause {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void begin(Hindrance hindrance, Time now);
  bool lasts() const { return hindrance_.has_value(); }

  // Whether is_over() would look now.
  bool is_looked_at(Time now) const;
  // Looks whether there is room, or whether it is time to try again, every few seconds at most. True when
  // there just turned out to be.
  bool is_over(Time now);

  // Why waiting in the campaign's folder `root` is in vain; "" unless that has been so for twenty seconds,
  // in which workers may have ended and freed what they had.
  std::string in_vain(const fs::path& root, Time now);

 private:
  std::optional<Hindrance> hindrance_;
  Time looked_{};
  std::optional<Time> vain_since_;
};

}  // namespace peclet::runner
