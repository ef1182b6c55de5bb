// Queries of `peclet doctor`: what in a database contradicts itself.
#pragma once

#include <cstdint>
#include <string>

#include "runner/store/database.h"

namespace peclet::runner {

// Returns how many results of the point were deflated with another dictionary than the one that is there.
int unreadable_results(Database& database, std::int64_t point);

// Returns the text of a stored result, or its bytes if it cannot be read; "" for a seed without one.
std::string readable_result(Database& database, std::int64_t point, int seed);

struct StateFaults {
  std::int64_t unclaimed = 0;  // results of seeds that have not ended
  std::int64_t adrift = 0;     // leases and running seeds that do not belong together
  std::int64_t running = 0;    // seeds that run
};
StateFaults state_faults(Database& database);

struct ClockFaults {
  std::int64_t backwards = 0;  // events that are earlier than the one before
  std::int64_t negative = 0;   // attempts that end before they begin
  std::int64_t future = 0;     // events and attempts after `now`
};
ClockFaults clock_faults(Database& database, const std::string& now);

}  // namespace peclet::runner
