// Which of the compiled kernels runs.
#pragma once

#include "engine/kernels/link_kernels.h"
#include "engine/kernels/one_body_kernels.h"
#include "engine/kernels/pair_kernels.h"

namespace peclet::engine {

enum class InstructionSet { baseline, avx2, avx512 };

// "baseline", "avx2", "avx512"
const char* name_of(InstructionSet set);

// Whether this build has it and this processor can run it. The baseline always can.
bool is_available(InstructionSet set);

// The widest one available; another one where PECLET_INSTRUCTION_SET names it, for tests and for comparison.
// Throws InputError when that is unknown or not available.
InstructionSet chosen_instruction_set();

PairKernel pair_kernel(InstructionSet set, const Terms& terms);  // `terms` must be valid
FillNormals fill_normals(InstructionSet set);
const OneBodyKernels& one_body_kernels(InstructionSet set);
const LinkKernels& link_kernels(InstructionSet set);

}  // namespace peclet::engine
