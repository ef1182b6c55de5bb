// The verb `peclet plan`: what a campaign may cost.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/campaign.h"

namespace peclet::runner {

struct PlanOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;
  bool json = false;
};

// What realisations of a point that have ended took, on the average.
struct MeasuredCost {
  int count = 0;
  double cpu_seconds = 0;  // of one
};

struct PointPlan {
  std::string label;
  double particle_steps = 0;  // of one realisation
  MeasuredCost cost;          // cpu_seconds is NaN when nothing is known; count 0: scaled from other points
};

struct Plan {
  std::string campaign;
  int minimum = 0, maximum = 0;  // seeds of a point
  std::vector<PointPlan> points;
};

// A point without a realisation of its own is taken to need as much time per particle-step as all the others
// together. Points are matched with `measured` by hash.
Plan make_plan(const Campaign& campaign, const std::vector<double>& particle_steps,
               const std::map<std::string, MeasuredCost>& measured);

std::string plan_text(const Plan& plan);
Json plan_json(const Plan& plan);

// Asks the engine how long the realisations are, and the database, if there is one, what they cost.
std::string plan_campaign(const PlanOptions& options);

}  // namespace peclet::runner
