// The verb `peclet plan`: the pilot is run, the plan made of what the database has, and told.
#pragma once

#include <optional>

#include "runner/command_line/run.h"

namespace peclet::runner {

struct PlanOptions {
  RunOptions run;            // of the pilot; its workers are those that the campaign is planned for
  std::optional<int> pilot;  // seeds of each point to run first; none: nothing is run and nothing written
  bool json = false;
};

// Asks the engine how long the realisations are, and the database, if there is one, what they cost; where it
// does not know, the engine tries a realisation of the point with the median work for two seconds. With a
// pilot runs it first and stores its predictions. Prints the plan; returns 0, or as run_pilot(). Throws as
// run_campaign().
int plan_campaign(const PlanOptions& options);

}  // namespace peclet::runner
