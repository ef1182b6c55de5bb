// The measured peak rates of the machine, an upper bound for the kernels.
#pragma once

#include "engine/kernels/instruction_set.h"

namespace peclet::engine {

// Rates of one thread [1/s].
struct Machine {
  double products_and_sums;  // multiplications and additions, each counted
  double quotients;
  double roots;
  double bytes;  // by a = b + s c in arrays far larger than the caches: reads, write and its fetch
  double single_products_and_sums;
};

// Takes a second or two.
Machine measure_machine(InstructionSet set);

// Returns bytes per second of a = b + s c, with three arrays of `room` bytes together.
double stream_rate(InstructionSet set, std::size_t room);

}  // namespace peclet::engine
