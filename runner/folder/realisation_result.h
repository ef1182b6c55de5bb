// The result of one realisation as an engine wrote it: checked, and what the runner takes from it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "contract/endings.h"
#include "contract/json.h"
#include "runner/folder/result_shape.h"

namespace peclet::runner {

struct RealisationResult {
  Json document;  // whole
  std::string point;
  int seed = 0;
  std::string cause;           // of the ending: "completed", "overlap", ...
  std::string engine;          // engine_identity()
  std::string content_sha256;  // of what repetitions must share
  bool completed() const { return has_results(cause); }
};

// Throws ResultError naming what is wrong.
RealisationResult parse_result(std::string_view text);

struct Observed {
  std::optional<double> value;    // of the observable; none after a blow-up, or where it does not exist
  std::optional<double> control;  // variate of mean zero that belongs to it
  // value + control over the first quarter and the first half of the window; none without such blocks
  std::optional<double> first_quarter{}, first_half{};
  bool is_share = false;  // the value is 0 or 1 by its nature
};

// Warning codes of a completed result, without those that the scene alone implies ("inertia-..."), which
// `validate` shows.
std::set<std::string> flags_of(const RealisationResult& result);

// The cause of a completed realisation that has no number for the campaign's observable: it is lost to its
// point as one that blew up is.
inline constexpr const char* no_value = "no-value";

// Whether the means have the observable, if only as null, which says that it does not exist for this
// realisation.
bool has_observable(const Json& mean, const std::string& observable);

// `observable` is the path of a number in "mean": see runner/statistics/quantities.h. Its control variate is
// the one that the result names.
Observed observe(const Json& result, const std::string& observable);

// value + control in each block of the window, in order of time; NaN in a block without a sample, nothing
// where the result has no blocks of the observable. A control variate that has no blocks is left out.
std::vector<double> block_values(const Json& result, const std::string& observable);

// What observe() gives, of several observables.
std::vector<Observed> observe(const Json& result, const std::vector<std::string>& observables);

// The first of the observables that the means of a completed result do not have; "" when they have all.
std::string lacking_in(const Json& result, const std::vector<std::string>& observables);

// How the realisation counts for a campaign that has seen this in it.
std::string cause_of(const RealisationResult& result, const Observed& observed);

}  // namespace peclet::runner
