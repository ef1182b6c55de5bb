// Estimates every quantity of a point, element by element: its mean over the seeds with the standard error.
//
// A quantity with a control variate has the mean of value + control - known mean of the control, as in a stop
// test, and the plain mean beside it. A ratio of means R = sum N / sum D has the standard error s of the
// jackknife (Efron & Tibshirani, An Introduction to the Bootstrap, 1993, eq. 11.5),
//   s^2 = (n - 1) / n sum_i (R_i - mean of R_i)^2,
// where R_i is the ratio without seed i. Both errors assume independent seeds. For constant D, s is the
// standard error of a mean.
//
// Under a given stress a jammed seed has a stress but no rate: its own ratio is infinite. If half of the
// seeds or more have such a ratio, the ratio of means has no value, because it would be that of the few seeds
// that happened to flow. A jammed seed with N = 0 does not count as infinite.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/number_layout.h"
#include "runner/statistics/quantities.h"
#include "runner/statistics/statistics.h"

namespace peclet::runner {

// The estimates of a quantity, one for each element, the last axis running fastest.
struct QuantityEstimate {
  Quantity quantity;
  std::vector<Estimate> estimates;  // NaN without values
  std::vector<Estimate> plain;      // without control variate; empty if the quantity has none
  int unlike = 0;                   // results left out, because they describe it unlike the first one
};

class QuantityEstimates {
 public:
  enum class Wanted { all, scalars };
  explicit QuantityEstimates(Wanted wanted = Wanted::all) : wanted_(wanted) {}
  // Estimates the quantities with these names alone.
  explicit QuantityEstimates(std::vector<std::string> names) : names_(std::move(names)) {}

  // Adds a result; results come in the order of the seeds. One that has not completed adds nothing. Memory: a
  // few numbers for each element of a mean, two for each element and seed of a ratio.
  void add(const Json& result);
  // Adds the stored numbers of a result instead, for the quantities of their layout. The layout must outlive
  // the last call.
  void add(const NumberLayout& layout, std::span<const double> numbers, bool has_jammed);

  // Returns the estimates in the order of the names.
  std::vector<QuantityEstimate> estimates() const;
  // Returns {"NAME": {"symbol", "unit", "estimator", "axes", "count", "mean", "standard_error", "half_width",
  // "plain"}}. The numbers are lists over the axes; half-widths are those of half_width().
  Json json(double confidence) const;

 private:
  struct Sums {
    Quantity quantity;
    std::vector<RunningEstimate> plain, controlled;
    std::vector<std::vector<double>> numerators, denominators;  // by seed
    int infinite = 0;                                           // seeds with an infinite ratio
    int unlike = 0;
    const NumberLayout* followed = nullptr;  // a layout that describes the quantity as `quantity` does
  };

  bool is_wanted(const Quantity& quantity) const;
  Sums& sums_of(const Quantity& quantity);
  static void add(Sums& sums, const Json& mean, bool has_jammed);
  static void add_numbers(Sums& sums, std::span<const double> numbers, bool has_jammed);

  Wanted wanted_ = Wanted::all;
  std::vector<std::string> names_{};  // empty: any
  Json descriptions_;                 // of the first result; the sums follow it
  std::vector<Sums> sums_;            // in the order of the names
};

// Returns sum of N over sum of D with the jackknife's standard error; NaN if a sum of D is zero.
Estimate ratio_of_means(const std::vector<double>& numerators, const std::vector<double>& denominators);

}  // namespace peclet::runner
