// The verb `peclet retry`: seeds that were given up get another chance.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/verbs/ask_owner.h"

namespace peclet::runner {

struct RetryOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::vector<std::string> points;  // labels, or at least 4 digits of the hash; none: all
  std::vector<int> seeds;           // of one point; none: all that were given up
  double patience = usual_patience;
};

// Queues them again; their earlier attempts are kept, but no longer count against them. Throws InputError for
// a campaign that has not been run; as await_reply() and plan_retry().
Reply retry_seeds(const RetryOptions& options);

}  // namespace peclet::runner
