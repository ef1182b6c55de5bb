// The jamming point of a curve by both definitions, and what went into them.
#pragma once

#include <string>
#include <vector>

#include "runner/jamming/common_law.h"
#include "runner/jamming/curves.h"
#include "runner/jamming/law.h"
#include "runner/jamming/steepest.h"

namespace peclet::runner {

struct EstimateChoice {
  LawForm form{};
  double above = 10;             // viscosity of the points of the law: it is one of what is near jamming
  bool common_exponent = false;  // one for all curves; then form.exponent is absent
};

struct JammingEstimate {
  JammingCurve curve;
  std::vector<LawPoint> fitted;  // flowing, with an error, above the bound
  LawAnswer law;
  SteepestAnswer steepest;
  std::vector<std::string> remarks;  // which points are left out and why; what contradicts the law

  int flowing() const;
};

// The law of the flowing points; the steepest rise of all that have a value with an error and are neither
// suspect nor partly jammed. `choice.common_exponent` is not looked at.
JammingEstimate estimate_jamming(const JammingCurve& curve, const EstimateChoice& choice);

struct JammingEstimates {
  std::vector<JammingEstimate> curves;
  CommonAnswer common;  // where the choice is one exponent for all
};
JammingEstimates estimate_all(const std::vector<JammingCurve>& curves, const EstimateChoice& choice);

}  // namespace peclet::runner
