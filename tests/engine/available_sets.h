// The instruction sets that this machine can run.
#pragma once

#include <vector>

#include "engine/kernels/instruction_set.h"

namespace peclet::engine {

inline std::vector<InstructionSet> available_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace peclet::engine
