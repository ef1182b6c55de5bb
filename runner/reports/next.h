// Implements the verb `peclet next`: which seeds would lower the largest error of a curve most.
#pragma once

#include <optional>
#include <string>

#include "runner/campaign/paths.h"
#include "runner/reports/proposed_file.h"

namespace peclet::runner {

struct NextOptions {
  fs::path campaign, directory;
  std::optional<double> budget;  // processor time for each curve [s]
  int points = 2;                // new points of each curve, at most; 0: more seeds at old points only
  fs::path write;                // campaign file with the proposed points; "": none
  bool json = false;
};

// Returns proposals for each curve until its band is within the tolerance everywhere between its first and
// last point, and the patch of the campaign file. Writes nothing but the file `write`, which must not exist.
// Throws as open_campaign(), and InputError if the target has no curve, or for `write`.
Proposal propose_next(const NextOptions& options);

}  // namespace peclet::runner
