#include "runner/reports/status.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "contract/errors.h"
#include "runner/campaign/number_text.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {
namespace {

Json lease_json(const LeaseRecord& lease) {
  return {
      {"seed", lease.seed},   {"worker", lease.worker}, {"phase", lease.phase},          {"step", lease.step},
      {"steps", lease.steps}, {"strain", lease.strain}, {"renewed_at", lease.renewed_at}};
}

Json bundles_json(const std::vector<HandedOver>& bundles) {
  Json list = Json::array();
  for (const HandedOver& bundle : bundles) {
    list.push_back({{"bundle", bundle.bundle},
                    {"job", bundle.job.empty() ? Json(nullptr) : Json(bundle.job)},
                    {"seeds", bundle.seeds}});
  }
  return list;
}

Json point_json(const PointSummary& point) {
  Json workers = Json::array();
  for (const LeaseRecord& lease : point.leases) workers.push_back(lease_json(lease));
  const StateCounts& counts = point.counts;
  return {{"label", point.point.label},
          {"hash", point.point.hash},
          {"settings", point.point.settings},
          {"verdict", point.decided ? Json(to_string(point.stop_tests.back().verdict)) : Json(nullptr)},
          {"suspect", point.point.suspect},
          {"cancelled", point.point.cancelled},
          {"priority", point.point.priority},
          {"set_aside", to_json(point.set_aside)},
          {"seeds",
           {{"wanted", point.wanted},
            {"wanted_ended", point.wanted_ended},
            {"queued", counts.queued},
            {"running", counts.running},
            {"done", counts.done},
            {"failed", counts.failed},
            {"quarantined", counts.quarantined},
            {"extra", point.extra()}}},
          {"losses", point.losses},
          {"loss_reasons", point.loss_reasons},
          {"flags", point.flags},
          {"reservations", reservations(point)},
          {"endings", to_json(point.endings)},
          {"all_seeds", estimate_json(point.all_seeds)},
          {"stop_test", point.stop_tests.empty() ? Json(nullptr) : stop_test_json(point.stop_tests.back())},
          {"cpu_seconds", counts.cpu_seconds},
          {"prediction", prediction_json(point)},
          {"workers", workers}};
}

}  // namespace

Json to_json(const std::vector<SetAside>& results) {
  Json list = Json::array();
  for (const SetAside& kept : results) list.push_back({{"engine", kept.engine}, {"results", kept.results}});
  return list;
}

CampaignStatus read_status(Database& database, std::optional<std::int64_t> owner) {
  CampaignStatus status;
  status.owner = owner;
  status.campaign = database.campaign();
  status.points = summarise_points(database, status.campaign.target);
  status.forecasts = forecasts_of(database, status.points);
  status.handed_over = BundleStore(database.connection()).handed_over();
  if (status.handed_over.empty()) {
    const TargetRecord& target = status.campaign.target;
    status.to_go =
        time_to_go(status.forecasts, target.target, target.minimum, target.maximum,
                   std::max(1, database.last_workers()), curves_of(status.campaign.document, target.target));
  }
  return status;
}

CampaignTotals totals_of(const CampaignStatus& status) {
  CampaignTotals totals;
  std::set<int> workers;
  for (const PointSummary& point : status.points) {
    totals.decided += point.decided ? 1 : 0;
    for (const LeaseRecord& lease : point.leases) workers.insert(lease.worker);
    totals.ended += point.counts.terminal();
    totals.running += point.counts.running;
    totals.lost += point.lost();
    totals.extra += point.extra();
    totals.cpu_seconds += point.counts.cpu_seconds;
    ++totals.states[state_word(point)];
    for (const auto& [cause, count] : point.losses) totals.losses[cause] += count;
  }
  totals.workers = static_cast<int>(workers.size());
  for (const HandedOver& bundle : status.handed_over) totals.handed_over += bundle.seeds;
  return totals;
}

int exit_code_of(const CampaignStatus& status) {
  const auto any = [&](auto is) { return std::any_of(status.points.begin(), status.points.end(), is); };
  if (any([](const PointSummary& point) { return point.point.suspect; })) return ExitCode::integrity;
  if (any([](const PointSummary& point) { return point.open(); })) return ExitCode::unfinished;
  // A point that was cancelled early may have no stop test.
  const auto is_whole = [](const PointSummary& point) {
    if (!point.decided) return false;
    const Verdict verdict = point.stop_tests.back().verdict;
    return is_reached(verdict) && !has_losses(verdict);
  };
  return std::all_of(status.points.begin(), status.points.end(), is_whole) ? ExitCode::done
                                                                           : ExitCode::unconverged;
}

int ending(const CampaignStatus& status, bool finished) {
  const int code = exit_code_of(status);
  if (code == ExitCode::integrity) return code;
  if (!finished) return ExitCode::stopped;
  return code == ExitCode::unfinished ? ExitCode::unconverged : code;
}

std::string state_word(const PointSummary& point) {
  if (point.decided) return to_string(point.stop_tests.back().verdict);
  return point.point.cancelled ? "cancelled" : "open";
}

std::string verdict_text(const PointSummary& point) {
  std::string text = state_word(point);
  if (point.decided && has_losses(point.stop_tests.back().verdict)) {
    text += fmt::format("({})", point.stop_tests.back().lost);
  } else if (point.lost() > 0) {
    text += fmt::format(", {} lost", point.lost());
  }
  for (const std::string& reservation : reservations(point)) text += ", " + reservation;
  if (point.decided && point.point.cancelled) text += ", cancelled";
  if (point.point.priority != 0) text += fmt::format(", priority {}", point.point.priority);
  return text;
}

std::vector<std::string> reservations(const PointSummary& point) {
  std::vector<std::string> found;
  if (point.endings.has_jammed()) found.emplace_back("jammed");
  if (!point.stop_tests.empty() && point.stop_tests.back().transient) found.emplace_back("transient");
  if (!point.stop_tests.empty() && point.stop_tests.back().untested) found.emplace_back("no-transient-test");
  if (point.decided && is_skewed(point.stop_tests.back(), point.confidence)) found.emplace_back("skewed");
  if (!point.stop_tests.empty() && point.stop_tests.back().near_maximum) found.emplace_back("near-maximum");
  if (!point.without_interval.empty())
    found.emplace_back(point.stop_tests.back().repeated.empty() ? "equal-values" : "repeated-seeds");
  if (!point.stop_tests.empty()) {
    const StopTest& last = point.stop_tests.back();
    const auto any = [&](auto is) {
      return std::ranges::any_of(last.each,
                                 [&](const ObservableStopTest& one) { return one.curve && is(one); });
    };
    if (is_decided_by_curve(last)) found.emplace_back("by-curve");
    if (point.waits) found.emplace_back("waits-for-curve");
    if (any([](const ObservableStopTest& one) { return one.curve->contradicts(); })) {
      found.emplace_back("off-curve");
    } else if (any([](const ObservableStopTest& one) { return one.curve->refused; })) {
      found.emplace_back("curve-refused");
    }
  }
  if (point.earlier_stop_test > 0) found.emplace_back("earlier-stop-test");
  for (const auto& [code, count] : point.flags) {
    if (code == "jammed" && point.endings.has_jammed()) continue;  // said already
    found.push_back(fmt::format("{} flagged {}", count, code));
  }
  if (point.point.suspect) found.emplace_back("suspect");
  return found;
}

Json status_json(const CampaignStatus& status) {
  const TargetRecord& target = status.campaign.target;
  Json points = Json::array();
  for (const PointSummary& point : status.points) points.push_back(point_json(point));
  return {{"schema_version", 1},
          {"campaign", status.campaign.name},
          {"target", to_json(target.target)},
          {"realisations", {{"minimum", target.minimum}, {"maximum", target.maximum}}},
          {"owner", status.owner ? Json(*status.owner) : Json(nullptr)},
          {"exit_code", exit_code_of(status)},
          {"seconds_to_go", to_json(status.to_go)},
          {"handed_over", bundles_json(status.handed_over)},
          {"chosen",
           status.campaign.document.contains("choose") ? chosen_values(status.campaign.document) : Json()},
          {"points", points}};
}

namespace {

// Returns mean ± half-width, with the relative half-width if the tolerance is relative.
std::string interval(const StopTest& stop_test, const Tolerance& tolerance) {
  const bool has_interval = std::isfinite(stop_test.controlled_half_width);
  if (!has_interval && stop_test.controlled.count < 2) return "-";
  const std::string text = with_error(stop_test.controlled.mean, stop_test.controlled_half_width);
  return tolerance.is_relative() && has_interval
             ? fmt::format("{} ({})", text, percent(relative_width(stop_test)))
             : text;
}

// Returns the band of the leading observable's curve: "10.06 ± 0.16 (1.6 %)", or "-" while it is unknown.
std::string band(const StopTest& stop_test) {
  const CurveBand& curve = *stop_test.each.front().curve;
  if (!curve.is_known()) return "-";
  return fmt::format("{} ({})", with_error(curve.mean, 0.5 * (curve.high - curve.low)),
                     percent(curve.high / curve.mean - 1));
}

// Returns "pressure 2.6 x": the observable with the largest half-width, as a multiple of the allowed one.
std::string farthest(const StopTest& stop_test) {
  const ObservableStopTest* found = nullptr;
  for (const ObservableStopTest& one : stop_test.each) {
    if (one.verdict && (found == nullptr || !(one.smaller_share() <= found->smaller_share()))) found = &one;
  }
  return fmt::format("{} {} x", found->observable, rough(found->smaller_share()));
}

// Returns the cells for a fixed number of realisations: each observable over the seeds of the stop test, or
// over all ended seeds before it.
std::vector<std::string> shown_cells(const PointSummary& point, const std::vector<Estimate>& all_seeds,
                                     const Target& target) {
  std::vector<std::string> cells{fmt::format("{}/{}", point.wanted_ended, point.wanted)};
  if (point.stop_tests.empty()) {
    for (const Estimate& one : all_seeds)
      cells.push_back(with_error(one.mean, half_width(one, target.confidence)));
  } else {
    for (const ObservableStopTest& one : each_of(point.stop_tests.back(), target))
      cells.push_back(with_error(one.estimate.mean, one.half_width));
  }
  cells.push_back(verdict_text(point));
  return cells;
}

std::vector<std::string> cells(const PointSummary& point, const Target& target) {
  const bool with_others = target.observables().size() > 1;
  std::vector<std::string> cells{fmt::format("{}/{}", point.wanted_ended, point.wanted),
                                 with_error(point.all_seeds.mean, point.all_seeds.standard_error)};
  if (point.stop_tests.empty()) {
    cells.emplace_back("-");
    if (target.tolerance.is_of_curve()) cells.emplace_back("-");
    if (with_others) cells.emplace_back("-");
  } else {
    const StopTest& stop_test = point.stop_tests.back();
    cells.push_back(interval(stop_test, target.tolerance));
    if (target.tolerance.is_of_curve()) cells.push_back(band(stop_test));
    if (with_others) cells.push_back(farthest(stop_test));
  }
  cells.push_back(verdict_text(point));
  return cells;
}

std::string heading(const CampaignStatus& status) {
  const TargetRecord& target = status.campaign.target;
  const std::string confidence = target.target.has_tolerance()
                                     ? fmt::format(" at {:g} % confidence", 100 * target.target.confidence)
                                     : "";
  return fmt::format("{}: {}{}, {} seeds a point\n\n", status.campaign.name, to_string(target.target),
                     confidence, range_text(target.minimum, target.maximum));
}

// The importance of the columns that a narrow terminal may leave out.
namespace importance {
constexpr int all_seeds = 1, seeds = 2, stop_test = 3, curve = 4, farthest = 5;
}

// Returns the legend of the columns that are shown.
std::string legend(const CampaignStatus& status, const std::vector<std::string>& left_out,
                   std::size_t width) {
  // On a wide terminal the legend takes two lines of similar length.
  const char* const blank = width >= 100 ? "\n" : " ";
  const auto shows = [&](const char* title) {
    return std::find(left_out.begin(), left_out.end(), title) == left_out.end();
  };
  std::vector<std::string> parts;
  const Target& target = status.campaign.target.target;
  if (!target.has_tolerance()) {
    parts.push_back(fmt::format("mean ± half-width of the {:g} % interval of the seeds that have ended",
                                100 * target.confidence));
  } else {
    if (shows("all seeds"))
      parts.emplace_back("all seeds: mean ± standard error of all seeds that have ended");
    if (shows("stop test")) {
      parts.push_back(
          fmt::format("stop test: mean ± half-width of the{}{:g} % interval at the last stop test", blank,
                      100 * target.confidence));
    }
    if (target.tolerance.is_of_curve() && shows("curve")) {
      parts.push_back(fmt::format("curve: the band of the curve over {}", target.over()));
    }
    if (shows("farthest") && target.observables().size() > 1) {
      parts.emplace_back("farthest: the largest half-width, as a multiple of its tolerance");
    }
  }
  std::string text = fmt::format("{}\n", fmt::join(parts, "; "));
  if (!left_out.empty())
    text += fmt::format("the terminal is too narrow for: {}\n", fmt::join(left_out, ", "));
  return folded(text, width);
}

// Returns a line for each point that an earlier stop test decides. A loosened target is met by the first stop
// test within it, because a later choice of the stop test would be a choice of the answer.
std::string earlier_stop_test_text(const CampaignStatus& status) {
  std::string text;
  for (const PointSummary& point : status.points) {
    if (point.earlier_stop_test == 0) continue;
    text += fmt::format(
        "{}: the stop test at {} seeds decides, because it is the first within the present target; \"all "
        "seeds\" has all {} that have ended\n",
        point.point.label, point.stop_tests.back().seeds, point.counts.terminal());
  }
  return text;
}

// Returns "3 capped, 2 open".
std::string listed(const std::map<std::string, int>& counts) {
  std::vector<std::string> parts;
  parts.reserve(counts.size());
  for (const auto& [name, count] : counts) parts.push_back(fmt::format("{} {}", count, name));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Returns "; 40 handed over (jobs 12, 17)", or "" if a batch system has no seeds.
std::string handed_over_text(const CampaignStatus& status) {
  constexpr std::size_t most_jobs = 4;
  int seeds = 0;
  std::vector<std::string> jobs;
  for (const HandedOver& bundle : status.handed_over) {
    seeds += bundle.seeds;
    jobs.push_back(bundle.job.empty() ? "not confirmed" : bundle.job);
  }
  if (seeds == 0) return "";
  const std::size_t all = jobs.size(), shown = std::min(most_jobs, all);
  jobs.resize(shown);
  return fmt::format("; {} handed over (job{} {}{})", seeds, all == 1 ? "" : "s", fmt::join(jobs, ", "),
                     all > shown ? fmt::format(" and {} more", all - shown) : "");
}

// Returns a line about the values of the curves' axis that runs choose, or "" if they choose none.
std::string chosen_text(const CampaignStatus& status) {
  const Json& document = status.campaign.document;
  if (!document.contains("choose")) return "";
  const Target& target = status.campaign.target.target;
  const std::size_t values = curves_of(document, target).front().axis.size();
  std::vector<std::string> chosen;
  for (const Json& value : chosen_values(document))
    chosen.push_back(fmt::format("{:g}", value.get<double>()));
  return fmt::format("{} of at most {} values of {}; chosen: {}\n", values,
                     document["choose"]["points"].get<int>(), target.over(),
                     chosen.empty() ? "none yet" : fmt::format("{}", fmt::join(chosen, ", ")));
}

std::string set_aside_text(const CampaignStatus& status) {
  std::string text;
  for (const PointSummary& point : status.points) {
    for (const SetAside& kept : point.set_aside) {
      text += fmt::format("{}: {} results of engine {} are set aside\n", point.point.label, kept.results,
                          kept.engine);
    }
  }
  return text;
}

std::string seed_totals(const CampaignStatus& status) {
  const CampaignTotals totals = totals_of(status);
  std::string text = fmt::format("{} seeds ended", totals.ended);
  if (totals.lost > 0) text += fmt::format(", {} of them lost ({})", totals.lost, listed(totals.losses));
  if (totals.extra > 0) text += fmt::format(", {} extra", totals.extra);
  if (totals.running > 0) {
    text += fmt::format("; {} {}", totals.running,
                        status.owner ? "running" : "were running when the run was killed");
  }
  text += handed_over_text(status);
  return text + fmt::format("; processor time {}\n", duration_text(totals.cpu_seconds));
}

// Returns the reasons why seeds were lost, one line for each cause at each point.
std::string losses_text(const CampaignStatus& status) {
  constexpr int most_lines = 10;
  std::string text;
  int lines = 0;
  for (const PointSummary& point : status.points) {
    for (const auto& [cause, reason] : point.loss_reasons) {
      if (++lines > most_lines) continue;
      text += fmt::format("{}: {} lost, {}: {}\n", point.point.label, point.losses.at(cause), cause, reason);
    }
  }
  if (lines > most_lines) text += fmt::format("and {} more: see `peclet explain`\n", lines - most_lines);
  return text;
}

}  // namespace

std::string point_totals(const CampaignStatus& status) {
  return fmt::format("{}: {}", counted(status.points.size(), "point"), listed(totals_of(status).states));
}

std::string status_table(const CampaignStatus& status, std::size_t width) {
  std::vector<std::string> labels;
  for (const PointSummary& point : status.points) labels.push_back(point.point.label);
  const PointColumns points(labels);
  TextTable table;
  points.add_to(table);
  table.add_column("seeds", TextTable::Align::right, importance::seeds);
  const Target& target = status.campaign.target.target;
  const std::vector<std::string> observables = target.observables();
  if (target.has_tolerance()) {
    table.add_column("all seeds", TextTable::Align::right, importance::all_seeds);
    table.add_column("stop test", TextTable::Align::right, importance::stop_test);
    if (target.tolerance.is_of_curve()) table.add_column("curve", TextTable::Align::right, importance::curve);
    if (observables.size() > 1) table.add_column("farthest", TextTable::Align::left, importance::farthest);
  } else {
    for (const std::string& name : observables) {
      table.add_column(name, TextTable::Align::right,
                       name == target.observable ? importance::stop_test : importance::all_seeds);
    }
  }
  table.add_column("verdict", TextTable::Align::left);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::vector<std::string> row = points.cells(i);
    const std::vector<std::string> rest =
        target.has_tolerance() ? cells(status.points[i], target)
                               : shown_cells(status.points[i], status.forecasts[i].all_seeds, target);
    row.insert(row.end(), rest.begin(), rest.end());
    table.add_row(std::move(row));
  }
  const std::string totals = point_totals(status) + '\n' + seed_totals(status) + chosen_text(status) +
                             losses_text(status) + earlier_stop_test_text(status) + set_aside_text(status) +
                             predictions_text(status.points);
  return folded(heading(status), width) + table.text_within(width) + '\n' +
         legend(status, table.left_out(width), width) + '\n' + folded(totals, width);
}

std::string workers_text(const CampaignStatus& status, std::size_t width) {
  constexpr std::size_t most_lines = 16;
  std::string to_go = status.to_go ? to_string(*status.to_go) : "";
  if (!to_go.empty()) to_go = ": " + to_go;
  if (!status.owner) {
    if (exit_code_of(status) != 4) return "";
    return status.handed_over.empty()
               ? fmt::format("\nno process runs the campaign now; `peclet run` continues it{}\n", to_go)
               : "\nno process takes results in now; `peclet ingest` does\n";
  }
  TextTable table;
  table.add_column("worker", TextTable::Align::right, 2);
  table.add_column("point and seed", TextTable::Align::left);
  table.add_column("phase", TextTable::Align::left, 3);
  table.add_column("done", TextTable::Align::right, 4);
  table.add_column("strain", TextTable::Align::right, 1);
  // A worker has a seed and perhaps one that waits, or many at once.
  constexpr int most_seeds = 2;
  std::map<int, int> seeds;  // of each worker
  for (const PointSummary& point : status.points) {
    for (const LeaseRecord& lease : point.leases) ++seeds[lease.worker];
  }
  std::size_t workers = 0;
  for (const auto& [worker, count] : seeds) {
    if (count <= most_seeds || ++workers > most_lines) continue;
    table.add_row({fmt::format("{}", worker), fmt::format("{} realisations", count), "", "", ""});
  }
  for (const PointSummary& point : status.points) {
    for (const LeaseRecord& lease : point.leases) {
      if (seeds[lease.worker] > most_seeds || ++workers > most_lines) continue;
      const double done =
          lease.steps > 0 ? static_cast<double>(lease.step) / static_cast<double>(lease.steps) : std::nan("");
      table.add_row({fmt::format("{}", lease.worker),
                     fmt::format("{} seed {}", point.point.label, lease.seed), lease.phase,
                     std::isnan(done) ? "-" : fmt::format("{:.0f} %", 100 * done), rough(lease.strain)});
    }
  }
  std::string text = fmt::format("\nprocess {} runs the campaign{}\n", *status.owner, to_go);
  if (workers > 0) text += table.text_within(width);
  if (workers > most_lines) text += fmt::format("and {} more workers\n", workers - most_lines);
  return text;
}

namespace {

// Returns the seeds to come of an open point: to the predicted number, or at least to its next stop test.
int seeds_to_come(const PointSummary& point) {
  return std::max(point.wanted, point.prediction->seeds.likely) - point.wanted_ended;
}

}  // namespace

std::string predictions_text(const std::vector<PointSummary>& points) {
  int decided = 0, within = 0, seeds = 0, expected_seeds = 0, open = 0, to_come = 0;
  double seconds = 0, expected_seconds = 0, seconds_to_come = 0;
  for (const PointSummary& point : points) {
    if (!point.prediction) continue;
    if (point.decided) {
      ++decided;
      within += point.prediction->holds(point.wanted) ? 1 : 0;
      seeds += point.wanted;
      expected_seeds += point.prediction->seeds.likely;
      seconds += point.wanted_cpu_seconds;
      expected_seconds += point.prediction->likely_cpu_seconds();
    } else {
      ++open;
      to_come += seeds_to_come(point);
      seconds_to_come += seeds_to_come(point) * point.prediction->cpu_seconds;
    }
  }
  std::string text;
  if (decided > 0) {
    text = fmt::format(
        "predictions: {} of {} points within {} range; {} seeds ({} expected), processor time {} ({} "
        "expected)\n",
        within, decided, decided == 1 ? "its" : "their", seeds, expected_seeds, duration_text(seconds),
        duration_text(expected_seconds));
  }
  if (open > 0) {
    text += fmt::format("predicted for the open points ({}): {} seeds and {} of processor time to come\n",
                        open, to_come, duration_text(seconds_to_come));
  }
  return text;
}

std::string prediction_text(const PointSummary& point) {
  if (!point.prediction) return "";
  const StoredPrediction& made = *point.prediction;
  const std::string expected = fmt::format("  predicted from {} seeds: {} ({} .. {}), processor time {}",
                                           made.pilot, made.seeds.likely, made.seeds.lower, made.seeds.upper,
                                           duration_text(made.likely_cpu_seconds()));
  if (!point.decided) {
    return expected + fmt::format("; {} seeds and {} to come\n", seeds_to_come(point),
                                  duration_text(seeds_to_come(point) * made.cpu_seconds));
  }
  return expected + fmt::format("; it took {}, {} that range, and {}\n", point.wanted,
                                made.holds(point.wanted) ? "within" : "outside",
                                duration_text(point.wanted_cpu_seconds));
}

Json prediction_json(const PointSummary& point) {
  if (!point.prediction) return nullptr;
  const StoredPrediction& made = *point.prediction;
  Json json{{"made_at", made.made_at},
            {"pilot", made.pilot},
            {"seeds", range_json(made.seeds)},
            {"cpu_seconds", made.likely_cpu_seconds()},
            {"within_range", nullptr},
            {"taken", nullptr},
            {"to_come", nullptr}};
  if (point.decided) {
    json["within_range"] = made.holds(point.wanted);
    json["taken"] = {{"seeds", point.wanted}, {"cpu_seconds", point.wanted_cpu_seconds}};
  } else {
    json["to_come"] = {{"seeds", seeds_to_come(point)},
                       {"cpu_seconds", seeds_to_come(point) * made.cpu_seconds}};
  }
  return json;
}

}  // namespace peclet::runner
