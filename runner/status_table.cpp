// How `status` looks to a person.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/number_text.h"
#include "runner/status.h"
#include "runner/text_table.h"

namespace peclet::runner {
namespace {

std::string relative_width(double half_width, double mean) { return percent(half_width / std::abs(mean)); }

std::string interval(double mean, double half_width) {
  if (!std::isfinite(half_width)) return "-";
  return fmt::format("{} ({})", with_error(mean, half_width), relative_width(half_width, mean));
}

// Columns that would say nothing are left out, so that the rest fits on a terminal.
struct Shown {
  bool lost = false, controlled = false;
};

Shown worth_showing(const CampaignStatus& status) {
  Shown shown;
  for (const PointSummary& point : status.points) {
    shown.lost = shown.lost || point.lost() > 0;
    for (const Look& look : point.looks) {
      shown.controlled = shown.controlled || look.controlled.mean != look.estimate.mean;
    }
  }
  return shown;
}

std::vector<std::string> row(const PointSummary& point, Shown shown) {
  const Look none{0,
                  0,
                  {0, std::nan(""), std::nan("")},
                  std::nan(""),
                  {0, std::nan(""), std::nan("")},
                  std::nan(""),
                  Verdict::more};
  const Look& look = point.looks.empty() ? none : point.looks.back();
  std::vector<std::string> cells{point.point.label, fmt::format("{}/{}", point.wanted_ended, point.wanted)};
  if (shown.lost) cells.push_back(fmt::format("{}", point.lost()));
  cells.push_back(with_error(point.so_far.mean, point.so_far.standard_error));
  cells.push_back(interval(look.estimate.mean, look.half_width));
  if (shown.controlled) {
    cells.push_back(look.seeds == 0 ? "-" : with_error(look.controlled.mean, look.controlled_half_width));
  }
  cells.push_back(verdict_text(point));
  return cells;
}

std::string heading(const CampaignStatus& status) {
  const TargetRecord& target = status.campaign.target;
  return fmt::format("{}: {} to {:g} % at {:g} % confidence, {} to {} seeds a point\n\n",
                     status.campaign.name, target.target.observable, 100 * target.target.relative_tolerance,
                     100 * target.target.confidence, target.minimum, target.maximum);
}

std::string legend(const CampaignStatus& status, Shown shown) {
  return fmt::format(
      "so far: mean ± standard error of all seeds that have ended; look: mean ± half-width of the\n"
      "{:g} % interval at the last look{}\n",
      100 * status.campaign.target.target.confidence,
      shown.controlled ? "; controlled: the same with the control variate" : "");
}

std::string point_totals(const CampaignStatus& status) {
  int open = 0;
  std::map<std::string, int> decided;
  for (const PointSummary& point : status.points) {
    if (point.decided) {
      ++decided[to_string(point.looks.back().verdict)];
    } else {
      ++open;
    }
  }
  std::string text = fmt::format("points: {}", status.points.size());
  for (const auto& [verdict, count] : decided) text += fmt::format(", {} {}", count, verdict);
  if (open > 0) text += fmt::format(", {} open", open);
  return text;
}

std::string seed_totals(const CampaignStatus& status) {
  int ended = 0, running = 0, surplus = 0;
  double cpu_seconds = 0;
  std::map<std::string, int> losses;
  for (const PointSummary& point : status.points) {
    ended += point.counts.terminal();
    running += point.counts.running;
    surplus += point.surplus();
    cpu_seconds += point.counts.cpu_seconds;
    for (const auto& [cause, count] : point.losses) losses[cause] += count;
  }
  std::string text = fmt::format("seeds: {} ended", ended);
  for (const auto& [cause, count] : losses) text += fmt::format(", {} lost ({})", count, cause);
  if (running > 0) text += fmt::format(", {} running", running);
  if (surplus > 0) text += fmt::format(", {} surplus", surplus);
  const bool short_run = cpu_seconds < 3600;
  return text + (short_run ? fmt::format("; {} CPU minutes", rough(cpu_seconds / 60))
                           : fmt::format("; {} CPU hours", rough(cpu_seconds / 3600)));
}

}  // namespace

std::string status_table(const CampaignStatus& status) {
  const Shown shown = worth_showing(status);
  TextTable table;
  table.add_column("point", TextTable::Align::left);
  table.add_column("seeds");
  if (shown.lost) table.add_column("lost");
  table.add_column("so far");
  table.add_column("look");
  if (shown.controlled) table.add_column("controlled");
  table.add_column("verdict", TextTable::Align::left);
  for (const PointSummary& point : status.points) table.add_row(row(point, shown));
  return heading(status) + table.text() + '\n' + legend(status, shown) + point_totals(status) + '\n' +
         seed_totals(status) + '\n';
}

std::string status_table(Database& database) { return status_table(read_status(database)); }

std::string workers_text(const CampaignStatus& status) {
  constexpr std::size_t most_lines = 16;
  if (!status.owner) return standing(status) == 4 ? "\nnobody runs it now; `peclet run` goes on\n" : "";
  TextTable table;
  for (const char* const title : {"worker", "point and seed", "phase", "done", "strain"}) {
    const bool is_text = std::string(title) == "point and seed" || std::string(title) == "phase";
    table.add_column(title, is_text ? TextTable::Align::left : TextTable::Align::right);
  }
  std::size_t workers = 0;
  for (const PointSummary& point : status.points) {
    for (const LeaseRecord& lease : point.leases) {
      if (++workers > most_lines) continue;
      const double done =
          lease.steps > 0 ? static_cast<double>(lease.step) / static_cast<double>(lease.steps) : std::nan("");
      table.add_row({fmt::format("{}", lease.worker),
                     fmt::format("{} seed {}", point.point.label, lease.seed), lease.phase,
                     std::isnan(done) ? "-" : fmt::format("{:.0f} %", 100 * done), rough(lease.strain)});
    }
  }
  std::string text = fmt::format("\nprocess {} runs it\n", *status.owner);
  if (workers > 0) text += table.text();
  if (workers > most_lines) text += fmt::format("and {} more\n", workers - most_lines);
  return text;
}

}  // namespace peclet::runner
