// What a campaign may cost, and with a pilot what it will.
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

// What realisations of a point that have ended took, on the average.
struct MeasuredCost {
  int count = 0;
  double cpu_seconds = 0;  // of one
  double wall_seconds = 0;
};

// What the database knows of a point.
struct PointHistory {
  MeasuredCost cost;
  std::vector<std::optional<Outcome>> outcomes{};  // of the campaign's observable, else none
};

struct PointPlan {
  std::string label;
  double particle_steps = 0;  // of one realisation
  MeasuredCost cost;          // cpu_seconds is NaN when nothing is known; count 0: scaled from other points
  int ended = 0;              // seeds of the stop tests up to the deciding one, or so far
  std::optional<StopTest> decided{};
  Prediction prediction{};  // of a point that is not decided
  // Processor time over that of the same error at rest, where the engine says so (its derived
  // flow_over_rest).
  std::optional<double> flow_over_rest{};

  // Nothing is expected of a point that is decided, and nothing is known of one with an obstacle.
  bool is_predicted() const;
  // Why there is no prediction, in words; nothing for one that has it or needs none.
  std::string obstacle() const;
};

// Of the points that are predicted or decided, in seconds. What is still to come takes
//   max(sum over the points of seeds to come * wall time of one / workers,
//       the largest sum over the stop tests to come of a point of ceil(seeds of the stop test / workers) *
//       wall time)
// with the workers, since a stop test waits for all its seeds; its range leaves room for a machine whose
// speed changes (machine_allowance).
struct Totals {
  int points = 0, predicted = 0, likely_capped = 0;
  Expected<double> seeds, cpu_seconds, cpu_seconds_to_come, wall_seconds_to_come;
};

// What a realisation of one point may cost where none has ended: see scene_check.h.
struct CostGuess {
  std::size_t point = 0;  // place in the sweep
  double seconds = 0;
};

struct Plan {
  std::string campaign;
  int minimum = 0, maximum = 0;  // seeds of a point
  int workers = 1;
  std::time_t made_at = 0;
  std::vector<PointPlan> points{};
  Totals totals{};
  std::vector<std::string> broke_off{};  // trials that ended early: "peclet=10 broke off: packing: ..."
  std::string guessed_from{};  // label of the point of the guess that all costs come from; "": none does
};

// A point without a realisation of its own is taken to need as much time per particle-step as all the others
// together; without any, as much as the guess says. Points are matched with `known` by hash.
Plan make_plan(const Campaign& campaign, const std::vector<double>& particle_steps,
               const std::map<std::string, PointHistory>& known, int workers,
               const std::optional<CostGuess>& guess = {});

std::string plan_text(const Plan& plan);
Json plan_json(const Plan& plan);

}  // namespace peclet::runner
