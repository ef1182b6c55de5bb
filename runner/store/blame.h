// Judges how processes and attempts ended, and from a seed's attempts whether it is tried again or given up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "contract/json.h"

namespace peclet::runner {

struct ExitStatus {
  std::optional<int> status;  // argument of exit()
  std::optional<int> signal;  // signal that killed it
};

// Returns "exit status 3" or "signal 11 (Segmentation fault)".
std::string to_string(const ExitStatus& ending);
// Converts what waitpid(2) says about a process that has ended.
ExitStatus exit_status(int wait_status);

// End of an attempt. Faults of the engine count against the seed, if it was the only one in the engine:
//   crashed    a fatal signal of its own, or an exit without being asked to
//   hung       no new step during a lease
//   garbled    an invalid message or result
//   refused    it says that it cannot run the job
// Other ends do not count: drained, killed (from outside), abandoned (its owner died).
enum class AttemptOutcome { running, result, crashed, hung, garbled, refused, drained, killed, abandoned };
const char* to_string(AttemptOutcome outcome);
AttemptOutcome attempt_outcome(const std::string& text);
bool is_blamed(AttemptOutcome outcome);

// Returns the outcome of an attempt whose process ended in the middle of a job without being asked to.
AttemptOutcome outcome_of(const ExitStatus& ending);

struct PastAttempt {
  AttemptOutcome outcome;
  std::int64_t step;        // last step reported
  bool in_company = false;  // its engine died, and any of its seeds may have done it
  // True if the attempt counts against its seed.
  bool blamed() const { return is_blamed(outcome) && !in_company; }
};

struct SeedFate {
  bool quarantine = false;
  std::string cause{};  // cause of the quarantine
  // The next attempt starts from the beginning, because the checkpoint may be at fault.
  bool discard_checkpoint = false;
};

// Returns what becomes of a seed. `attempts` are in order of time, the one that has just ended last. A seed
// may be blamed `retries` times beyond the first. Kills from outside are not blamed, but 20 of them without a
// new step end the seed, too: the kernel kills a realisation that does not fit into memory each time.
SeedFate judge(std::span<const PastAttempt> attempts, int retries);

// Returns how often the number of seeds in an engine is halved for a seed with these attempts, because any of
// the seeds in an engine that died may have done it: once for each such death, and once for every two kills
// from outside without a new step. So the one that does it is soon alone, and only then blamed. A seed that
// is blamed for the death of its engine stays alone.
int halvings(std::span<const PastAttempt> attempts);
// Returns the most seeds that an engine of this capacity may have together with a seed of these halvings,
// itself included.
inline int largest_company(int capacity, int halvings) {
  return halvings > 30 ? 1 : std::max(1, capacity >> halvings);
}

struct AttemptEnd {
  AttemptOutcome outcome = AttemptOutcome::result;
  std::int64_t step = 0;
  ExitStatus ending{};
  std::string message{};
  double held_seconds = 0;  // processor time at most [s]: wall time times threads
  // Other jobs of an engine that died; which of them is at fault is not known.
  int company = 0;
  // True if the attempt counts against its seed.
  bool blamed() const { return company == 0 && is_blamed(outcome); }
};

// End of an attempt at a seed on a node.
struct AttemptReport : AttemptEnd {
  std::string host{}, started_at{};
  std::int64_t process = 0;
  Json engine{};  // provenance of the engine
};

}  // namespace peclet::runner
