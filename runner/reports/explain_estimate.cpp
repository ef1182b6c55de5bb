#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "runner/campaign/number_text.h"
#include "runner/engines/engine_process.h"
#include "runner/reports/explain.h"
#include "runner/statistics/statistics.h"
#include "runner/statistics/window_advice.h"

namespace peclet::runner {
namespace {

// Returns the outcomes of the last stop test that have a value, in the order of their seeds.
std::vector<Outcome> completed(Database& database, const PointSummary& point) {
  const std::vector<std::optional<Outcome>> outcomes = database.outcomes(point.point.id);
  const auto seeds = std::min(outcomes.size(), static_cast<std::size_t>(point.stop_tests.back().seeds));
  std::vector<Outcome> found;
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    if (outcomes[seed] && !outcomes[seed]->is_lost()) found.push_back(*outcomes[seed]);
  }
  return found;
}

std::string interval_text(const StopTest& stop_test, const std::vector<Outcome>& outcomes,
                          const TargetRecord& target) {
  const double level = target.level();
  if (!std::isfinite(stop_test.controlled_half_width)) return "";
  if (stop_test.controlled.values == Estimate::Values::share) {
    const Interval interval = share_interval(stop_test.controlled.count, stop_test.controlled.mean, level);
    return fmt::format(
        "  interval: {} .. {} of the share (Clopper and Pearson); the half-width is its larger side\n",
        rough(interval.low), rough(interval.high));
  }
  std::vector<double> values;
  values.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) values.push_back(outcome.controlled());
  std::string text;
  if (const std::optional<Interval> interval = bootstrap_t(values, level)) {
    text = fmt::format("  interval of {:.3g} %: Student {} .. {}, bootstrap-t {} .. {}; skewness {}\n",
                       100 * level, rough(stop_test.controlled.mean - stop_test.controlled_half_width),
                       rough(stop_test.controlled.mean + stop_test.controlled_half_width),
                       rough(interval->low), rough(interval->high), rough(stop_test.skewness));
  }
  if (is_skewed(stop_test, target.target.confidence)) {
    text += fmt::format(
        "  skewed: some values are far from the rest on one side, and Student's interval holds the mean less "
        "often\n    than it says; trust the bootstrap interval more, and ask for {}\n",
        target.target.has_tolerance() ? "a smaller tolerance or a larger minimum" : "more realisations");
  }
  return text;
}

// Returns the line on the transient of an observable.
std::string contrasts_text(const std::vector<Outcome>& outcomes, std::size_t place, const std::string& name) {
  std::vector<double> quarters, halves;
  for (const Outcome& outcome : outcomes) {
    const Observation observed = outcome.of(place);
    if (!std::isfinite(observed.first_half)) continue;
    quarters.push_back(observed.first_quarter - observed.value - observed.control);
    halves.push_back(observed.first_half - observed.value - observed.control);
  }
  const Estimate quarter = estimate(quarters), half = estimate(halves);
  return fmt::format(
      "  transient: the first quarter of the windows differs from the whole by {}, the first half by {} (± "
      "standard error){}:\n    the window begins too early, and more seeds do not help; lengthen "
      "/scene/duration/equilibration\n",
      with_error(quarter.mean, quarter.standard_error), with_error(half.mean, half.standard_error), name);
}

std::string transient_text(const StopTest& stop_test, const std::vector<Outcome>& outcomes,
                           const Target& target) {
  const std::vector<ObservableStopTest> each = each_of(stop_test, target);
  std::string text, untested;
  for (std::size_t place = 0; place < each.size(); ++place) {
    const std::string& name = each[place].observable;
    if (each[place].untested) untested += (untested.empty() ? "" : ", ") + name;
    if (each[place].transient) text += contrasts_text(outcomes, place, each.size() > 1 ? " for " + name : "");
  }
  if (untested.empty()) return text;
  return text + fmt::format(
                    "  transient: no test was possible, because the results have no blocks of {}: it is "
                    "unknown whether the\n    windows begin before the equilibration is over\n",
                    untested);
}

// Returns the line on the variance of value + control, and on the beta for which value + beta * control has
// the smallest variance.
std::string control_text(const std::vector<Outcome>& outcomes) {
  double value = 0, control = 0;
  const auto count = static_cast<double>(outcomes.size());
  for (const Outcome& outcome : outcomes) {
    value += outcome.value / count;
    control += outcome.control / count;
  }
  double vv = 0, vc = 0, cc = 0;
  for (const Outcome& outcome : outcomes) {
    vv += (outcome.value - value) * (outcome.value - value);
    vc += (outcome.value - value) * (outcome.control - control);
    cc += (outcome.control - control) * (outcome.control - control);
  }
  if (cc == 0 || vv == 0 || count < 3) return "";
  const double best = -vc / cc;
  const double error = std::sqrt(std::max(0.0, vv - vc * vc / cc) / (count - 2) / cc);
  return fmt::format(
      "  control variate: the variance is {} times that without it; its coefficient is 1, and the best one "
      "for these seeds is {}\n",
      rough((vv + 2 * vc + cc) / vv), with_error(best, error));
}

std::string window_text(Database& database, const PointSummary& point, const std::vector<Outcome>& outcomes) {
  std::vector<WindowHalves> halves;
  for (const Outcome& outcome : outcomes) {
    if (!std::isfinite(outcome.first_half)) continue;
    halves.push_back({outcome.first_half, 2 * (outcome.value + outcome.control) - outcome.first_half});
  }
  const MeanSteps cost = database.mean_steps(point.point.id);
  const std::optional<WindowAdvice> advice = advise_window(halves, cost.equilibration, cost.production);
  if (!advice) return "";
  // The advice must hold at the end of the correlation's interval that is least favourable to it.
  std::string conclusion = "its length is about right, as far as these seeds can tell";
  if (advice->half_as_long * (1 + advice->correlation) / (1 + advice->low) < 0.9) {
    conclusion = "shorter windows and more seeds are cheaper";
  }
  if (advice->twice_as_long_at_best * (1 + std::max(advice->high, 0.0)) < 0.9) {
    conclusion = "longer windows are cheaper than more seeds";
  }
  std::string longer = fmt::format("{:.2f}", advice->twice_as_long_at_best);
  const std::string at_worst = fmt::format("{:.2f}", advice->twice_as_long_at_worst);
  if (at_worst != longer) longer += " to " + at_worst;
  return fmt::format(
      "  window: {}; its halves correlate by {:.2f} ({:.2f} .. {:.2f}), equilibration is {:.0f} % of a "
      "realisation;\n"
      "    for the same error half the window takes {:.2f} times the processor time, twice the window {}\n",
      conclusion, advice->correlation, advice->low, advice->high,
      100 * cost.equilibration / (cost.equilibration + cost.production), advice->half_as_long, longer);
}

}  // namespace

std::string estimate_text(Database& database, const PointSummary& point, const TargetRecord& target) {
  if (point.stop_tests.empty()) return "";
  const StopTest& stop_test = point.stop_tests.back();
  const std::vector<Outcome> outcomes = completed(database, point);
  return interval_text(stop_test, outcomes, target) + transient_text(stop_test, outcomes, target.target) +
         control_text(outcomes) + window_text(database, point, outcomes);
}

namespace {

// Returns the recorded message, or how the process ended.
std::string account(const AttemptRecord& attempt) {
  if (!attempt.message.empty()) return ": " + attempt.message;
  if (!attempt.exit_status && !attempt.signal) return "";
  ExitStatus ending;
  if (attempt.exit_status) ending.status = static_cast<int>(*attempt.exit_status);
  if (attempt.signal) ending.signal = static_cast<int>(*attempt.signal);
  return ": " + to_string(ending);
}

std::string line(const AttemptRecord& attempt) {
  return fmt::format("    {} seed {} {} at step {}{}\n", attempt.ended_at, attempt.seed, attempt.outcome,
                     attempt.step, account(attempt));
}

}  // namespace

std::map<std::string, std::vector<int>> lost_seeds(Database& database, std::int64_t point) {
  std::map<std::string, std::vector<int>> seeds;
  for (const RealisationRecord& record : database.realisations(point)) {
    const bool is_lost = record.state == SeedState::failed || record.state == SeedState::quarantined;
    if (is_lost) seeds[record.cause].push_back(record.seed);
  }
  return seeds;
}

std::string losses_text(Database& database, const PointSummary& point) {
  constexpr std::size_t most_seeds = 10;
  std::string text;
  for (auto [cause, of_cause] : lost_seeds(database, point.point.id)) {
    const std::size_t count = of_cause.size();
    if (count > most_seeds) of_cause.resize(most_seeds);
    text += fmt::format("  lost: {} {} (seed{} {}{})\n", count, cause, count == 1 ? "" : "s",
                        fmt::join(of_cause, ", "), count > most_seeds ? ", ..." : "");
    const auto reason = point.loss_reasons.find(cause);
    if (reason != point.loss_reasons.end()) text += fmt::format("    {}\n", reason->second);
  }
  return text;
}

std::string attempts_text(Database& database, std::int64_t point) {
  constexpr std::size_t most_lines = 5;
  const std::vector<AttemptRecord> attempts = database.attempts(point);
  std::map<std::string, int> outcomes;
  std::vector<std::string> blamed;
  int pardoned = 0;
  for (const AttemptRecord& attempt : attempts) {
    ++outcomes[attempt.outcome];
    if (attempt.blamed && !attempt.pardoned) blamed.push_back(line(attempt));
    if (attempt.pardoned) ++pardoned;
  }
  if (attempts.empty()) return "";
  std::vector<std::string> counts;
  counts.reserve(outcomes.size());
  for (const auto& [outcome, count] : outcomes) counts.push_back(fmt::format("{} {}", count, outcome));
  if (pardoned > 0) counts.push_back(fmt::format("{} of them before a retry", pardoned));
  std::string text = fmt::format("  attempts: {} ({})\n", attempts.size(), fmt::join(counts, ", "));
  const std::size_t first = blamed.size() > most_lines ? blamed.size() - most_lines : 0;
  for (std::size_t i = first; i < blamed.size(); ++i) text += blamed[i];
  return text;
}

}  // namespace peclet::runner
