// What the machine gives, measured: the roof under which the kernels work.
#pragma once

#include "engine/kernels/instruction_set.h"

namespace peclet::engine {

// Of one thread, per second.
struct Machine {
  double products_and_sums;  // multiplications and additions, each counted
  double quotients;
  double roots;
  double bytes;  // of a = b + s c over arrays far beyond the caches: both reads, the write and its fetch
  double single_products_and_sums;
};

// Takes a second or two.
Machine measure_machine(InstructionSet set);

// Bytes of a = b + s c per second, where the three arrays take `room` bytes together.
double stream_rate(InstructionSet set, std::size_t room);

}  // namespace peclet::engine
