// The ledger's part in what a run may do: how many seeds, for how much processor time, and what they cost.
#include <utility>

#include "runner/owner/ledger.h"

namespace peclet::runner {

void Ledger::set_bounds(Bounds bounds) {
  bounds_ = std::move(bounds);
  apply_bounds();
}

void Ledger::apply_bounds() {
  scheduler_->set_allocation(bounds_.budget_seconds ? Allocation::steepest_first : Allocation::longest_first);
  scheduler_->set_ceiling(bounds_.ceiling.value_or(campaign_.maximum_realisations));
  // A point whose work is not known is taken for an average one.
  double all = 0;
  for (const auto& [hash, work] : bounds_.work) all += work;
  const double average = bounds_.work.empty() ? 1 : all / static_cast<double>(bounds_.work.size());
  for (int place = 0; place < scheduler_->points(); ++place) {
    const auto known = bounds_.work.find(point(place).hash);
    scheduler_->set_work(place, known == bounds_.work.end() ? average : known->second);
    tell_cost(place);
  }
}

// Workers are occupied for the wall time of a seed; a budget is of processor time.
void Ledger::tell_cost(int place) {
  const Costs& costs = costs_[static_cast<std::size_t>(place)];
  const Cost& cost = bounds_.budget_seconds ? costs.processor : costs.wall;
  if (cost.count > 0) scheduler_->set_cost(place, cost.sum / cost.count);
}

void Ledger::add_cost(int place, std::optional<double> wall_seconds, std::optional<double> cpu_seconds) {
  Costs& costs = costs_[static_cast<std::size_t>(place)];
  if (wall_seconds) costs.wall.add(*wall_seconds);
  if (cpu_seconds) costs.processor.add(*cpu_seconds);
}

std::optional<double> Ledger::wall_seconds(const Grant& grant) const {
  if (grant.id.point == nowhere) return std::nullopt;
  const Cost& cost = costs_.at(static_cast<std::size_t>(grant.id.point)).wall;
  return cost.count > 0 ? std::optional(cost.sum / cost.count) : std::nullopt;
}

std::optional<SeedId> Ledger::next() const {
  if (!bounds_.budget_seconds) return scheduler_->next();
  return scheduler_->next_within(*bounds_.budget_seconds - spent_seconds_ -
                                 scheduler_->expected_seconds(running_));
}

}  // namespace peclet::runner
