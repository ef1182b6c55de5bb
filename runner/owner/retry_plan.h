// Points as people name them, and the seeds that a retry queues again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

// How people name a point on the command line.
//
// The index of the point of that label, or else of the only one with these values ("10 0.5", as in the row of
// a table) or with those 4 or more leading digits of its hash.
// Throws InputError for a name that no point, or more than one, has.
std::size_t find_point(const std::vector<PointRecord>& points, const std::string& name);

// Which seeds a retry queues again.
struct RetryPlan {
  std::map<std::int64_t, std::vector<int>> seeds;  // by PointRecord::id
  std::string message;                             // what is done, and why not more
};

// The seeds of `points` that were given up, or of these the `seeds` that are named.
// Throws InputError for named seeds of more than one point, and for one that was not given up: a seed that
// ended with the engine's own verdict would end so again.
RetryPlan plan_retry(Database& database, const std::vector<PointRecord>& points,
                     const std::vector<int>& seeds);

}  // namespace peclet::runner
