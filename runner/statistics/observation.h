// What a realisation says of one observable.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

struct Observation {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN where it has none
  double control = 0;  // control variate of mean zero; 0 where there is none
  // value + control over the first quarter and the first half of the window; NaN where they are not known
  double first_quarter = std::numeric_limits<double>::quiet_NaN();
  double first_half = std::numeric_limits<double>::quiet_NaN();
  bool is_share = false;  // the value is 0 or 1 by its nature

  bool has_value() const { return !std::isnan(value); }
  double controlled() const { return value + control; }
};

// Numbers that are stored of an observation: value, control, first quarter and first half.
constexpr std::size_t numbers_of_observation = 4;

// Appends the numbers of the observation at a path of the means of a completed result (quantities.h); NaN for
// what does not exist. The control variate is the one that the result names.
void append_observation(const Json& result, const std::string& path, std::vector<double>& numbers);

// Returns the observation of which these are the numbers.
Observation observation_of(std::span<const double> numbers, bool is_share);

// Returns value + control in each block of the window, in order of time; NaN in a block without a sample,
// nothing where the result has no blocks of the observable. A control variate without blocks is left out.
std::vector<double> block_values(const Json& result, const std::string& observable);

// Returns whether the means have the observable, if only as null, which says that it does not exist for this
// realisation.
bool has_observable(const Json& mean, const std::string& observable);

// Returns the first of the observables that the means of a completed result do not have; "" if they have all.
std::string lacking_in(const Json& result, const std::vector<std::string>& observables);

}  // namespace peclet::runner
