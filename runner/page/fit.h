// `peclet fit`: the laws of python/peclet/laws.py, fitted to the points of a campaign.
//
// The numbers are those of figure_data(). The fits and the texts are in python/peclet/laws.py and
// laws_report.py, which runs as a child (package_module.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct FitChoice {
  std::string law;                 // one of law_names()
  std::string quantity;            // "": that of the law, or the campaign's target
  std::string over;                // "": that of the law, or as in chosen_axis()
  std::vector<std::string> fixed;  // "NAME=VALUE": parameters that are not fitted
  std::vector<std::string> free;   // names of parameters that are fitted, although the law has a value
  std::optional<double> from, to;  // range of the axis
};

std::vector<std::string> law_names();

struct FitAnswer {
  std::string text;  // for people, or JSON
  Json figure;       // for figure_script(); null if no curve determines the law
};

// Throws InputError for options that do not suit the law, and as figure_data(); std::runtime_error if the
// fits cannot run.
FitAnswer fit_law(Database& database, const FitChoice& choice, bool in_json);

}  // namespace peclet::runner
