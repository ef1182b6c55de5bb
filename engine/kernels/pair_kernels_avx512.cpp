#include "engine/kernels/lane_access.h"
#include "engine/kernels/lanes_math.h"
#include "engine/kernels/pair_kernel.h"

namespace peclet::engine {

namespace {
struct Avx512 {
  static constexpr int width = 8;
};
}  // namespace

constinit const PairKernelTable avx512_pair_kernels = pair_kernels_of<Lanes<Avx512>>();

}  // namespace peclet::engine
