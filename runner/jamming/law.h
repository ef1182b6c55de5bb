// The power law by which a viscosity diverges at the jamming point, fitted to points with errors:
//   eta = A (1 - phi / phi_m)^-beta.
//
// Least squares in ln eta, y_i = ln eta_i with the errors s_i = (standard error / mean)_i c_i. Given phi_m
// the law is a line in x_i = -ln(1 - phi_i / phi_m), so that ln A and beta follow in closed form and only
// phi_m, above the largest fraction that flows, is searched for (variable projection: G. Golub and V.
// Pereyra, SIAM J. Numer. Anal. 10, 413, 1973). c^2 = (n - 1) / (n - 3) is the mean of Student's t squared
// with n - 1 degrees of freedom: the spread of a few seeds is itself uncertain, and without c weights of
// points whose spread came out small by luck make chi^2 too large and intervals too narrow.
//
// The interval of phi_m is where chi^2(phi_m) <= least chi^2 + z^2 max(1, chi^2 / degrees), z = 1 for the
// standard error (half the width) and 1.96 for 95 %: a law that does not describe the points has wider
// ones. It is not symmetric: far points hold phi_m from below better than from above.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace peclet::runner {

struct LawPoint {
  double fraction;        // phi, in (0, 1)
  double value;           // eta_r > 0
  double standard_error;  // > 0
  int count;              // of the seeds behind them, at least fewest_seeds
};
constexpr double z_95 = 1.959963984540054;  // standard errors to either end of an interval of 95 %
constexpr int fewest_seeds = 4;             // of a point: c is not finite for fewer
constexpr std::size_t fewest_points = 4;    // of a fit

struct LawForm {
  std::optional<double> exponent{};  // beta, where it is not fitted
  bool unit_prefactor = false;       // A = 1, as where the law is to hold at all fractions

  int parameters() const { return 3 - (exponent ? 1 : 0) - (unit_prefactor ? 1 : 0); }
};

// A number and its standard error, which is 0 of what was given.
struct Measured {
  double value, standard_error;
};

struct Law {
  Measured fraction;   // phi_m
  double low, high;    // its 95 % interval
  Measured exponent;   // beta
  Measured prefactor;  // A
  double chi_squared;
  int degrees;  // of freedom: points less parameters, at least 1
};

// What least squares of y = constant + slope x give; the one that is not fitted is 0 with the error 0.
struct Line {
  double constant = 0, slope = 0;
  double constant_variance = 0, slope_variance = 0;
  double chi_squared = 0;  // of what is left
};
struct LineForm {
  bool with_constant = true, with_slope = true;
};
// Requires as many points as parameters at least, and different x where there is a slope.
Line weighted_line(const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& weights, const LineForm& form);

// -ln(1 - phi / phi_m) of each point.
std::vector<double> depths(const std::vector<LawPoint>& points, double jamming);
// 1 / s_i^2.
std::vector<double> weights(const std::vector<LawPoint>& points);

// The law, or why there is none: one of both.
struct LawAnswer {
  std::optional<Law> law{};
  std::string obstacle{};
};

// `flowing`: the largest fraction of which it is known that it flows; phi_m is searched for from there to 1.
LawAnswer fit_law(const std::vector<LawPoint>& points, const LawForm& form, double flowing);

}  // namespace peclet::runner
