#include "engine/kernels/lanes/lane_access.h"
#include "engine/kernels/lanes/lanes_math.h"
#include "engine/kernels/pairs/pair_kernel_table.h"

namespace peclet::engine {

constinit const PairKernelTable avx512_pair_kernels = pair_kernels_of<Lanes<CompiledSet>>();

}  // namespace peclet::engine
