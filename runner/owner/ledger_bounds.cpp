// The ledger's part in what a run may do: how many seeds, and for how much processor time.
#include <utility>

#include "runner/owner/ledger.h"

namespace peclet::runner {

void Ledger::set_bounds(Bounds bounds) { board_.set_bounds(std::move(bounds)); }

std::optional<double> Ledger::wall_seconds(const GivenSeed& given_seed) const {
  return given_seed.id.point == nowhere ? std::nullopt : board_.wall_seconds(given_seed.id.point);
}

std::optional<SeedId> Ledger::next() const {
  const std::optional<double> budget = board_.bounds().budget_seconds;
  if (!budget) return scheduler().next();
  return scheduler().next_within(*budget - spent_seconds() - board_.expected_seconds());
}

}  // namespace peclet::runner
