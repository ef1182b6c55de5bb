#include "runner/reports/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runner/database/file_book.h"
#include "runner/reports/explain_attempts.h"
#include "runner/reports/explain_estimate.h"
#include "runner/reports/prediction_text.h"
#include "runner/reports/status.h"
#include "runner/requests/point_name.h"
#include "runner/statistics/forecast.h"
#include "runner/statistics/look_json.h"
#include "runner/text/number_text.h"
#include "runner/text/text_table.h"

namespace peclet::runner {
namespace {

std::vector<PointSummary> selected(std::vector<PointSummary> points, const std::string& name) {
  if (name.empty()) return points;
  std::vector<PointRecord> records;
  records.reserve(points.size());
  for (const PointSummary& point : points) records.push_back(point.point);
  return {std::move(points[find_point(records, name)])};
}

// The half-width as the tolerance measures it.
std::string width_text(const Look& look, const Target& target) {
  return target.tolerance.is_relative() ? percent(relative_width(look)) : rough(look.controlled_half_width);
}

// Seeds that the tolerance would take, as the half-width falls with 1 / sqrt(n).
std::string seeds_for(const Look& look, const Target& target) {
  const double ratio = target.tolerance.share(look.controlled_half_width, look.controlled.mean);
  return std::isfinite(ratio) ? fmt::format("about {}", rough(std::ceil(look.seeds * ratio * ratio)))
                              : "more";
}

// A share of a mean that may be zero is no measure of accuracy: whatever number of seeds it led to would be
// of the mean's own noise.
bool may_be_zero(const Look& look, const Target& target) {
  return target.tolerance.is_relative() && relative_width(look) >= 1;
}

std::string advice_when_capped(const Look& look, const Target& target) {
  if (may_be_zero(look, target)) {
    return "/target/absolute_tolerance, or another /target/observable: the interval contains zero, and as "
           "long "
           "as it does no /target/relative_tolerance below 100 % can be met, whatever the number of seeds";
  }
  return fmt::format("a larger /realisations/maximum ({} seeds) or /target/{} (`peclet set`), and run again",
                     seeds_for(look, target), key_of(target.tolerance));
}

// Why the look did not decide although its interval is narrow enough.
std::string luck_text(const Look& look, const Target& target) {
  if (!(target.tolerance.share(look.controlled_half_width, look.controlled.mean) <= 1)) return "";
  return "; the last look is within the tolerance, but perhaps by luck: were the spread as large as its "
         "seeds "
         "allow, the maximum would not do";
}

std::string earlier_look_text(const PointSummary& point) {
  if (point.earlier_look == 0) return "";
  return fmt::format(
      ": the first look that is; it decides as if the target had always been this one, and leaves out later "
      "seeds; all {} with a value give {} (± standard error)",
      point.so_far.count, with_error(point.so_far.mean, point.so_far.standard_error));
}

std::string reason(const PointSummary& point, const Target& target) {
  const std::string tolerance = to_string(target.tolerance);
  if (!point.decided) {
    return fmt::format(
        "{} of the {} seeds of the next look have ended, {}", point.wanted_ended, point.wanted,
        point.point.cancelled ? "and it gets no more" : fmt::format("{} run", point.counts.running));
  }
  const Look& look = point.looks.back();
  switch (look.verdict) {
    case Verdict::converged:
    case Verdict::converged_with_losses:
      return fmt::format("{} seeds give {}, within the tolerance of {}{}", look.seeds,
                         width_text(look, target), tolerance, earlier_look_text(point));
    case Verdict::converged_near_maximum:
      return fmt::format(
          "all {} seeds that are allowed are just about enough for the tolerance of {}, perhaps by luck: "
          "they "
          "are sure of {} only",
          look.seeds, tolerance, width_text(look, target));
    case Verdict::capped:
      return fmt::format("all {} seeds that are allowed give {}, not within the tolerance of {}", look.seeds,
                         width_text(look, target), tolerance);
    case Verdict::failed:
      return fmt::format("{} of {} seeds are lost", look.lost, look.seeds);
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
    if (point.looks.empty()) return fmt::format("the first look, at {} seeds", point.wanted);
    return fmt::format(
        "the look at {} seeds; {}{}", point.wanted,
        may_be_zero(point.looks.back(), target.target)
            ? "how many will be enough cannot be told while the interval contains zero"
            : fmt::format("{} are expected to be enough",
                          expected_seeds(point.looks, target.target, target.minimum, target.maximum)),
        luck_text(point.looks.back(), target.target));
  }
  const Look& look = point.looks.back();
  switch (look.verdict) {
    case Verdict::converged:
      if (look.transient) return "a longer /scene/duration/equilibration: see transient above";
      return "nothing; a smaller tolerance (`peclet set`) reopens it";
    case Verdict::converged_with_losses:
      return fmt::format(
          "see why seeds are lost: the mean leaves them out (states in {}){}", directory.failures().string(),
          point.counts.quarantined > 0 ? "; `peclet retry` runs those again that were given up" : "");
    case Verdict::converged_near_maximum:
      return fmt::format("a larger /realisations/maximum ({} seeds; `peclet set`), and run again",
                         seeds_for(look, target.target));
    case Verdict::capped:
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
  for (const char* const title : {"seeds", "lost", "mean ± half-width",
                                  target.tolerance.is_relative() ? "relative" : "half-width", "tolerance"}) {
    table.add_column(title);
  }
  if (with_control) table.add_column("uncontrolled");
  table.add_column("verdict", TextTable::Align::left);
  for (const Look& look : looks) {
    std::vector<std::string> row{fmt::format("{}", look.seeds), fmt::format("{}", look.lost),
                                 with_error(look.controlled.mean, look.controlled_half_width),
                                 width_text(look, target), to_string(target.tolerance)};
    if (with_control) row.push_back(with_error(look.estimate.mean, look.half_width));
    row.emplace_back(to_string(look.verdict));
    table.add_row(std::move(row));
  }
  return table.text("  ");
}

Json losses_json(Database& database, std::int64_t point) {
  Json losses = Json::object();
  for (const RealisationRecord& record : database.realisations(point)) {
    const bool lost = record.state == SeedState::failed || record.state == SeedState::quarantined;
    if (lost) losses[record.cause].push_back(record.seed);
  }
  return losses;
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
struct Files {
  int kept = 0, thrown_away = 0;
  std::uint64_t bytes = 0;  // of those that are kept
  std::string folder;
};

Files files_of(Database& database, const CampaignDirectory& directory, std::int64_t point) {
  Files files;
  for (const FileRecord& record : files_of_point(database.connection(), point)) {
    ++(record.kept ? files.kept : files.thrown_away);
    if (!record.kept) continue;
    files.bytes += record.file.bytes;
    files.folder = record.place(directory).parent_path().parent_path().string();
  }
  return files;
}

std::string files_text(Database& database, const CampaignDirectory& directory, std::int64_t point) {
  const Files files = files_of(database, directory, point);
  std::string text;
  if (files.kept > 0) {
    text = fmt::format("  files: {} ({:.1f} MB) in {}", files.kept, 1e-6 * static_cast<double>(files.bytes),
                       files.folder);
  }
  if (files.thrown_away > 0) {
    text +=
        fmt::format("{}{} thrown away (/keep_files)", text.empty() ? "  files: " : "; ", files.thrown_away);
  }
  return text.empty() ? "" : text + '\n';
}

Json files_json(Database& database, const CampaignDirectory& directory, std::int64_t point) {
  const Files files = files_of(database, directory, point);
  return {{"kept", files.kept},
          {"bytes", files.bytes},
          {"thrown_away", files.thrown_away},
          {"folder", files.folder.empty() ? Json(nullptr) : Json(files.folder)}};
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
         {"losses", losses_json(database, summary.point.id)},
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
    text += prediction_text(summary);
    text += estimate_text(database, summary, target);
    text += losses_text(database, summary.point.id);
    text += attempts_text(database, summary.point.id);
    text += files_text(database, directory, summary.point.id);
    for (const KeptApart& kept : summary.kept_apart) {
      text += fmt::format("  kept apart: {} results of engine {}\n", kept.results, kept.engine);
    }
    text += fmt::format("  next: {}\n", next_step(summary, target, directory));
  }
  return text;
}

}  // namespace peclet::runner
