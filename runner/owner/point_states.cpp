#include "runner/owner/point_states.h"

#include <algorithm>
#include <utility>

namespace peclet::runner {

void PointStates::read_points(Database& database) {
  points_ = database.points();
  places_.clear();
  for (const PointRecord& known : points_) places_[known.hash] = *known.place;
}

void PointStates::read_seeds(Database& database, const Campaign& campaign) {
  std::vector<std::vector<std::optional<Outcome>>> outcomes;
  std::vector<SeedId> out;
  processor_.assign(points_.size(), {});
  forecasts_.assign(points_.size(), {});
  running_.assign(points_.size(), 0);
  maximum_ = campaign.maximum_realisations;
  for (const PointRecord& known : points_) {
    outcomes.push_back(database.outcomes(known.id));
    std::vector<double> wall, processor;
    for (const RealisationRecord& record : database.realisations(known.id)) {
      if (record.wall_seconds) wall.push_back(*record.wall_seconds);
      if (record.cpu_seconds) processor.push_back(*record.cpu_seconds);
      if (record.state == SeedState::running) out.push_back({*known.place, record.seed});
    }
    const auto place = static_cast<std::size_t>(*known.place);
    forecasts_[place].cost = Cost(std::move(wall));
    processor_[place] = Cost(std::move(processor));
  }
  scheduler_.emplace(std::move(outcomes), campaign.target, campaign.minimum_realisations, maximum_,
                     campaign.curves);
  for (const PointRecord& known : points_) {
    scheduler_->set_priority(*known.place, known.priority);
    scheduler_->set_cancelled(*known.place, known.cancelled);
  }
  for (const SeedId id : out) {
    // A seed beyond the maximum (it was larger once) has no part in the stop tests.
    if (id.seed < maximum_) begin(id);
  }
  apply_bounds();
}

void PointStates::set_bounds(Bounds bounds) {
  bounds_ = std::move(bounds);
  apply_bounds();
}

void PointStates::apply_bounds() {
  scheduler_->set_allocation(bounds_.budget_seconds ? Allocation::steepest_first : Allocation::longest_first);
  scheduler_->set_ceiling(bounds_.ceiling.value_or(maximum_));
  // A point of unknown work counts as an average one.
  double all = 0;
  for (const auto& [hash, work] : bounds_.work) all += work;
  const double average = bounds_.work.empty() ? 1 : all / static_cast<double>(bounds_.work.size());
  for (const PointRecord& about : points_) {
    const auto known = bounds_.work.find(about.hash);
    scheduler_->set_work(*about.place, known == bounds_.work.end() ? average : known->second);
    tell_cost(*about.place);
  }
}

std::optional<int> PointStates::place_of(const std::string& hash) const {
  const auto known = places_.find(hash);
  return known == places_.end() ? std::nullopt : std::optional(known->second);
}

std::optional<int> PointStates::place_of(std::int64_t point_id) const {
  const auto known = std::find_if(points_.begin(), points_.end(),
                                  [&](const PointRecord& about) { return about.id == point_id; });
  return known == points_.end() ? std::nullopt : known->place;
}

void PointStates::add_cost(int place, double wall_seconds, double cpu_seconds) {
  forecasts_[static_cast<std::size_t>(place)].cost.add(wall_seconds);
  processor_[static_cast<std::size_t>(place)].add(cpu_seconds);
  tell_cost(place);
}

void PointStates::begin(SeedId id) {
  scheduler_->begin(id);
  ++running_[static_cast<std::size_t>(id.point)];
}

// A budget limits processor time; without one, the wall time of seeds decides how long workers are busy.
void PointStates::tell_cost(int place) {
  const auto number = static_cast<std::size_t>(place);
  const Cost& cost = bounds_.budget_seconds ? processor_[number] : forecasts_[number].cost;
  if (cost.count() > 0) scheduler_->set_cost(place, cost.mean());
}

std::optional<double> PointStates::wall_seconds(int place) const {
  const Cost& cost = forecasts_.at(static_cast<std::size_t>(place)).cost;
  return cost.count() > 0 ? std::optional(cost.mean()) : std::nullopt;
}

std::optional<TimeToGo> PointStates::to_go(std::map<std::int64_t, std::vector<Unfinished>> unfinished,
                                           const Campaign& campaign, int workers) {
  for (int place = 0; place < size(); ++place) {
    PointForecast& known = forecasts_[static_cast<std::size_t>(place)];
    known.all_seeds = scheduler_->all_seeds(place);
    known.ended = scheduler_->all_ended(place);
    known.running = scheduler_->begun(place) - known.ended;
    known.decided = scheduler_->decided(place) || scheduler_->cancelled(place);
    known.unfinished = std::move(unfinished[point(place).id]);
  }
  return time_to_go(forecasts_, expected_stops(campaign), campaign.minimum_realisations,
                    campaign.maximum_realisations, workers, !campaign.curves.empty());
}

const std::vector<Expected<int>>& PointStates::expected_stops(const Campaign& campaign) {
  std::vector<std::size_t> judged;
  for (int place = 0; place < size(); ++place) {
    const bool is_done = forecasts_[static_cast<std::size_t>(place)].decided;
    judged.push_back(scheduler_->stop_tests(place).size() + (is_done ? 1 : 0));
  }
  if (campaign.curves.empty() || judged != judged_) {
    stops_ = runner::expected_stops(forecasts_, campaign.target, campaign.minimum_realisations,
                                    campaign.maximum_realisations, campaign.curves);
    judged_ = std::move(judged);
  }
  return stops_;
}

}  // namespace peclet::runner
