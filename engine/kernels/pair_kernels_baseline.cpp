#include "engine/kernels/pair_kernel.h"

namespace peclet::engine {

constinit const PairKernelTable baseline_pair_kernels = pair_kernels_of<double>();

}  // namespace peclet::engine
