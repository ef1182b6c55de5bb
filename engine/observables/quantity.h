// What is measured: the description that goes into the result with the numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::engine {

struct Axis {
  std::string name, unit;  // "1": a pure number
  Json values;             // numbers or words, one for each entry of the list
};

// A ratio of means: the quantity's object in the result has two members of these names, each a mean (or a
// sum over the window) that is averaged over the seeds before it is divided. One of the two may be a single
// number where the other one has axes.
struct RatioOfMeans {
  std::string numerator, denominator;
};

struct Quantity {
  std::string name;          // its path in the result's "mean" (and "blocks"): "pressure", "stress/total"
  std::string symbol, unit;  // "1": a pure number
  std::vector<Axis> axes{};  // none: a scalar; otherwise lists within lists, the first axis outermost
  std::optional<RatioOfMeans> ratio{};  // absent: its values are means
  bool is_share = false;                // a scalar that is 0 or 1 in each realisation
};

Json to_json(const Quantity& quantity);

// Names of the numbers of a quantity at which a campaign may aim: of a scalar its own, of others "NAME/*"
// with a star for the index of each axis. None of a ratio: it is no mean over seeds.
std::vector<std::string> targets_in(const Quantity& quantity);

}  // namespace peclet::engine
