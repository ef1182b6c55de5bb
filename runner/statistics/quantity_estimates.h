// What the results of a point say together: for every quantity, element by element, the mean over the seeds
// and its standard error.
//
// A mean is that of value + control variate - its known mean where the quantity has one, as in a stop test,
// and beside it stands the one without. A ratio of means R = sum N / sum D has the standard error of the
// jackknife (Efron & Tibshirani, An Introduction to the Bootstrap, 1993, eq. 11.5),
//   s^2 = (n - 1) / n sum_i (R_i - mean of R_i)^2,
// R_i the ratio without seed i. Both errors are those of independent seeds; s of a constant D is the standard
// error of a mean.
//
// Under a given stress a seed that has jammed has a stress and no rate: its own ratio is infinite. Where half
// of the seeds or more have such a ratio, that of the means is that of a few seeds which happened to flow,
// and has no value. A jammed seed whose N is 0 takes no part in the ratio.
#pragma once

#include <span>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/number_layout.h"
#include "runner/statistics/quantities.h"
#include "runner/statistics/statistics.h"

namespace peclet::runner {

// Lists of as many as the quantity has elements, the last axis running fastest.
struct QuantityEstimate {
  Quantity quantity;
  std::vector<Estimate> estimates;  // NaN where there are no values
  std::vector<Estimate> plain;      // empty without a control variate
  int unlike = 0;                   // results that describe it otherwise than the first one; left out
};

class QuantityEstimates {
 public:
  enum class Wanted { all, scalars };
  explicit QuantityEstimates(Wanted wanted = Wanted::all) : wanted_(wanted) {}

  // One more result, in the order of the seeds; one that has not completed adds nothing. Memory: a few
  // numbers for each element of a mean, two for each element and seed of a ratio.
  void add(const Json& result);
  // Adds numbers that were taken from a result before, with whether its realisation has jammed; quantities
  // that the layout leaves out stay out. A layout must outlive the last call.
  void add(const NumberLayout& layout, std::span<const double> numbers, bool has_jammed);

  // In the order of the names.
  std::vector<QuantityEstimate> estimates() const;
  // {"NAME": {"symbol", "unit", "estimator", "axes", "count", "mean", "standard_error", "half_width",
  // "plain"}}, the numbers as lists over the axes; half-widths as of half_width().
  Json json(double confidence) const;

 private:
  struct Sums {
    Quantity quantity;
    std::vector<RunningEstimate> plain, controlled;
    std::vector<std::vector<double>> numerators, denominators;  // by seed
    int infinite = 0;                                           // seeds whose ratio is
    int unlike = 0;
    const NumberLayout* followed = nullptr;  // describes the quantity as it is described here
  };

  bool is_wanted(const Quantity& quantity) const;
  Sums& sums_of(const Quantity& quantity);
  static void add(Sums& sums, const Json& mean, bool has_jammed);
  static void add_numbers(Sums& sums, std::span<const double> numbers, bool has_jammed);

  Wanted wanted_;
  Json descriptions_;       // of the first result, which the sums follow
  std::vector<Sums> sums_;  // in the order of the names
};

// Sum of N over sum of D with the jackknife's error; NaN where a sum of D is zero.
Estimate ratio_of_means(const std::vector<double>& numerators, const std::vector<double>& denominators);

}  // namespace peclet::runner
