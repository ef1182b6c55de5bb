#include "runner/reports/explain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "runner/campaign/number_text.h"
#include "runner/campaign/text_table.h"
#include "runner/owner/request_handler.h"
#include "runner/reports/status.h"
#include "runner/statistics/cohorts.h"
#include "runner/statistics/forecast.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

std::vector<PointSummary> selected(std::vector<PointSummary> points, const std::string& name) {
  if (name.empty()) return points;
  std::vector<PointRecord> records;
  records.reserve(points.size());
  for (const PointSummary& point : points) records.push_back(point.point);
  return {std::move(points[find_point(records, name)])};
}

// An observable at the last stop test, with its criterion.
struct Known {
  ObservableStopTest stop_test;
  Criterion criterion;
  ObservableStopTest measure;  // the observable to which the tolerance is relative
};

std::vector<Known> known_of(const StopTest& stop_test, const Target& target) {
  const std::vector<ObservableStopTest> each = each_of(stop_test, target);
  const auto stop_test_at = [&](const std::string& name) {
    return *std::find_if(each.begin(), each.end(),
                         [&](const ObservableStopTest& one) { return one.observable == name; });
  };
  std::vector<Known> all;
  for (const Criterion& criterion : target.criteria()) {
    const std::string& relative_to = criterion.tolerance.relative_to;
    all.push_back({stop_test_at(criterion.observable), criterion,
                   stop_test_at(relative_to.empty() ? criterion.observable : relative_to)});
  }
  return all;
}

std::string own_width_text(const Known& known) {
  return width_text(known.criterion.tolerance, known.stop_test.half_width, known.measure.estimate.mean);
}

// Returns "1.6 %", with "refused" after it for a curve that decides nothing; "-" without a curve.
std::string band_text(const ObservableStopTest& one) {
  if (!one.curve || !one.curve->is_known()) return "-";
  return percent(one.curve->high / one.curve->mean - 1) + (one.curve->refused ? " refused" : "");
}

std::string width_text(const Known& known) {
  if (!known.stop_test.is_decided_by_curve()) return own_width_text(known);
  return fmt::format("{} by the curve ({} alone)", band_text(known.stop_test), own_width_text(known));
}

// Returns "a half-width of 2 %", or "half-widths of 2 % for relative_viscosity, 0.1 for pressure".
std::string widths_text(const std::vector<Known>& all) {
  if (all.size() == 1) return "a half-width of " + width_text(all.front());
  std::vector<std::string> widths;
  widths.reserve(all.size());
  for (const Known& known : all) widths.push_back(width_text(known) + " for " + known.stop_test.observable);
  return fmt::format("half-widths of {}", fmt::join(widths, ", "));
}

// Returns "5 %", or for several criteria "5 % for relative_viscosity, 0.2 for pressure": those with this
// verdict, or all.
std::string tolerances_text(const std::vector<Known>& all, std::optional<Verdict> verdict = {}) {
  if (all.size() == 1) return to_string(all.front().criterion.tolerance);
  std::vector<std::string> tolerances;
  for (const Known& known : all) {
    if (verdict && known.stop_test.verdict != verdict) continue;
    tolerances.push_back(to_string(known.criterion.tolerance) + " for " + known.stop_test.observable);
  }
  return fmt::format("{}", fmt::join(tolerances, ", "));
}

// Returns the seeds that the tolerances need, because half-widths fall with 1 / sqrt(n).
std::string seeds_for(const StopTest& stop_test, const Target& target) {
  const double ratio = largest_share(stop_test, target);
  return std::isfinite(ratio) ? fmt::format("about {}", rough(std::ceil(stop_test.seeds * ratio * ratio)))
                              : "more";
}

// Returns the first criterion whose tolerance is a share of a mean that may be zero, or null. The number of
// seeds that such a tolerance needs depends only on the noise of the mean.
const Known* that_may_be_zero(const std::vector<Known>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [](const Known& known) {
    const ObservableStopTest& of = known.measure;
    return known.criterion.tolerance.needs_a_mean() && of.half_width >= std::abs(of.estimate.mean);
  });
  return found == all.end() ? nullptr : &*found;
}

// Returns the place of a criterion in a campaign: "/target/also/0/".
std::string place_of(const Target& target, const Criterion& criterion) {
  const std::string observable = pointer_of(target, criterion.observable);
  return observable.substr(0, observable.rfind('/') + 1);
}

std::string advice_when_capped(const StopTest& stop_test, const Target& target) {
  const std::vector<Known> all = known_of(stop_test, target);
  if (const Known* const zero = that_may_be_zero(all)) {
    return fmt::format(
        "set {0}absolute_tolerance, or another {0}observable: while the interval contains zero, no number of "
        "seeds can meet a {0}relative_tolerance below 100 %",
        place_of(target, zero->criterion));
  }
  const auto worst = std::max_element(all.begin(), all.end(), [](const Known& one, const Known& other) {
    return one.stop_test.share < other.stop_test.share;
  });
  return fmt::format("set a larger /realisations/maximum ({} seeds) or {}{} (`peclet set`), and run again",
                     seeds_for(stop_test, target), place_of(target, worst->criterion),
                     key_of(worst->criterion.tolerance));
}

// Returns the reason why observables of the last stop test have no interval; "" if all have one.
std::string missing_interval_text(const PointSummary& point) {
  if (point.without_interval.empty()) return "";
  const StopTest& stop_test = point.stop_tests.back();
  if (!stop_test.repeated.empty()) {
    return fmt::format(
        "seed{} {} ended in the same state as an earlier one, so that these values are not independent",
        stop_test.repeated.size() == 1 ? "" : "s", fmt::join(stop_test.repeated, ", "));
  }
  return fmt::format("all values of {} are equal, so that they have no spread to judge by",
                     fmt::join(point.without_interval, ", "));
}

// Returns the reason why a sufficient share of another mean is not enough: that mean is uncertain itself.
std::string measure_text(const std::vector<Known>& all) {
  for (const Known& known : all) {
    const bool is_its_own = known.measure.observable == known.stop_test.observable;
    const double mean = known.measure.estimate.mean;
    if (is_its_own || known.criterion.tolerance.share(known.stop_test.half_width, mean) > 1) continue;
    if (!(known.stop_test.share <= 1)) {
      return fmt::format(", because {} itself is known only to {}", known.measure.observable,
                         percent(known.measure.half_width / std::abs(mean)));
    }
  }
  return "";
}

std::string luck_text(const StopTest& stop_test) {
  if (!stop_test.near_maximum) return "";
  return "; perhaps by luck: the true spread may be so large that the point needs more seeds than are "
         "allowed, and intervals of such points hold the mean less often than they say";
}

std::string earlier_stop_test_text(const PointSummary& point) {
  if (point.earlier_stop_test == 0) return "";
  return fmt::format(
      "; this is the first stop test within it: it decides as if the target had always been this one, and "
      "leaves out later seeds; all {} seeds with a value give {} (± standard error)",
      point.all_seeds.count, with_error(point.all_seeds.mean, point.all_seeds.standard_error));
}

std::string reason(const PointSummary& point, const Target& target) {
  if (!point.decided) {
    const std::string missing = missing_interval_text(point);
    return fmt::format(
        "{} of the {} seeds{} have ended, {}{}", point.wanted_ended, point.wanted,
        target.has_tolerance() ? " of the next stop test" : "",
        point.point.cancelled ? "and the point gets no more" : fmt::format("{} run", point.counts.running),
        missing.empty() ? "" : "; " + missing);
  }
  const StopTest& stop_test = point.stop_tests.back();
  const std::vector<Known> all = known_of(stop_test, target);
  const auto lost_to = [&](const Known& known) { return stop_test.seeds - known.stop_test.estimate.count; };
  const auto name_of = [&](const Known& known) {
    return all.size() == 1 ? "" : " (no value of " + known.stop_test.observable + ')';
  };
  switch (stop_test.verdict) {
    case Verdict::converged:
    case Verdict::converged_with_losses:
      return fmt::format("{} seeds give {}, within the tolerance of {}{}{}", stop_test.seeds,
                         widths_text(all), tolerances_text(all), luck_text(stop_test),
                         earlier_stop_test_text(point));
    case Verdict::capped:
      if (const std::string missing = missing_interval_text(point); !missing.empty())
        return fmt::format("all {} seeds that are allowed have ended, and {}", stop_test.seeds, missing);
      return fmt::format("all {} seeds that are allowed give {}, not within the tolerance of {}{}",
                         stop_test.seeds, widths_text(all), tolerances_text(all, stop_test.verdict),
                         measure_text(all));
    case Verdict::failed: {
      const auto failed = std::find_if(all.begin(), all.end(), [&](const Known& known) {
        return known.stop_test.verdict == stop_test.verdict;
      });
      return fmt::format("{} of {} seeds are lost{}", lost_to(*failed), stop_test.seeds, name_of(*failed));
    }
    case Verdict::complete:
      return fmt::format("all {} seeds have ended", stop_test.seeds);
    case Verdict::complete_with_losses: {
      const auto fewest = std::min_element(all.begin(), all.end(), [](const Known& one, const Known& other) {
        return one.stop_test.estimate.count < other.stop_test.estimate.count;
      });
      return fmt::format("all {} seeds have ended, and {} of them are lost{}", stop_test.seeds,
                         lost_to(*fewest), name_of(*fewest));
    }
    case Verdict::more:
      break;
  }
  return "";
}

std::string next_step(const PointSummary& point, const TargetRecord& target,
                      const CampaignDirectory& directory) {
  if (point.point.suspect) {
    return "find out why one seed gave two results (see the events and spool/rejected/); trust none until "
           "then";
  }
  if (point.point.cancelled && !point.decided) return "nothing; `peclet cancel --undo` resumes the point";
  if (point.waits) return "nothing, until other points of its curve have made their stop tests";
  if (!point.decided) {
    if (!target.target.has_tolerance()) return fmt::format("the remaining ones of {} seeds", point.wanted);
    if (point.stop_tests.empty()) return fmt::format("the first stop test, at {} seeds", point.wanted);
    if (!point.without_interval.empty()) {
      return fmt::format(
          "the stop test at {} seeds; without an interval, the number of seeds needed cannot be predicted",
          point.wanted);
    }
    if (!target.target.over().empty())
      return fmt::format("the stop test at {} seeds; `peclet next` says what its curve needs", point.wanted);
    return fmt::format(
        "the stop test at {} seeds; {}", point.wanted,
        that_may_be_zero(known_of(point.stop_tests.back(), target.target)) != nullptr
            ? "the number of seeds needed cannot be predicted while the interval contains zero"
            : fmt::format("{} seeds are expected to be enough",
                          expected_seeds(point.stop_tests, target.target, target.minimum, target.maximum)));
  }
  const StopTest& stop_test = point.stop_tests.back();
  switch (stop_test.verdict) {
    case Verdict::complete:
    case Verdict::converged:
      if (stop_test.transient) return "set a longer /scene/duration/equilibration: see transient above";
      if (stop_test.verdict == Verdict::complete)
        return "nothing; more realisations (`peclet set --realisations`) reopen the point";
      if (stop_test.near_maximum) {
        return "for a narrower interval set a larger /realisations/maximum and a smaller tolerance (`peclet "
               "set`)";
      }
      return "nothing; a smaller tolerance (`peclet set`) reopens the point";
    case Verdict::converged_with_losses:
    case Verdict::complete_with_losses:
      return fmt::format(
          "find out why seeds are lost, because the mean leaves them out (states in {}){}",
          directory.failures().string(),
          point.counts.quarantined > 0 ? "; `peclet retry` runs the seeds again that were given up" : "");
    case Verdict::capped:
      if (!stop_test.repeated.empty()) {
        return "find out why seeds end in the same state: a start list with one file twice, or an engine "
               "without noise";
      }
      if (!point.without_interval.empty()) {
        return fmt::format("set a larger /realisations/maximum than {} (`peclet set`), or another observable",
                           target.maximum);
      }
      return advice_when_capped(stop_test, target.target);
    case Verdict::failed:
      return fmt::format("change the scene: states are in {}, logs in {}", directory.failures().string(),
                         directory.logs().string());
    case Verdict::more:
      break;
  }
  return "";
}

std::string stop_tests_table(const std::vector<StopTest>& stop_tests, const Target& target) {
  if (stop_tests.empty()) return "  no stop test yet\n";
  const bool with_control = std::any_of(stop_tests.begin(), stop_tests.end(), has_control);
  TextTable table;
  for (const char* const title : {"seeds", "lost", "mean ± half-width"}) table.add_column(title);
  if (target.has_tolerance()) {
    table.add_column(target.tolerance.is_relative() ? "relative" : "half-width");
    if (target.tolerance.is_of_curve()) table.add_column("curve");
    table.add_column("tolerance");
  }
  if (with_control) table.add_column("without control variate");
  table.add_column("verdict", TextTable::Align::left);
  for (const StopTest& stop_test : stop_tests) {
    std::vector<std::string> row{fmt::format("{}", stop_test.seeds), fmt::format("{}", stop_test.lost),
                                 with_error(stop_test.controlled.mean, stop_test.controlled_half_width)};
    if (target.has_tolerance()) {
      const Known leading = known_of(stop_test, target).front();
      row.push_back(own_width_text(leading));
      if (target.tolerance.is_of_curve()) row.push_back(band_text(leading.stop_test));
      row.push_back(to_string(target.tolerance));
    }
    if (with_control) row.push_back(with_error(stop_test.estimate.mean, stop_test.half_width));
    row.emplace_back(to_string(stop_test.verdict));
    table.add_row(std::move(row));
  }
  return table.text("  ");
}

// Returns the table of all observables at the last stop test; "" for a target of one observable.
std::string observables_table(const std::vector<StopTest>& stop_tests, const Target& target) {
  if (stop_tests.empty() || stop_tests.back().each.empty()) return "";
  TextTable table;
  table.add_column("at the last stop test", TextTable::Align::left);
  for (const char* const title : {"values", "mean ± half-width"}) table.add_column(title);
  if (target.has_tolerance()) {
    table.add_column("half-width");
    if (!target.over().empty()) table.add_column("curve");
    table.add_column("tolerance");
  }
  table.add_column("verdict", TextTable::Align::left);
  for (const Known& known : known_of(stop_tests.back(), target)) {
    std::vector<std::string> row{known.stop_test.observable,
                                 fmt::format("{}", known.stop_test.estimate.count),
                                 with_error(known.stop_test.estimate.mean, known.stop_test.half_width)};
    if (target.has_tolerance()) {
      row.push_back(own_width_text(known));
      if (!target.over().empty()) row.push_back(band_text(known.stop_test));
      row.push_back(to_string(known.criterion.tolerance));
    }
    row.emplace_back(to_string(*known.stop_test.verdict));
    table.add_row(std::move(row));
  }
  return table.text("  ");
}

// Returns a line on each curve at the point.
std::string curves_text(const std::vector<StopTest>& stop_tests, const Target& target) {
  if (stop_tests.empty()) return "";
  std::string text;
  for (const ObservableStopTest& one : stop_tests.back().each) {
    if (!one.curve) continue;
    const CurveBand& curve = *one.curve;
    text += fmt::format("  curve of {} over {}: ", one.observable, target.over());
    if (!curve.is_known()) {
      text += "not known yet, or not at this point\n";
      continue;
    }
    text += fmt::format(
        "{} .. {};\n    the point's own mean is {} standard deviations from the curve through the "
        "others, and at most {} are allowed\n",
        rough(curve.low), rough(curve.high), rough(std::abs(curve.residual)), rough(curve.allowed));
    if (curve.refused) {
      text += fmt::format("    the curve is refused, because {}: the points decide alone\n",
                          curve.contradicts() ? "this point contradicts it" : "another point contradicts it");
    }
  }
  return text;
}

Json blamed_attempts_json(Database& database, std::int64_t point) {
  Json blamed = Json::array();
  for (const AttemptRecord& attempt : database.attempts(point)) {
    if (!attempt.blamed) continue;
    blamed.push_back({{"seed", attempt.seed},
                      {"outcome", attempt.outcome},
                      {"step", attempt.step},
                      {"message", attempt.message}});
  }
  return blamed;
}

// Returns the files that the realisations of a point have left.
Json files_json(Database& database, const CampaignDirectory& directory, std::int64_t point) {
  int kept = 0, thrown_away = 0;
  std::uint64_t bytes = 0;  // of those that are kept
  Json folder;
  for (const FileRecord& record : files_of_point(database.connection(), point)) {
    ++(record.kept ? kept : thrown_away);
    if (!record.kept) continue;
    bytes += record.file.bytes;
    folder = record.place(directory).parent_path().parent_path().string();
  }
  return {{"kept", kept}, {"bytes", bytes}, {"thrown_away", thrown_away}, {"folder", folder}};
}

std::string files_text(const Json& files) {
  std::vector<std::string> parts;
  if (files["kept"] > 0) {
    parts.push_back(fmt::format("{} ({:.1f} MB) in {}", files["kept"].get<int>(),
                                1e-6 * files["bytes"].get<double>(), files["folder"].get<std::string>()));
  }
  if (files["thrown_away"] > 0) {
    parts.push_back(fmt::format("{} thrown away (/keep_files)", files["thrown_away"].get<int>()));
  }
  return parts.empty() ? "" : fmt::format("  files: {}\n", fmt::join(parts, "; "));
}

}  // namespace

Json explain_json(Database& database, const CampaignDirectory& directory, const std::string& point) {
  const CampaignRecord campaign = database.campaign();
  Json points = Json::array();
  for (const PointSummary& summary : selected(summarise_points(database, campaign.target), point)) {
    Json stop_tests = Json::array();
    for (const StopTest& stop_test : summary.stop_tests) stop_tests.push_back(stop_test_json(stop_test));
    points.push_back(
        {{"label", summary.point.label},
         {"hash", summary.point.hash},
         {"verdict", summary.decided ? Json(to_string(summary.stop_tests.back().verdict)) : Json(nullptr)},
         {"reservations", reservations(summary)},
         {"reason", reason(summary, campaign.target.target)},
         {"next", next_step(summary, campaign.target, directory)},
         {"stop_tests", stop_tests},
         {"losses", lost_seeds(database, summary.point.id)},
         {"loss_reasons", summary.loss_reasons},
         {"files", files_json(database, directory, summary.point.id)},
         {"blamed_attempts", blamed_attempts_json(database, summary.point.id)}});
  }
  return {{"schema_version", 1}, {"campaign", campaign.name}, {"points", points}};
}

std::string explain(Database& database, const CampaignDirectory& directory, const std::string& point) {
  const TargetRecord target = database.campaign().target;
  std::string text;
  for (const PointSummary& summary : selected(summarise_points(database, target), point)) {
    text += text.empty() ? "" : "\n";
    text += fmt::format("{}  ({})\n", summary.point.label, summary.point.hash.substr(0, 12));
    text += fmt::format("  {}: {}\n", verdict_text(summary), reason(summary, target.target));
    text += stop_tests_table(summary.stop_tests, target.target);
    text += observables_table(summary.stop_tests, target.target);
    text += curves_text(summary.stop_tests, target.target);
    text += prediction_text(summary);
    text += estimate_text(database, summary, target);
    text += losses_text(database, summary);
    text += attempts_text(database, summary.point.id);
    text += files_text(files_json(database, directory, summary.point.id));
    for (const SetAside& kept : summary.set_aside)
      text += fmt::format("  set aside: {} results of engine {}\n", kept.results, kept.engine);
    text += fmt::format("  next: {}\n", next_step(summary, target, directory));
  }
  return text;
}

}  // namespace peclet::runner
