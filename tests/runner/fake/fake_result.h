// Provenance of the fake engine, and the result that it makes of its last state.
#pragma once

#include <cstdint>

#include "contract/json.h"

namespace peclet::fake {

Json engine();

struct State {
  std::uint64_t value = 0;
  int step = 0;
};

// Returns the result without its cost; with `blown_up`, the verdict of a blow-up, without a number.
Json outcome(const Json& job, const State& state, bool blown_up);

}  // namespace peclet::fake
