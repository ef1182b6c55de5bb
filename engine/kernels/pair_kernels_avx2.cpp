#include "engine/kernels/lane_access.h"
#include "engine/kernels/lanes.h"
#include "engine/kernels/pair_kernel.h"

namespace peclet::engine {

constinit const PairKernelTable avx2_pair_kernels = pair_kernels_of<Lanes<CompiledSet>>();

}  // namespace peclet::engine
