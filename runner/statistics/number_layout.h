// Selects the few numbers of a result that a table row stores, so that means need not read the results again.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/quantities.h"

namespace peclet::runner {

// Returns how many numbers of each result a quantity needs.
std::size_t numbers_needed(const Quantity& quantity);
// Appends the numbers of a quantity from the "mean" of a completed result; NaN for absent ones.
void append_numbers(const Quantity& quantity, const Json& mean, std::vector<double>& numbers);

// The order of the stored numbers. The observations of the target's observables come first
// (numbers_of_observation each), the leading one before the others. Then follow the quantities in the order
// of their names. A mean has its elements, then those of its control variate of mean zero, if any. A ratio
// has its numerators, then its denominators. A quantity that is an observable has the numbers of the
// observation.
class NumberLayout {
 public:
  // The components of a tensor fit in; a distribution does not.
  static constexpr std::size_t most_elements = 9;

  // Takes the quantities of a result with at most most_elements elements.
  NumberLayout(const Json& result, std::vector<std::string> observables);
  // Reads text(). Throws IntegrityError for another text.
  static NumberLayout of_text(const std::string& text);

  // Returns the numbers of a result, NaN for absent ones; nothing if the realisation has not completed.
  std::vector<double> numbers(const Json& result) const;

  const std::vector<std::string>& observables() const { return observables_; }
  // Returns the observation of observables()[place].
  Observation observation(std::size_t place, std::span<const double> numbers) const;
  const std::vector<Quantity>& quantities() const { return quantities_; }
  // Returns the numbers of quantities()[place].
  std::span<const double> of_quantity(std::size_t place, std::span<const double> numbers) const {
    return numbers.subspan(begins_[place], numbers_needed(quantities_[place]));
  }
  std::size_t count() const { return count_; }
  // Returns {"observables": [...], "quantities": as in a result}; equal texts for equal layouts.
  std::string text() const;

 private:
  NumberLayout(std::vector<Quantity> quantities, std::vector<std::string> observables);

  std::vector<std::string> observables_;
  std::vector<Quantity> quantities_;
  std::vector<std::size_t> begins_;  // index of the first number of each quantity
  std::size_t count_ = 0;
};

}  // namespace peclet::runner
