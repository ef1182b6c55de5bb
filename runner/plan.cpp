#include "runner/plan.h"

#include <fmt/format.h>

#include <cmath>

#include "runner/campaign_directory.h"
#include "runner/database_summary.h"
#include "runner/number_text.h"
#include "runner/point_columns.h"
#include "runner/scene_check.h"
#include "runner/text_table.h"

namespace peclet::runner {
namespace {

constexpr double seconds_per_hour = 3600;

double hours(const PointPlan& point, int seeds) { return point.cost.cpu_seconds * seeds / seconds_per_hour; }

double total_hours(const Plan& plan, int seeds) {
  double total = 0;
  for (const PointPlan& point : plan.points) total += hours(point, seeds);
  return total;
}

std::string cost_text(const MeasuredCost& cost) {
  if (std::isnan(cost.cpu_seconds)) return "-";
  return cost.count > 0 ? fmt::format("{} ({})", rough(cost.cpu_seconds), cost.count)
                        : "~" + rough(cost.cpu_seconds);
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::map<std::string, MeasuredCost> measured_costs(const CampaignDirectory& directory) {
  std::map<std::string, MeasuredCost> measured;
  if (!std::filesystem::exists(directory.database())) return measured;
  Database database = Database::open_reader(directory.database());
  for (const PointSummary& point : summarise_points(database, database.campaign().target)) {
    // A seed that was given up took time too, but nobody counted it.
    const int count = point.counts.done + point.counts.failed;
    if (count > 0) measured[point.point.hash] = {count, point.counts.cpu_seconds / count};
  }
  return measured;
}

}  // namespace

Plan make_plan(const Campaign& campaign, const std::vector<double>& particle_steps,
               const std::map<std::string, MeasuredCost>& measured) {
  Plan plan{campaign.name, campaign.minimum_realisations, campaign.maximum_realisations, {}};
  double known_seconds = 0, known_steps = 0;
  for (std::size_t i = 0; i < campaign.points.size(); ++i) {
    PointPlan point{campaign.points[i].label, particle_steps[i], {}};
    const auto found = measured.find(campaign.points[i].hash);
    if (found != measured.end()) {
      point.cost = found->second;
      known_seconds += point.cost.cpu_seconds * point.cost.count;
      known_steps += point.particle_steps * point.cost.count;
    }
    plan.points.push_back(point);
  }
  for (PointPlan& point : plan.points) {
    if (point.cost.count == 0) {
      point.cost.cpu_seconds =
          known_steps > 0 ? known_seconds / known_steps * point.particle_steps : std::nan("");
    }
  }
  return plan;
}

std::string plan_text(const Plan& plan) {
  std::vector<std::string> labels;
  for (const PointPlan& point : plan.points) labels.push_back(point.label);
  const PointColumns columns(labels);
  TextTable table;
  columns.add_to(table);
  table.add_column("particle-steps/seed");
  table.add_column("CPU s/seed");
  table.add_column(fmt::format("CPU h, {} seeds", plan.minimum));
  table.add_column(fmt::format("CPU h, {} seeds", plan.maximum));
  double steps = 0;
  const auto add_row = [&](std::vector<std::string> row, const std::vector<std::string>& rest) {
    row.insert(row.end(), rest.begin(), rest.end());
    table.add_row(std::move(row));
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const PointPlan& point = plan.points[i];
    add_row(columns.cells(i), {rough(point.particle_steps), cost_text(point.cost),
                               rough(hours(point, plan.minimum)), rough(hours(point, plan.maximum))});
    steps += point.particle_steps;
  }
  std::vector<std::string> all(columns.count());
  all.front() = "all";
  add_row(all,
          {rough(steps), "", rough(total_hours(plan, plan.minimum)), rough(total_hours(plan, plan.maximum))});
  const bool unknown = std::isnan(total_hours(plan, 1));
  return fmt::format("{}: {} points, {} to {} seeds each\n\n{}\n{}", plan.campaign, plan.points.size(),
                     plan.minimum, plan.maximum, table.text(),
                     unknown
                         ? "-: not known before a seed has ended\n"
                         : "CPU seconds per seed: mean (of so many seeds); ~: scaled from other points by "
                           "particle-steps\n");
}

Json plan_json(const Plan& plan) {
  Json points = Json::array();
  for (const PointPlan& point : plan.points) {
    points.push_back({{"label", point.label},
                      {"particle_steps", point.particle_steps},
                      {"measured_seeds", point.cost.count},
                      {"cpu_seconds_per_seed", number(point.cost.cpu_seconds)},
                      {"cpu_hours_minimum", number(hours(point, plan.minimum))},
                      {"cpu_hours_maximum", number(hours(point, plan.maximum))}});
  }
  return {{"schema_version", 1},
          {"campaign", plan.campaign},
          {"realisations", {{"minimum", plan.minimum}, {"maximum", plan.maximum}}},
          {"points", points},
          {"cpu_hours_minimum", number(total_hours(plan, plan.minimum))},
          {"cpu_hours_maximum", number(total_hours(plan, plan.maximum))}};
}

std::string plan_campaign(const PlanOptions& options) {
  const Campaign campaign = read_campaign(options.campaign);
  std::vector<double> particle_steps;
  for (const SceneAnswer& answer :
       check_scenes(campaign, options.campaign, resolve_engine(campaign, options.campaign))) {
    particle_steps.push_back(answer.steps * static_cast<double>(answer.particles));
  }
  const Plan plan = make_plan(campaign, particle_steps,
                              measured_costs(campaign_directory(options.campaign, options.directory)));
  return options.json ? plan_json(plan).dump(2) + '\n' : plan_text(plan);
}

}  // namespace peclet::runner
