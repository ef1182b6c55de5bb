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

// An observable of the last look, and how well it is to be known.
struct Known {
  ObservableLook look;
  Criterion criterion;
  ObservableLook measure;  // of the mean that the tolerance is a share of
};

std::vector<Known> known_of(const Look& look, const Target& target) {
  const std::vector<ObservableLook> each = each_of(look, target);
  const auto look_at = [&](const std::string& name) {
    return *std::find_if(each.begin(), each.end(),
                         [&](const ObservableLook& one) { return one.observable == name; });
  };
  std::vector<Known> all;
  for (const Criterion& criterion : target.criteria()) {
    const std::string& relative_to = criterion.tolerance.relative_to;
    all.push_back({look_at(criterion.observable), criterion,
                   look_at(relative_to.empty() ? criterion.observable : relative_to)});
  }
  return all;
}

std::string width_text(const Known& known) {
  return width_text(known.criterion.tolerance, known.look.half_width, known.measure.estimate.mean);
}

// "2 %"; of several "relative_viscosity 2 %, pressure 0.1".
std::string widths_text(const std::vector<Known>& all) {
  if (all.size() == 1) return width_text(all.front());
  std::vector<std::string> widths;
  widths.reserve(all.size());
  for (const Known& known : all) widths.push_back(known.look.observable + ' ' + width_text(known));
  return fmt::format("{}", fmt::join(widths, ", "));
}

// "5 %"; of several "5 % for relative_viscosity, 0.2 for pressure": those on whose observable the look said
// `verdict`, or all of them.
std::string tolerances_text(const std::vector<Known>& all, std::optional<Verdict> verdict = {}) {
  if (all.size() == 1) return to_string(all.front().criterion.tolerance);
  std::vector<std::string> tolerances;
  for (const Known& known : all) {
    if (verdict && known.look.verdict != verdict) continue;
    tolerances.push_back(to_string(known.criterion.tolerance) + " for " + known.look.observable);
  }
  return fmt::format("{}", fmt::join(tolerances, ", "));
}

// Seeds that the tolerances would take, as half-widths fall with 1 / sqrt(n).
std::string seeds_for(const Look& look, const Target& target) {
  const double ratio = largest_share(look, target);
  return std::isfinite(ratio) ? fmt::format("about {}", rough(std::ceil(look.seeds * ratio * ratio)))
                              : "more";
}

// The first observable of which a tolerance is a share although it may be zero; null where there is none. A
// share of such a mean is no measure of accuracy: whatever number of seeds it led to would be of the mean's
// own noise.
const Known* that_may_be_zero(const std::vector<Known>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [](const Known& known) {
    const ObservableLook& of = known.measure;
    return known.criterion.tolerance.needs_a_mean() && of.half_width >= std::abs(of.estimate.mean);
  });
  return found == all.end() ? nullptr : &*found;
}

// "/target/also/0/"
std::string place_of(const Target& target, const Criterion& criterion) {
  const std::string observable = pointer_of(target, criterion.observable);
  return observable.substr(0, observable.rfind('/') + 1);
}

std::string advice_when_capped(const Look& look, const Target& target) {
  const std::vector<Known> all = known_of(look, target);
  if (const Known* const zero = that_may_be_zero(all)) {
    return fmt::format(
        "{0}absolute_tolerance, or another {0}observable: the interval contains zero, and as long as it does "
        "no {0}relative_tolerance below 100 % can be met, whatever the number of seeds",
        place_of(target, zero->criterion));
  }
  const auto worst = std::max_element(all.begin(), all.end(), [](const Known& one, const Known& other) {
    return one.look.share < other.look.share;
  });
  return fmt::format("a larger /realisations/maximum ({} seeds) or {}{} (`peclet set`), and run again",
                     seeds_for(look, target), place_of(target, worst->criterion),
                     key_of(worst->criterion.tolerance));
}

// Why observables of the last look have no interval; nothing where all have one.
std::string missing_interval_text(const PointSummary& point) {
  if (point.without_interval.empty()) return "";
  const Look& look = point.looks.back();
  if (!look.repeated.empty()) {
    return fmt::format(
        "seed{} {} ended in the same state as an earlier one, so that these values are not independent",
        look.repeated.size() == 1 ? "" : "s", fmt::join(look.repeated, ", "));
  }
  return fmt::format("all values of {} are equal, so that they have no spread to judge by",
                     fmt::join(point.without_interval, ", "));
}

// What makes a share of another observable's mean less sure.
std::string measure_text(const std::vector<Known>& all) {
  for (const Known& known : all) {
    const bool is_its_own = known.measure.observable == known.look.observable;
    const double mean = known.measure.estimate.mean;
    if (is_its_own || known.criterion.tolerance.share(known.look.half_width, mean) > 1) continue;
    if (!(known.look.share <= 1)) {
      return fmt::format(", because {} itself is known to {} only", known.measure.observable,
                         percent(known.measure.half_width / std::abs(mean)));
    }
  }
  return "";
}

std::string luck_text(const Look& look) {
  if (!look.near_maximum) return "";
  return "; perhaps by luck: with a spread as large as these values leave open it would need more seeds than "
         "are allowed, and intervals of such points hold the mean less often";
}

std::string earlier_look_text(const PointSummary& point) {
  if (point.earlier_look == 0) return "";
  return fmt::format(
      ": the first look that is; it decides as if the target had always been this one, and leaves out later "
      "seeds; all {} with a value give {} (± standard error)",
      point.so_far.count, with_error(point.so_far.mean, point.so_far.standard_error));
}

std::string reason(const PointSummary& point, const Target& target) {
  if (!point.decided) {
    const std::string missing = missing_interval_text(point);
    return fmt::format(
        "{} of the {} seeds{} have ended, {}{}", point.wanted_ended, point.wanted,
        target.has_tolerance() ? " of the next look" : "",
        point.point.cancelled ? "and it gets no more" : fmt::format("{} run", point.counts.running),
        missing.empty() ? "" : "; " + missing);
  }
  const Look& look = point.looks.back();
  const std::vector<Known> all = known_of(look, target);
  const auto lost_to = [&](const Known& known) { return look.seeds - known.look.estimate.count; };
  const auto name_of = [&](const Known& known) {
    return all.size() == 1 ? "" : " to " + known.look.observable;
  };
  switch (look.verdict) {
    case Verdict::converged:
    case Verdict::converged_with_losses:
      return fmt::format("{} seeds give {}, within the tolerance of {}{}{}", look.seeds, widths_text(all),
                         tolerances_text(all), luck_text(look), earlier_look_text(point));
    case Verdict::capped:
      if (const std::string missing = missing_interval_text(point); !missing.empty())
        return fmt::format("all {} seeds that are allowed have ended, and {}", look.seeds, missing);
      return fmt::format("all {} seeds that are allowed give {}, not within the tolerance of {}{}",
                         look.seeds, widths_text(all), tolerances_text(all, look.verdict), measure_text(all));
    case Verdict::failed: {
      const auto failed = std::find_if(
          all.begin(), all.end(), [&](const Known& known) { return known.look.verdict == look.verdict; });
      return fmt::format("{} of {} seeds are lost{}", lost_to(*failed), look.seeds, name_of(*failed));
    }
    case Verdict::complete:
      return fmt::format("all {} seeds have ended", look.seeds);
    case Verdict::complete_with_losses: {
      const auto fewest = std::min_element(all.begin(), all.end(), [](const Known& one, const Known& other) {
        return one.look.estimate.count < other.look.estimate.count;
      });
      return fmt::format("all {} seeds have ended, and {} of them are lost{}", look.seeds, lost_to(*fewest),
                         name_of(*fewest));
    }
    case Verdict::more:
      break;
  }
  return "";
}

std::string next_step(const PointSummary& point, const TargetRecord& target,
                      const CampaignDirectory& directory) {
  if (point.point.suspect) {
    return "find out why one seed gave two results (see the events and spool/rejected/) before trusting any";
  }
  if (point.point.cancelled && !point.decided) return "nothing; `peclet cancel --undo` takes it up again";
  if (!point.decided) {
    if (!target.target.has_tolerance()) return fmt::format("the other seeds of {}", point.wanted);
    if (point.looks.empty()) return fmt::format("the first look, at {} seeds", point.wanted);
    if (!point.without_interval.empty()) {
      return fmt::format("the look at {} seeds; how many will be enough cannot be told without an interval",
                         point.wanted);
    }
    return fmt::format(
        "the look at {} seeds; {}", point.wanted,
        that_may_be_zero(known_of(point.looks.back(), target.target)) != nullptr
            ? "how many will be enough cannot be told while the interval contains zero"
            : fmt::format("{} are expected to be enough",
                          expected_seeds(point.looks, target.target, target.minimum, target.maximum)));
  }
  const Look& look = point.looks.back();
  switch (look.verdict) {
    case Verdict::complete:
    case Verdict::converged:
      if (look.transient) return "a longer /scene/duration/equilibration: see transient above";
      if (look.verdict == Verdict::complete)
        return "nothing; more realisations (`peclet set --realisations`) reopen it";
      if (look.near_maximum) {
        return "a larger /realisations/maximum and a smaller tolerance (`peclet set`), or nothing";
      }
      return "nothing; a smaller tolerance (`peclet set`) reopens it";
    case Verdict::converged_with_losses:
    case Verdict::complete_with_losses:
      return fmt::format(
          "see why seeds are lost: the mean leaves them out (states in {}){}", directory.failures().string(),
          point.counts.quarantined > 0 ? "; `peclet retry` runs those again that were given up" : "");
    case Verdict::capped:
      if (!look.repeated.empty()) {
        return "find out why seeds give the same: a start list with one file twice, or an engine without "
               "noise";
      }
      if (!point.without_interval.empty()) {
        return fmt::format("a larger /realisations/maximum than {} (`peclet set`), or another observable",
                           target.maximum);
      }
      return advice_when_capped(look, target.target);
    case Verdict::failed:
      return fmt::format("change the scene: states are in {}, logs in {}", directory.failures().string(),
                         directory.logs().string());
    case Verdict::more:
      break;
  }
  return "";
}

std::string looks_table(const std::vector<Look>& looks, const Target& target) {
  if (looks.empty()) return "  no look yet\n";
  const bool with_control = std::any_of(looks.begin(), looks.end(), has_control);
  TextTable table;
  for (const char* const title : {"seeds", "lost", "mean ± half-width"}) table.add_column(title);
  if (target.has_tolerance()) {
    table.add_column(target.tolerance.is_relative() ? "relative" : "half-width");
    table.add_column("tolerance");
  }
  if (with_control) table.add_column("uncontrolled");
  table.add_column("verdict", TextTable::Align::left);
  for (const Look& look : looks) {
    std::vector<std::string> row{fmt::format("{}", look.seeds), fmt::format("{}", look.lost),
                                 with_error(look.controlled.mean, look.controlled_half_width)};
    if (target.has_tolerance()) {
      row.push_back(width_text(known_of(look, target).front()));
      row.push_back(to_string(target.tolerance));
    }
    if (with_control) row.push_back(with_error(look.estimate.mean, look.half_width));
    row.emplace_back(to_string(look.verdict));
    table.add_row(std::move(row));
  }
  return table.text("  ");
}

// Of a target of several observables, each at the last look.
std::string observables_table(const std::vector<Look>& looks, const Target& target) {
  if (looks.empty() || looks.back().each.empty()) return "";
  TextTable table;
  table.add_column("at the last look", TextTable::Align::left);
  for (const char* const title : {"values", "mean ± half-width"}) table.add_column(title);
  if (target.has_tolerance()) {
    table.add_column("half-width");
    table.add_column("tolerance");
  }
  table.add_column("verdict", TextTable::Align::left);
  for (const Known& known : known_of(looks.back(), target)) {
    std::vector<std::string> row{known.look.observable, fmt::format("{}", known.look.estimate.count),
                                 with_error(known.look.estimate.mean, known.look.half_width)};
    if (target.has_tolerance()) {
      row.push_back(width_text(known));
      row.push_back(to_string(known.criterion.tolerance));
    }
    row.emplace_back(to_string(*known.look.verdict));
    table.add_row(std::move(row));
  }
  return table.text("  ");
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

// What the realisations of a point have left.
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
    Json looks = Json::array();
    for (const Look& look : summary.looks) looks.push_back(look_json(look));
    points.push_back(
        {{"label", summary.point.label},
         {"hash", summary.point.hash},
         {"verdict", summary.decided ? Json(to_string(summary.looks.back().verdict)) : Json(nullptr)},
         {"reservations", reservations(summary)},
         {"reason", reason(summary, campaign.target.target)},
         {"next", next_step(summary, campaign.target, directory)},
         {"looks", looks},
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
    text += looks_table(summary.looks, target.target);
    text += observables_table(summary.looks, target.target);
    text += prediction_text(summary);
    text += estimate_text(database, summary, target);
    text += losses_text(database, summary);
    text += attempts_text(database, summary.point.id);
    text += files_text(files_json(database, directory, summary.point.id));
    for (const KeptApart& kept : summary.kept_apart)
      text += fmt::format("  kept apart: {} results of engine {}\n", kept.results, kept.engine);
    text += fmt::format("  next: {}\n", next_step(summary, target, directory));
  }
  return text;
}

}  // namespace peclet::runner
