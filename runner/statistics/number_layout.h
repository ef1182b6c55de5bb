// The few numbers of a result that a row of a table has room for, so that means over thousands of seeds are
// made without reading a single result again.
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
// Appends the numbers of a quantity of a completed result's "mean".
void append_numbers(const Quantity& quantity, const Json& mean, std::vector<double>& numbers);

// The order of these numbers. First stand the observations of the target's observables, the leading one first
// (numbers_of_observation each). Then follow the quantities in the order of their names: of a mean its
// elements, then those of its control variate of mean zero, if it has one; of a ratio its numerators, then
// its denominators. A quantity that is one of the observables is not repeated: its numbers are those of the
// observation.
class NumberLayout {
 public:
  // A tensor's components fit in; a distribution does not.
  static constexpr std::size_t most_elements = 9;

  // Takes the quantities of a result that are small enough.
  NumberLayout(const Json& result, std::vector<std::string> observables);
  // Reads text(). Throws IntegrityError if it is no layout.
  static NumberLayout of_text(const std::string& text);

  // Returns the numbers of a result with this layout, NaN for what it does not have; none of a result that
  // has not completed.
  std::vector<double> numbers(const Json& result) const;

  const std::vector<std::string>& observables() const { return observables_; }
  // Returns what the numbers say of observables()[place].
  Observation observation(std::size_t place, std::span<const double> numbers) const;
  const std::vector<Quantity>& quantities() const { return quantities_; }
  // Returns the numbers of quantities()[place].
  std::span<const double> of_quantity(std::size_t place, std::span<const double> numbers) const {
    return numbers.subspan(begins_[place], numbers_needed(quantities_[place]));
  }
  std::size_t count() const { return count_; }
  // {"observables": [...], "quantities": as a result describes them}; equal for equal layouts.
  std::string text() const;

 private:
  NumberLayout(std::vector<Quantity> quantities, std::vector<std::string> observables);

  std::vector<std::string> observables_;
  std::vector<Quantity> quantities_;
  std::vector<std::size_t> begins_;  // of each quantity, among the numbers
  std::size_t count_ = 0;
};

}  // namespace peclet::runner
