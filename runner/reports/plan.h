// Estimates what a campaign may cost, and predicts its cost from pilot seeds.
#pragma once

#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/campaign/campaign.h"
#include "runner/statistics/forecast.h"

namespace peclet::runner {

// The mean cost of the ended realisations of a point.
struct MeasuredCost {
  int count = 0;
  double cpu_seconds = 0;  // of one realisation
  double wall_seconds = 0;
};

// The costs and outcomes of a point in the database.
struct PointHistory {
  MeasuredCost cost;
  std::vector<std::optional<Outcome>> outcomes{};  // empty if they are of another observable
};

struct PointPlan {
  std::string label;
  double particle_steps = 0;  // of one realisation
  MeasuredCost cost;          // cpu_seconds is NaN if unknown; with count 0 it is scaled from other points
  int ended = 0;              // seeds of the deciding stop test, or all ended ones
  std::optional<StopTest> decided{};
  Prediction prediction{};  // of an undecided point
  // Processor time in flow over that for the same error at rest, if the engine derives flow_over_rest.
  std::optional<double> flow_over_rest{};

  // Returns false for a point that is decided or has an obstacle.
  bool is_predicted() const;
  // Returns the reason why there is no prediction; "" for a point that has one or is decided.
  std::string obstacle() const;
};

/// The sums over the points that are predicted or decided. The wall time to come is
///   max(sum over the points of (seeds to come * wall time of a seed) / (workers * capacity),
///       max over the points of (rounds_until() the last stop test * wall time of a seed)),
/// because a stop test waits for all its seeds. Its range includes machine_allowance.
struct Totals {
  int points = 0, predicted = 0, likely_capped = 0;
  Expected<double> seeds, cpu_seconds, cpu_seconds_to_come, wall_seconds_to_come;
};

// The guessed cost of a realisation of one point, if none has ended: see scene_check.h.
struct CostGuess {
  std::size_t point = 0;  // place in the sweep
  double seconds = 0;     // wall time
};

struct Plan {
  std::string campaign;
  int minimum = 0, maximum = 0;  // seeds of a point
  int workers = 1;
  int capacity = 1;  // realisations that each worker runs at once
  std::time_t made_at = 0;
  std::vector<PointPlan> points{};
  Totals totals{};
  std::vector<std::string> broke_off{};  // trials that ended early: "peclet=10 broke off: packing: ..."
  int values_to_choose = 0;    // of the curves' axis, which the run may add; they are not in this plan
  std::string over{};          // pointer of that axis
  std::string guessed_from{};  // label of the point whose guess all costs come from; "" without one
};

// Returns the plan. A point without ended realisations has the time per particle-step of all others together,
// or that of the guess if no point has any. `known` has the points by hash.
Plan make_plan(const Campaign& campaign, const std::vector<double>& particle_steps,
               const std::map<std::string, PointHistory>& known, int workers,
               const std::optional<CostGuess>& guess = {}, int capacity = 1);

std::string plan_text(const Plan& plan);
Json plan_json(const Plan& plan);

}  // namespace peclet::runner
