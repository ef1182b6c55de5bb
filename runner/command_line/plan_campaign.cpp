#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "contract/errors.h"
#include "runner/campaign/campaign_file.h"
#include "runner/command_line/print.h"
#include "runner/command_line/run.h"
#include "runner/engines/scene_check.h"
#include "runner/reports/plan.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/point_store.h"

namespace peclet::runner {
namespace {

// Returns the mean cost of a realisation. Running seeds count, because seeds that jam end first.
MeasuredCost cost_of(const std::vector<RealisationRecord>& realisations,
                     const std::vector<Unfinished>& running) {
  std::vector<double> wall_seconds;
  double cpu_seconds = 0;
  for (const RealisationRecord& record : realisations) {
    // The time of a seed that was given up is unknown.
    if (!record.cpu_seconds) continue;
    cpu_seconds += *record.cpu_seconds;
    wall_seconds.push_back(record.wall_seconds.value_or(*record.cpu_seconds));
  }
  const Cost wall(std::move(wall_seconds));
  if (wall.count() == 0) return {};
  const double seconds = mean_cost(wall, running);
  return {wall.count(), wall.sum() > 0 ? cpu_seconds * seconds / wall.sum() : cpu_seconds / wall.count(),
          seconds};
}

std::map<std::string, PointHistory> history(Database& database, const Campaign& campaign) {
  const bool sees_the_same = database.campaign().target.target.observables() == campaign.target.observables();
  std::map<std::string, PointHistory> known;
  std::map<std::int64_t, std::vector<Unfinished>> unfinished = database.unfinished();
  for (const PointRecord& point : database.points()) {
    PointHistory& of = known[point.hash];
    of.cost = cost_of(database.realisations(point.id), unfinished[point.id]);
    if (sees_the_same) of.outcomes = database.outcomes(point.id);
  }
  return known;
}

// True if the database still has the points and the target of this campaign; both may change during a pilot.
bool is_of(Database& database, const Campaign& campaign) {
  if (database.campaign().target.target != campaign.target) return false;
  const std::vector<PointRecord> points = database.points();
  return std::equal(points.begin(), points.end(), campaign.points.begin(), campaign.points.end(),
                    [](const PointRecord& stored, const auto& point) { return stored.hash == point.hash; });
}

void store_predictions(const Plan& plan, Database& database) {
  Transaction booking(database.connection());
  const std::vector<PointRecord> points = database.points();
  for (std::size_t place = 0; place < points.size(); ++place) {
    const PointPlan& point = plan.points.at(place);
    if (!point.is_predicted()) continue;
    PointStore(database).store_prediction(points[place].id, point.prediction, point.cost.cpu_seconds);
  }
  booking.commit();
}

void tell(const Plan& plan, bool json) { print(json ? plan_json(plan).dump(2) + '\n' : plan_text(plan)); }

std::vector<double> work_of(const std::vector<SceneAnswer>& scenes) {
  std::vector<double> work;
  work.reserve(scenes.size());
  for (const SceneAnswer& answer : scenes)
    work.push_back(answer.steps * static_cast<double>(answer.particles));
  return work;
}

// Tries a realisation of the point with the median work and returns its cost. If that fails, as one that
// jams, tries points with less or more work. `broke_off` gets the reasons. Returns nothing if all fail.
std::optional<CostGuess> guess_cost(const Campaign& campaign, const std::vector<double>& work,
                                    const EngineCommand& command, std::vector<std::string>& broke_off) {
  std::vector<std::size_t> order(work.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(work[a], a) < std::pair(work[b], b); });
  const auto last = static_cast<double>(order.size() - 1);
  std::set<std::size_t> tried;
  for (const double share : {0.5, 0.25, 0.0, 0.75, 1.0}) {
    const std::size_t place = order[static_cast<std::size_t>(std::lround(share * last))];
    if (!tried.insert(place).second) continue;
    const StatePoint& point = campaign.points.at(place);
    const CostTrial trial = try_cost(point.scene, command, campaign.maximum_realisations);
    if (trial.seconds) return CostGuess{place, *trial.seconds};
    if (!trial.broke_off.empty()) broke_off.push_back(point.label + " broke off: " + trial.broke_off);
  }
  return std::nullopt;
}

Plan plan_of(const Campaign& campaign, const std::vector<SceneAnswer>& scenes,
             const std::map<std::string, PointHistory>& known, const RunOptions& options,
             const std::optional<CostGuess>& guess = {}) {
  const int capacity = scenes.empty() ? 1 : scenes.front().capacity;
  Plan plan = make_plan(campaign, work_of(scenes), known, worker_count(options).workers, guess, capacity);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Json found = scenes[i].derived.value("flow_over_rest", Json());
    if (found.is_number()) plan.points.at(i).flow_over_rest = found.get<double>();
  }
  plan.made_at = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return plan;
}

}  // namespace

int plan_campaign(const PlanOptions& options) {
  choose_device(options.run.device);
  const std::filesystem::path& file = options.run.campaign;
  const Campaign campaign = read_campaign(file);
  if (options.pilot && (*options.pilot < 2 || *options.pilot > campaign.minimum_realisations)) {
    throw InputError("--pilot", "", fmt::format("{}", *options.pilot),
                     fmt::format("must be an integer from 2 to /realisations{} of {}, {}",
                                 campaign.target.has_tolerance() ? "/minimum" : "", file.string(),
                                 campaign.minimum_realisations));
  }
  if (options.pilot) {
    return run_pilot(options.run, *options.pilot, [&](const ClaimedCampaign& claimed, Database& database) {
      if (!is_of(database, claimed.campaign)) {
        fmt::print(
            stderr,
            "peclet: {0}: the campaign was changed while the pilot ran. Its results are stored, but no "
            "prediction; `peclet plan {1}` predicts from these results\n",
            file.string(), words_for(file, options.run.directory));
        return;
      }
      const Plan plan =
          plan_of(claimed.campaign, claimed.scenes, history(database, claimed.campaign), options.run);
      store_predictions(plan, database);
      tell(plan, options.json);
    });
  }
  const CampaignDirectory directory = campaign_directory(file, options.run.directory);
  std::map<std::string, PointHistory> known;
  if (std::filesystem::exists(directory.database())) {
    Database database = Database::open_reader(directory.database());
    known = history(database, campaign);
  }
  const EngineCommand command = resolve_engine(campaign, file);
  const std::vector<SceneAnswer> scenes = check_scenes(campaign, file, command);
  std::optional<CostGuess> guess;
  std::vector<std::string> broke_off;
  const bool has_cost =
      std::any_of(known.begin(), known.end(), [](const auto& point) { return point.second.cost.count > 0; });
  if (!has_cost) guess = guess_cost(campaign, work_of(scenes), command, broke_off);
  Plan plan = plan_of(campaign, scenes, known, options.run, guess);
  plan.broke_off = std::move(broke_off);
  tell(plan, options.json);
  return 0;
}

}  // namespace peclet::runner
