#include "runner/database/checked_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace peclet::runner {

namespace {

// NaN: does not exist, or is beyond what a number can be.
bool is_same(double one, double other) { return one == other || (std::isnan(one) && std::isnan(other)); }

bool agree(const std::vector<ObservableLook>& stored, const std::vector<ObservableLook>& replayed,
           bool is_of_an_earlier_rule) {
  return std::equal(stored.begin(), stored.end(), replayed.begin(), replayed.end(),
                    [&](const ObservableLook& one, const ObservableLook& other) {
                      return one.observable == other.observable &&
                             (is_of_an_earlier_rule || one.verdict == other.verdict) &&
                             one.estimate.count == other.estimate.count &&
                             is_same(one.estimate.mean, other.estimate.mean);
                    });
}

// An earlier rule gave other verdicts of the same estimates.
bool agrees(const Look& stored, const Look& replayed, bool is_of_an_earlier_rule) {
  return agree(stored.each, replayed.each, is_of_an_earlier_rule) && stored.seeds == replayed.seeds &&
         stored.lost == replayed.lost && (is_of_an_earlier_rule || stored.verdict == replayed.verdict) &&
         stored.estimate.count == replayed.estimate.count &&
         (stored.estimate.count == 0 || (is_same(stored.estimate.mean, replayed.estimate.mean) &&
                                         is_same(stored.controlled.mean, replayed.controlled.mean)));
}

}  // namespace

std::optional<Look> checked_look(Database& database, const PointRecord& point, const TargetRecord& target) {
  const std::vector<LookRecord> stored = database.looks(point.id);
  const bool is_of_an_earlier_rule = target.target.rule != Target::newest_rule;
  const std::vector<Look> replayed =
      replay_looks(database.outcomes(point.id), target.target, target.minimum, target.maximum);
  // An owner that was killed between a result and its look leaves fewer looks than there could be.
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (i < replayed.size() && agrees(stored[i].look, replayed[i], is_of_an_earlier_rule)) continue;
    throw IntegrityError(
        fmt::format("{}: the stored look at {} seeds of {} is not what the stored results say; "
                    "if an earlier version made it, `peclet run` looks again",
                    database.connection().path(), stored[i].look.seeds, point.label));
  }
  if (stored.empty()) return std::nullopt;
  Look look = stored.back().look;
  const Look& made_again = replayed[stored.size() - 1];
  look.untested = made_again.untested;
  look.near_maximum = made_again.near_maximum && is_reached(look.verdict);
  look.repeated = made_again.repeated;
  return look;
}

}  // namespace peclet::runner
