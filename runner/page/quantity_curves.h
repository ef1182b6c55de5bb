// Quantities that have an axis of numbers, such as a stress over strain, a modulus over frequency, g(r) or a
// profile: their names, and their estimates along the axis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/page/page_data.h"
#include "runner/statistics/quantity_estimates.h"

namespace peclet::runner {

// A quantity along its last axis, at one element of the axes before it.
struct QuantityCurve {
  Drawable about;          // its path is the name with which it was found
  QuantityAxis axis;       // two numbers or more
  std::size_t offset = 0;  // place of the first element
};

// Returns the curve that `name` names: the quantity, with "/ELEMENT" for each axis before the last one, as
// "transient/shear_stress", "profiles/stress/total/xy". Returns nothing if no quantity has this name and an
// axis of numbers. Throws InputError at --quantity if elements are missing, and names them.
std::optional<QuantityCurve> find_curve(const std::vector<Quantity>& quantities, const std::string& name);

// Returns the names of quantities with such an axis.
std::vector<std::string> names_of_curves(const std::vector<Quantity>& quantities);

}  // namespace peclet::runner
