#include "engine/benchmark/peak_loops.h"
#include "engine/kernels/lane_access.h"

namespace peclet::engine {

namespace {
struct Avx512 {
  static constexpr int width = 8;
};
}  // namespace

constinit const PeakLoops avx512_peak_loops = peak_loops_of<Lanes<Avx512>>();

}  // namespace peclet::engine
