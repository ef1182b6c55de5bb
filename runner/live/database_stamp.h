// Whether a database may have changed since somebody looked, without opening it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// Of the database and its write-ahead log: which files they are, their sizes and when they were last written;
// and who owns the campaign. Every commit writes one of the two.
struct DatabaseStamp {
  struct File {
    std::uint64_t device = 0, number = 0;
    std::int64_t bytes = 0, seconds = 0, nanoseconds = 0;
    friend bool operator==(const File&, const File&) = default;
  };
  File database, log;  // zeros while there is none
  std::optional<std::int64_t> owner;
  friend bool operator==(const DatabaseStamp&, const DatabaseStamp&) = default;

  // Whether it was written so short a time before `now` that the next commit might bear the same time: clocks
  // of file systems tick every few milliseconds.
  bool is_fresh(std::chrono::system_clock::time_point now) const;
};

DatabaseStamp stamp_of(const CampaignDirectory& directory);

}  // namespace peclet::runner
