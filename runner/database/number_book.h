// The few numbers of each result (number_layout.h) in a table of their own: means of any quantity over all
// seeds of a point take a reader a thousandth of the time that the results would take.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "runner/database/sqlite.h"
#include "runner/statistics/number_layout.h"

namespace peclet::runner {

// Stores those of a completed result that has none yet; of another result nothing. Inside a Transaction of
// the caller.
void store_numbers(Connection& connection, std::int64_t point, int seed, const Json& result);

class NumberBook {
 public:
  // The connection must outlive it.
  explicit NumberBook(Connection& connection) : connection_(connection) {}

  // The numbers of one seed. The layout lives as long as the book.
  struct Entry {
    int seed;
    bool has_jammed;
    const NumberLayout& layout;
    std::span<const double> numbers;
  };
  // Visits the entries of the seeds below `end`, in their order. Throws IntegrityError.
  using Visit = std::function<void(const Entry& entry)>;
  void for_each(std::int64_t point, int end, const Visit& visit);

  // Whether what is stored of the seed are the numbers of this result, bit by bit.
  bool agrees(std::int64_t point, int seed, const Json& result);

 private:
  const NumberLayout& layout(std::int64_t id);

  Connection& connection_;
  std::map<std::int64_t, NumberLayout> layouts_;
};

}  // namespace peclet::runner
