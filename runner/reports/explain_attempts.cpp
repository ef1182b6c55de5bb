#include "runner/reports/explain_attempts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <vector>

#include "runner/engines/engine_process.h"

namespace peclet::runner {
namespace {

// What the runner wrote down, or how the process ended.
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

std::string losses_text(Database& database, const PointSummary& point) {
  constexpr std::size_t most_seeds = 10;
  std::map<std::string, std::vector<int>> seeds;
  for (const RealisationRecord& record : database.realisations(point.point.id)) {
    const bool is_lost = record.state == SeedState::failed || record.state == SeedState::quarantined;
    if (is_lost) seeds[record.cause].push_back(record.seed);
  }
  std::string text;
  for (auto& [cause, of_cause] : seeds) {
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
