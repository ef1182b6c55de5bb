// Which seeds a retry queues again.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runner/store/database.h"

namespace peclet::runner {

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
