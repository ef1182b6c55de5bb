// The few numbers of a result that a row of a table has room for, so that means over thousands of seeds are
// made without reading a single result again.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/statistics/quantities.h"

namespace peclet::runner {

// Quantities whose numbers stand one after another, in the order of their names: of a mean its elements, then
// those of its control variate, if it has one; of a ratio its numerators, then its denominators.
class NumberLayout {
 public:
  // A tensor's components fit in; a distribution does not.
  static constexpr std::size_t most_elements = 9;

  // Of the quantities of a result that are small enough.
  explicit NumberLayout(const Json& result);
  // Of text(). Throws IntegrityError for what is none.
  static NumberLayout of_text(const std::string& text);

  // Those of a result with this layout; NaN for what it does not have. None of one that has not completed.
  std::vector<double> numbers(const Json& result) const;

  const std::vector<Quantity>& quantities() const { return quantities_; }
  // How many there are.
  std::size_t count() const { return count_; }
  // As a result describes its "quantities": equal for equal layouts.
  std::string text() const;

 private:
  explicit NumberLayout(std::vector<Quantity> quantities);

  std::vector<Quantity> quantities_;
  std::size_t count_ = 0;
};

// How many numbers of each result a quantity needs.
std::size_t numbers_needed(const Quantity& quantity);
// Puts those of a completed result's "mean" behind the others.
void append_numbers(const Quantity& quantity, const Json& mean, std::vector<double>& numbers);

}  // namespace peclet::runner
