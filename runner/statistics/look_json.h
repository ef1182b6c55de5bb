// Estimates and looks as JSON, the same wherever they are printed.
#pragma once

#include <vector>

#include "contract/json.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {

// Null for a number that does not exist.
Json number_json(double value);

Json estimate_json(const Estimate& estimate);

// The estimate that decides with its half-width, and the one without the control variate; numbers that do not
// exist are null.
Json look_json(const Look& look);

// What values an estimate with this half-width is of. Shares m of n have the standard error
// sqrt(m (1 - m) / (n - 1)) and a whole number n m of ones, other values next to never. Repeated ones look
// like equal ones.
Estimate::Values stored_values(const Estimate& estimate, double half_width);

// Look::each, and the same read back. Throws a std::exception for what is none.
Json observables_json(const Look& look);
std::vector<ObservableLook> observables_of(const Json& json);

}  // namespace peclet::runner
