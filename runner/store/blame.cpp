#include "runner/store/blame.h"

#include <algorithm>
#include <array>
#include <csignal>

#include "contract/errors.h"

namespace peclet::runner {
namespace {

constexpr int most_kills_in_a_row = 20;

constexpr std::array names{"running", "result",  "crashed", "hung",     "garbled",
                           "refused", "drained", "killed",  "abandoned"};  // in the order of AttemptOutcome

// Counts the kills since the seed last came further than ever before.
int kills_without_progress(std::span<const PastAttempt> attempts) {
  int kills = 0;
  std::int64_t furthest = -1;
  for (const PastAttempt& attempt : attempts) {
    if (attempt.step > furthest) {
      kills = 0;
      furthest = attempt.step;
    }
    if (attempt.outcome == AttemptOutcome::killed) ++kills;
  }
  return kills;
}

}  // namespace

const char* to_string(AttemptOutcome outcome) { return names.at(static_cast<std::size_t>(outcome)); }

AttemptOutcome attempt_outcome(const std::string& text) {
  const auto known = std::ranges::find(names, text);
  if (known == names.end()) {
    throw IntegrityError("the database holds an unknown outcome of an attempt: " + text);
  }
  return static_cast<AttemptOutcome>(known - names.begin());
}

bool is_blamed(AttemptOutcome outcome) {
  return outcome == AttemptOutcome::crashed || outcome == AttemptOutcome::hung ||
         outcome == AttemptOutcome::garbled || outcome == AttemptOutcome::refused;
}

AttemptOutcome outcome_of(const ExitStatus& ending) {
  const bool from_outside = ending.signal && (*ending.signal == SIGKILL || *ending.signal == SIGTERM ||
                                              *ending.signal == SIGINT || *ending.signal == SIGHUP);
  return from_outside ? AttemptOutcome::killed : AttemptOutcome::crashed;
}

SeedFate judge(std::span<const PastAttempt> attempts, int retries) {
  if (attempts.empty()) return {};
  const auto blamed =
      std::count_if(attempts.begin(), attempts.end(), [](const PastAttempt& past) { return past.blamed(); });
  const AttemptOutcome last = attempts.back().outcome;
  const bool is_last_blamed = attempts.back().blamed();
  if (is_last_blamed && blamed > retries) return {true, to_string(last), true};
  if (last == AttemptOutcome::killed && kills_without_progress(attempts) >= most_kills_in_a_row) {
    return {true, "killed repeatedly", true};
  }
  const bool in_doubt = is_last_blamed && (blamed > 1 || last == AttemptOutcome::refused);
  return {false, "", in_doubt};
}

int halvings(std::span<const PastAttempt> attempts) {
  constexpr int until_alone = 31;
  int deaths = 0;
  for (const PastAttempt& attempt : attempts) {
    if (attempt.blamed() && attempt.outcome != AttemptOutcome::refused) return until_alone;
    if (attempt.in_company) ++deaths;
  }
  return std::min(until_alone, deaths + kills_without_progress(attempts) / 2);
}

ExitStatus exit_status(int wait_status) {
  if (WIFSIGNALED(wait_status)) return {std::nullopt, WTERMSIG(wait_status)};
  return {WEXITSTATUS(wait_status), std::nullopt};
}

std::string to_string(const ExitStatus& ending) {
  if (ending.signal) return fmt::format("signal {} ({})", *ending.signal, strsignal(*ending.signal));
  return fmt::format("exit status {}", ending.status.value_or(-1));
}

}  // namespace peclet::runner
