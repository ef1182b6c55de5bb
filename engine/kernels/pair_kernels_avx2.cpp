#include "engine/kernels/lane_access.h"
#include "engine/kernels/lanes_math.h"
#include "engine/kernels/pair_kernel.h"

namespace peclet::engine {

namespace {
struct Avx2 {
  static constexpr int width = 4;
};
}  // namespace

constinit const PairKernelTable avx2_pair_kernels = pair_kernels_of<Lanes<Avx2>>();

}  // namespace peclet::engine
