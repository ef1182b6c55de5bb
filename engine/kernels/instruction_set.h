// Chooses the instruction set of the kernels.
#pragma once

#include "engine/kernels/link_kernels.h"
#include "engine/kernels/one_body_kernels.h"
#include "engine/kernels/pair_kernels.h"

namespace peclet::engine {

enum class InstructionSet { baseline, avx2, avx512 };

const char* name_of(InstructionSet set);

// True if this build contains the set and this processor can run it; always true for the baseline.
bool is_available(InstructionSet set);

// Returns the widest set available, or the one that PECLET_INSTRUCTION_SET names, for tests and comparisons.
// Throws InputError if that is unknown or not available.
InstructionSet chosen_instruction_set();

// True if PECLET_INSTRUCTION_SET is "emulated": `peclet-engine forces` then uses the kernels for cards, which
// the processor emulates. Runs do not know that name.
bool emulated_card_is_chosen();

PairKernel pair_kernel(InstructionSet set, const Terms& terms);  // `terms` must be valid
FillNormals fill_normals(InstructionSet set);
const OneBodyKernels& one_body_kernels(InstructionSet set);
const LinkKernels& link_kernels(InstructionSet set);

}  // namespace peclet::engine
