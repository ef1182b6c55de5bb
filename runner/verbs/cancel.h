// The verb `peclet cancel`: points that get no more seeds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/verbs/ask_owner.h"

namespace peclet::runner {

struct CancelOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::vector<std::string> points;  // labels, or at least 4 digits of the hash
  bool undo = false;
  double patience = usual_patience;
};

// The points' running seeds checkpoint and stop, what they have stays, and they hold nothing up; with `undo`
// they go on where they were. Throws InputError for a campaign that has not been run; as await_reply().
Reply cancel_points(const CancelOptions& options);

}  // namespace peclet::runner
