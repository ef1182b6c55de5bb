// The instruction sets that this machine can run.
#pragma once

#include <iostream>
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

// Returns the available sets beside the baseline; prints the others.
inline std::vector<InstructionSet> newer_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (is_available(set)) {
      sets.push_back(set);
    } else {
      std::cout << "this processor has no " << name_of(set) << '\n';
    }
  }
  return sets;
}

}  // namespace peclet::engine
