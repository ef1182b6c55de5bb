// What `peclet jamming` says, for people and for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/jamming/estimate.h"
#include "runner/jamming/proposal.h"

namespace peclet::runner {

struct JammingReport {
  JammingCurves campaign;  // its curves are in the estimates
  EstimateChoice choice;
  double softest = 0.001;
  bool by_law = true, by_steepest = true;
  CommonAnswer common{};  // where the choice is one exponent for all
  std::vector<JammingEstimate> estimates;
  std::optional<ProposedPoints> proposed;  // where it was asked for
};

std::string jamming_table(const JammingReport& report);
Json jamming_json(const JammingReport& report);

}  // namespace peclet::runner
