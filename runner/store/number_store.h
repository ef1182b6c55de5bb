// NumberStore keeps the few numbers of each result (number_layout.h) in a table of their own, as JSON arrays.
// Stop tests and means over all seeds then take a reader a thousandth of the time that the results would
// take.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/statistics/cohorts.h"
#include "runner/statistics/number_layout.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

// Numbers of a result as they are stored, and its outcome. A result that has not completed has no numbers and
// is lost.
struct ResultNumbers {
  std::string layout, numbers;
  Outcome outcome;
};
ResultNumbers numbers_of(const Json& result, const std::vector<std::string>& observables);
// Stores the numbers of a seed, in place of earlier ones. For use inside a Transaction of the caller.
void store_numbers(Connection& connection, std::int64_t point, int seed, const ResultNumbers& numbers);

// Returns the observation of the leading observable from stored numbers; without a value for "". It does not
// say whether it is a share. Throws IntegrityError.
Observation leading_observation(std::string_view numbers);

class NumberStore {
 public:
  // The connection must outlive it.
  explicit NumberStore(Connection& connection) : connection_(connection) {}

  // Numbers of one seed. The layout lives as long as the NumberStore, the numbers until the next visit.
  struct Entry {
    int seed;
    bool has_jammed;
    const NumberLayout& layout;
    std::span<const double> numbers;
  };
  // Visits the seeds below `end` that have numbers, in their order. Throws IntegrityError.
  using Visit = std::function<void(const Entry& entry)>;
  void for_each(std::int64_t point, int end, const Visit& visit);

  // Returns how each of the point's seeds ended; the index is the seed. A seed without numbers is lost.
  // Throws IntegrityError.
  std::vector<std::optional<Outcome>> outcomes(std::int64_t point);

  // True if the stored numbers of the seed equal those of this result, bit by bit.
  bool agrees(std::int64_t point, int seed, const Json& result, const std::vector<std::string>& observables);

 private:
  const NumberLayout& layout(std::int64_t id);
  // Reads the numbers of a seed into numbers_.
  void read(const NumberLayout& layout, int seed, std::string_view text);

  Connection& connection_;
  std::map<std::int64_t, NumberLayout> layouts_;
  std::vector<double> numbers_;
};

}  // namespace peclet::runner
