// Reads how results describe their numbers ("quantities" in schema/result.schema.json), so that the runner
// knows no quantity by name.
//
// The name of a quantity or an element is its path in the "mean" of a result: "pressure", "stress/total",
// "stress/total/3". A leading slash is allowed.
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

// Another quantity of the same shape whose mean is known: value + control - mean has the mean of the value.
struct ControlVariate {
  std::string quantity;
  double mean = 0;
  friend bool operator==(const ControlVariate&, const ControlVariate&) = default;
};

// The members of a quantity's object whose means over the seeds are divided.
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
  std::string symbol, unit;  // "" if the engine does not describe it; the unit of a pure number is "1"
  std::vector<QuantityAxis> axes{};
  std::optional<RatioOfMeans> ratio{};
  std::optional<ControlVariate> control{};
  bool is_share = false;  // one number, 0 or 1 in each realisation

  std::size_t elements() const;
};

// Returns the quantities of a completed result, in the order of their names. Without descriptions, every
// number and every list of numbers in "mean" is a quantity without symbol and unit, with axes counted from 0.
// Requires a result that check_shape() has passed.
std::vector<Quantity> quantities_of(const Json& result);

// Returns the value at a path, or null if there is none. Elements of lists are named by their index.
const Json* at_path(const Json& document, std::string_view path);

// Returns the control variate of the number at a path of "mean", with the path of the control's own number;
// nothing if it has none.
std::optional<ControlVariate> control_of(const Json& result, std::string_view path);

// Returns "mean", "ratio" or "share", as results name it.
const char* estimator_of(const Quantity& quantity);

// Returns true if the number at the path is a share.
bool is_share(const std::vector<Quantity>& quantities, std::string_view path);

// Returns true if the pattern names the path; "stress/total/*" names any element of the list.
bool matches(std::string_view pattern, std::string_view path);

// Returns the paths at which a campaign may aim: "pressure, stress/total/*".
std::string names_of_targets(const Json& result);

// The value of an observable in one realisation, with its control variate.
struct Observation {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN if it has none
  double control = 0;                                       // control variate of mean zero; 0 without one
  // value + control over the first quarter and the first half of the window; NaN if unknown
  double first_quarter = std::numeric_limits<double>::quiet_NaN();
  double first_half = std::numeric_limits<double>::quiet_NaN();
  bool is_share = false;  // the value is 0 or 1 by definition

  bool has_value() const { return !std::isnan(value); }
  double controlled() const { return value + control; }
};

// The stored numbers of an observation: value, control, first quarter and first half.
constexpr std::size_t numbers_of_observation = 4;

// Appends these numbers for the observable at a path of the means of a completed result; NaN for absent ones.
void append_observation(const Json& result, const std::string& path, std::vector<double>& numbers);

// Returns the observation that has these numbers.
Observation observation_of(std::span<const double> numbers, bool is_share);

// Returns value + control in each block of the window, in order of time; NaN in a block without a sample.
// Empty if the result has no blocks of the observable. A control variate without blocks is left out.
std::vector<double> block_values(const Json& result, const std::string& observable);

// Returns true if the means have the observable, even as null (it has no value in this realisation).
bool has_observable(const Json& mean, const std::string& observable);

// Returns the first observable that the means of a completed result lack; "" if they have all.
std::string lacking_in(const Json& result, const std::vector<std::string>& observables);

}  // namespace peclet::runner
