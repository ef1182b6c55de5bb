// The numbers that follow from the scene of each point, as its engine names them: the Péclet number, the
// Brownian time, the thermal stress. An axis is made dimensionless by one of them, by their units alone.
#pragma once

#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/store/point_store.h"

namespace peclet::runner {

// How the numbers along an axis are scaled.
struct AxisScale {
  std::string text;             // what follows the symbol of the axis: " / (k_B T / a^3)", " τ_B"
  std::string unit;             // of the scaled numbers
  std::vector<double> factors;  // one for each point
};

class DerivedNumbers {
 public:
  // `points` are those of PagePoints, each of which has a result.
  DerivedNumbers(const Vocabulary& words, const Json& points);

  // Returns the number called `name` as a swept parameter {"pointer", "words", "symbol", "unit", "meaning"}
  // whose pointer is its name; null if no point has it.
  Json parameter(const std::string& name) const;
  // Returns its values, one for each point. Throws InputError at `option` if a point has none.
  std::vector<double> values(const std::string& option, const std::string& name) const;
  // Returns the names of the numbers that all points have, in the engine's order.
  std::vector<std::string> names() const;

  // Returns the scale of an axis in `unit` that `wanted` names: a number > 0, or a derived number. An axis in
  // its unit is divided by it, one in 1 / its unit is multiplied by it. A unit that is the symbol of a
  // derived number, such as η γ̇, stands for this number. Throws InputError at `option`.
  AxisScale scale(const std::string& option, const std::string& wanted, const std::string& unit) const;

 private:
  Json described(const std::string& name) const;
  bool is_everywhere(const std::string& name) const;
  // Returns the name of the derived number whose symbol is `unit`; "" if there is none.
  std::string named_by(const std::string& unit) const;
  // Returns 1 if the unit is that of the number, -1 if it is 1 over it, otherwise 0.
  int power_of(const std::string& name, const std::string& unit) const;

  Json descriptions_;
  std::vector<std::string> labels_;
  std::vector<Json> groups_;  // of each point
};

}  // namespace peclet::runner
