// How an attempt at a seed went on a node.
#pragma once

#include <cstdint>
#include <string>

#include "contract/json.h"
#include "runner/engines/blame.h"

namespace peclet::runner {

struct AttemptReport {
  AttemptOutcome outcome = AttemptOutcome::running;
  std::int64_t step = 0;
  ExitStatus ending{};
  std::string message{}, host{}, started_at{};
  std::int64_t process = 0;
  Json engine{};  // provenance
};

}  // namespace peclet::runner
