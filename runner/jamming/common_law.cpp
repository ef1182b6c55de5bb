#include "runner/jamming/common_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

namespace peclet::runner {
namespace {

constexpr double smallest_exponent = 0.25, largest_exponent = 6;
constexpr int exponents = 116;
constexpr double infinite = std::numeric_limits<double>::infinity();

double exponent_at(int place) {
  return smallest_exponent + (largest_exponent - smallest_exponent) * place / (exponents - 1);
}

class CommonFit {
 public:
  CommonFit(const std::vector<LawCurve>& curves, const LawForm& form) : form_(form) {
    for (const LawCurve& curve : curves) {
      bool is_described = false;
      for (int place = 0; place < exponents && !is_described; ++place) {
        is_described = law(curve, exponent_at(place)).law.has_value();
      }
      if (is_described) curves_.push_back(&curve);
    }
  }

  LawAnswer law(const LawCurve& curve, double exponent) const {
    LawForm given = form_;
    given.exponent = exponent;
    return fit_law(curve.points, given, curve.flowing);
  }

  // The exponent, or why there is none.
  CommonAnswer common() const {
    int least = 0;
    std::vector<double> sums;
    for (int place = 0; place < exponents; ++place) {
      sums.push_back(chi_squared(exponent_at(place)));
      if (sums.back() < sums[static_cast<std::size_t>(least)]) least = place;
    }
    const bool is_at_an_end = least == 0 || least == exponents - 1;
    if (curves_.size() < 2 || is_at_an_end || sums[static_cast<std::size_t>(least)] == infinite) {
      return refused(fmt::format("no exponent from {} to {} describes two curves or more together",
                                 smallest_exponent, largest_exponent));
    }
    constexpr int bits = 30;
    const auto [best, sum] =
        boost::math::tools::brent_find_minima([this](double exponent) { return chi_squared(exponent); },
                                              exponent_at(least - 1), exponent_at(least + 1), bits);
    const int of_points = degrees();
    const double bound = sum + std::max(1.0, sum / of_points);
    if (chi_squared(smallest_exponent) <= bound || chi_squared(largest_exponent) <= bound) {
      return refused(
          "the points do not bound the common exponent: smaller errors, or points nearer to jamming, would");
    }
    const double error =
        0.5 * (crossing(best, largest_exponent, bound) - crossing(best, smallest_exponent, bound));
    return {CommonExponent{{best, error}, static_cast<int>(curves_.size()), sum, of_points}, "", {}};
  }

 private:
  static CommonAnswer refused(const std::string& why) { return {std::nullopt, why, {}}; }

  // Infinite where it leaves a curve without a law.
  double chi_squared(double exponent) const {
    double sum = 0;
    for (const LawCurve* const curve : curves_) {
      const LawAnswer answer = law(*curve, exponent);
      if (!answer.law) return infinite;
      sum += answer.law->chi_squared;
    }
    return sum;
  }

  int degrees() const {
    LawForm given = form_;
    given.exponent = 1;
    int sum = -1;
    for (const LawCurve* const curve : curves_) {
      sum += static_cast<int>(curve->points.size()) - given.parameters();
    }
    return sum;
  }

  // The exponent between both at which the sum passes the bound: below it at the first one, above at the
  // other.
  double crossing(double inside, double outside, double bound) const {
    if (chi_squared(outside) <= bound) return outside;
    for (int halving = 0; halving < 30; ++halving) {
      const double middle = 0.5 * (inside + outside);
      (chi_squared(middle) <= bound ? inside : outside) = middle;
    }
    return inside;
  }

  LawForm form_;
  std::vector<const LawCurve*> curves_;
};

// The law of a curve at the common exponent, with what its error does to it.
LawAnswer law_with(const CommonFit& fit, const LawCurve& curve, const Measured& exponent) {
  LawAnswer answer = fit.law(curve, exponent.value);
  if (!answer.law) return answer;
  Law& law = *answer.law;
  law.exponent = exponent;
  const LawAnswer above = fit.law(curve, exponent.value + exponent.standard_error);
  const LawAnswer below = fit.law(curve, exponent.value - exponent.standard_error);
  if (!above.law && !below.law)
    return {std::nullopt, "the error of the common exponent leaves it without a law"};
  // Half the difference over two standard errors; where one of them has no law, the other side alone.
  const auto moves = [&](double (*of)(const Law&)) {
    if (above.law && below.law) return 0.5 * (of(*above.law) - of(*below.law));
    return above.law ? of(*above.law) - of(law) : of(law) - of(*below.law);
  };
  const double fraction = moves([](const Law& one) { return one.fraction.value; });
  const double prefactor = moves([](const Law& one) { return one.prefactor.value; });
  law.low =
      std::max(curve.flowing, law.fraction.value - std::hypot(law.fraction.value - law.low, z_95 * fraction));
  law.high = law.fraction.value + std::hypot(law.high - law.fraction.value, z_95 * fraction);
  law.fraction.standard_error = std::hypot(law.fraction.standard_error, fraction);
  law.prefactor.standard_error = std::hypot(law.prefactor.standard_error, prefactor);
  return answer;
}

}  // namespace

CommonAnswer fit_common_law(const std::vector<LawCurve>& curves, const LawForm& form) {
  const CommonFit fit(curves, form);
  CommonAnswer answer = fit.common();
  for (const LawCurve& curve : curves) {
    answer.laws.push_back(answer.common ? law_with(fit, curve, answer.common->exponent)
                                        : LawAnswer{std::nullopt, answer.obstacle});
  }
  return answer;
}

}  // namespace peclet::runner
