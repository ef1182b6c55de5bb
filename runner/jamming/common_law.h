// One exponent for several curves, each with a phi_m and a prefactor of its own (law.h): beta is where the
// sum over the curves of their least chi^2 at that beta is smallest. Its standard error is half the width of
// the range in which the sum is at most its least value plus max(1, chi^2 / degrees). What phi_m and
// prefactor of a curve owe to the error of beta is added in quadrature, by how they move with beta; to the 95
// % interval likewise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runner/jamming/law.h"

namespace peclet::runner {

struct LawCurve {
  std::vector<LawPoint> points;
  double flowing;  // as of fit_law()
};

struct CommonExponent {
  Measured exponent;
  int curves;  // that it is of
  double chi_squared;
  int degrees;
};

// The exponent, or why there is none; and in any case an answer for each curve.
struct CommonAnswer {
  std::optional<CommonExponent> common{};
  std::string obstacle{};
  std::vector<LawAnswer> laws{};
};

// Requires form.exponent to be absent. Curves that no exponent describes take no part.
CommonAnswer fit_common_law(const std::vector<LawCurve>& curves, const LawForm& form);

}  // namespace peclet::runner
