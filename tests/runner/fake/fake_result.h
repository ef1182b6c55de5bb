// What the fake engine says of itself, and the result that it makes of its last state.
#pragma once

#include <cstdint>

#include "contract/json.h"

namespace peclet::fake {

Json engine();

struct State {
  std::uint64_t value = 0;
  int step = 0;
};

// Without its cost. `blown_up`: the verdict of a blow-up, without a number.
Json outcome(const Json& job, const State& state, bool blown_up);

}  // namespace peclet::fake
