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

// What is said of a curve: the same words for every curve and point of which it is true.
struct JammingRemark {
  std::string what;
  std::string place;  // "0.62 (1 of 8)"; "" where it is the curve

  std::string text() const;
};

struct JammingEstimate {
  JammingCurve curve;
  std::vector<LawPoint> fitted;  // flowing, with an error, above the bound
  LawAnswer law;
  SteepestAnswer steepest;
  std::vector<JammingRemark> remarks;  // which points are left out and why; what contradicts the law

  int flowing() const;
  bool has_enough_points() const;  // for a law
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
