// How processes and attempts at seeds ended, and what a seed's history of attempts means for it: try again,
// or give it up.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "contract/json.h"

namespace peclet::runner {

// How a process ended.
struct ExitStatus {
  std::optional<int> status;  // of exit()
  std::optional<int> signal;  // that killed it
};

// "exit status 3", "signal 11 (Segmentation fault)"
std::string to_string(const ExitStatus& ending);
// Of what waitpid(2) says about a process that has ended.
ExitStatus exit_status(int wait_status);

// How an attempt ended. The engine's own doing counts against the seed: crashed (a fatal signal of its own,
// any exit that nobody asked for), hung (no new step during a lease), garbled (said what is no message or no
// result), refused (said that it cannot run the job). What others did costs nothing: drained, killed (from
// outside), abandoned (its owner died).
enum class AttemptOutcome { running, result, crashed, hung, garbled, refused, drained, killed, abandoned };
const char* to_string(AttemptOutcome outcome);
AttemptOutcome attempt_outcome(const std::string& text);
bool is_blamed(AttemptOutcome outcome);

// Of a process that ended in the middle of a job without being asked to.
AttemptOutcome outcome_of(const ExitStatus& ending);

struct PastAttempt {
  AttemptOutcome outcome;
  std::int64_t step;  // the last one it reported
};

struct SeedFate {
  bool quarantine = false;
  std::string cause{};  // of the quarantine
  bool discard_checkpoint =
      false;  // start from the beginning the next time: the checkpoint may be what is wrong
};

// `attempts` in order of time, the one that has just ended last. A seed may be blamed `retries` times beyond
// the first. Kills from outside cost nothing, but 20 in a row without a new step between them (the kernel's
// answer to a realisation that does not fit into memory looks like that) end it all the same.
SeedFate judge(std::span<const PastAttempt> attempts, int retries);

struct AttemptEnd {
  AttemptOutcome outcome = AttemptOutcome::result;
  std::int64_t step = 0;
  ExitStatus ending{};
  std::string message{};
  double held_seconds = 0;  // processor time at most: that it lasted, times its threads
};

// How an attempt at a seed went on a node.
struct AttemptReport : AttemptEnd {
  std::string host{}, started_at{};
  std::int64_t process = 0;
  Json engine{};  // provenance
};

}  // namespace peclet::runner
