// What is in the results of a point and in no column of the database: the course of the target within the
// window, and profiles and distributions.
#pragma once

#include "contract/json.h"
#include "runner/statistics/cohorts.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Results are read whole, some milliseconds each, so that of a point with very many seeds the first ones
// stand for all.
constexpr int most_detailed_seeds = 64;

// {"seeds": how many results it is made of, "of": how many the estimate of the point is made of, "blocks",
// null without: {"mean", "half_width"}, "profiles": [{"name", "symbol", "unit", "axis": {"name", "unit",
// "values"}, "mean", "standard_error", "half_width"}]}: means over the first `seeds` results below the seed
// `end`, half-widths at the level of the target. Profiles are quantities over one axis of numbers; a longer
// one than 400 numbers is thinned.
Json point_details(Database& database, std::int64_t point, int end, const TargetRecord& target, int seeds);

}  // namespace peclet::runner
