// The parts of the page's document.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/database/database.h"
#include "runner/reports/status.h"
#include "runner/statistics/quantity_estimates.h"

namespace peclet::runner {

// What the first result of a point says of it: dimensionless groups, and what the engine warns of; null
// without one.
struct FirstResult {
  Json groups, warnings;
};

// A number of the results that can be drawn: a quantity, or one of its elements.
struct Drawable {
  std::string path;     // "pressure", "stress/total/3"
  std::string name;     // of the quantity
  std::string element;  // "xy"; "" of a quantity that is one number
  std::string symbol, unit;
};

// The points with their estimates of every drawable, in step with `drawables`.
struct PagePoints {
  std::vector<Drawable> drawables;
  Json points = Json::array();
  std::vector<FirstResult> first;
};
PagePoints page_points(Database& database, const CampaignStatus& status);

// Points decided, processor time spent and to go, workers.
Json page_progress(Database& database, const CampaignStatus& status);

// What the sweep sets, and what all points share of the scene, with what the schema says of each.
Json page_parameters(const CampaignStatus& status);
Json page_scene(const CampaignStatus& status);

// What each verdict and mark that is used means.
Json page_meanings(const CampaignStatus& status);

// Pairs of a term and what it is, and the commands that make the numbers again.
Json page_provenance(Database& database, const CampaignStatus& status, const std::string& results_sha256);
std::string page_commands(const CampaignStatus& status, const std::string& results_sha256);

}  // namespace peclet::runner
