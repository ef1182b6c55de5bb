// Hindrance and Pause say what keeps a campaign's owner from booking for a while, and whether that is over.
// It is a full disk, another program's lock or a failing disk; no engine is to blame.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "runner/campaign/paths.h"

namespace peclet::runner {

struct Hindrance {
  std::string text;   // the hindrance as a sentence without its full stop
  std::string end;    // "when there is room"
  fs::path folder{};  // folder that lacks room for `bytes`; empty for other hindrances
  std::uint64_t bytes = 0;

  // Returns a key that stays the same while the figures in `text` change. All folders of one full file system
  // have the same key.
  std::string kind() const;
};

// Returns the hindrance of too little room for `bytes` in `folder`; `error` is ENOSPC or EDQUOT.
Hindrance lack_of_room_in(const fs::path& folder, std::uint64_t bytes, int error);

// Returns the temporary hindrance behind an exception, for an owner whose database is in `root`; nothing if
// it is not temporary. `bytes` were to be written where the exception does not say how many.
std::optional<Hindrance> hindrance_in(const std::exception& error, const fs::path& root,
                                      std::uint64_t bytes = 0);

class Pause {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void begin(Hindrance hindrance, Time now);
  bool lasts() const { return hindrance_.has_value(); }

  // True if is_over() would check now.
  bool is_looked_at(Time now) const;
  // Checks, every few seconds at most, whether there is room or it is time to try again. Returns true if the
  // pause has just ended.
  bool is_over(Time now);

  // Returns why waiting cannot help the campaign in folder `root`; "" unless this has held for twenty
  // seconds, in which workers that ended may have freed room.
  std::string in_vain(const fs::path& root, Time now);

 private:
  std::optional<Hindrance> hindrance_;
  Time looked_{};
  std::optional<Time> vain_since_;
};

}  // namespace peclet::runner
