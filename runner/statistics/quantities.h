// What results say of their numbers ("quantities" in schema/result.schema.json), so that the runner needs to
// know none by name.
//
// A quantity's name is its path in the result's "mean", an element's the path to it: "pressure",
// "stress/total", "stress/total/3". A leading slash may be there.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

// Another quantity of the same shape, of which the mean is known: value + control - mean has the mean of the
// value.
struct ControlVariate {
  std::string quantity;
  double mean = 0;
  friend bool operator==(const ControlVariate&, const ControlVariate&) = default;
};

// Members of the quantity's object whose means over the seeds are divided.
struct RatioOfMeans {
  std::string numerator, denominator;
  friend bool operator==(const RatioOfMeans&, const RatioOfMeans&) = default;
};

struct QuantityAxis {
  std::string name, unit;
  Json values;  // numbers or words
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ControlVariate, quantity, mean)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(QuantityAxis, name, unit, values)

struct Quantity {
  std::string name;
  std::string symbol, unit;  // "" where the engine says nothing, "1" for a pure number
  std::vector<QuantityAxis> axes{};
  std::optional<RatioOfMeans> ratio{};
  std::optional<ControlVariate> control{};
  bool is_share = false;  // one number, 0 or 1 in each realisation

  std::size_t elements() const;
};

// Those of a completed result, in the order of their names. Of a result without descriptions every number and
// every list of numbers in "mean" is one, without symbol and unit, its axes counted from 0. Requires a result
// that check_shape() has passed.
std::vector<Quantity> quantities_of(const Json& result);

// The value at a path, or null (the pointer) where there is none. Indices of lists are whole numbers.
const Json* at_path(const Json& document, std::string_view path);

// The control variate of the number at a path of "mean", and the path to the control's own number; none for
// most.
std::optional<ControlVariate> control_of(const Json& result, std::string_view path);

// "mean", "ratio" or "share", as the result names it.
const char* estimator_of(const Quantity& quantity);

// Whether the number at the path is a share.
bool is_share(const std::vector<Quantity>& quantities, std::string_view path);

// Whether the pattern names the path: "stress/total/*" names any element of the list.
bool matches(std::string_view pattern, std::string_view path);

// "pressure, stress/total/*": what a campaign may aim at.
std::string names_of_targets(const Json& result);

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
