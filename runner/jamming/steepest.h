// Where a viscosity rises most steeply with the volume fraction: the other definition of the jamming point,
// for curves that jump and follow no power law.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runner/jamming/law.h"

namespace peclet::runner {

struct Steepest {
  Measured fraction;  // middle of the interval of the grid where the slope is largest
  double width;       // of that interval
  // Whether it is the one between the last point that flows and the first one that is jammed, whose viscosity
  // is not finite.
  bool to_jammed = false;
};

struct SteepestAnswer {
  std::optional<Steepest> steepest{};
  std::string obstacle{};
};

// The interval of neighbouring fractions in which Delta eta / Delta phi is largest. Its error has two parts,
//   error^2 = width^2 / 12 + mean of (middle* - middle)^2,
// the grid's and that of the values: middle* is of 2000 curves whose values are drawn anew with their
// standard errors, by random numbers that are always the same for one `seed`. Where the slope is largest in
// the last interval the curve may go on to rise: then phi_m lies between the last fraction and `jammed`, the
// smallest one that is jammed, or is not determined. Points in ascending order.
SteepestAnswer find_steepest(const std::vector<LawPoint>& points, const std::optional<double>& jammed,
                             std::uint64_t seed = 1);

}  // namespace peclet::runner
