#include "engine/benchmark/peak_loops.h"
#include "engine/kernels/lane_access.h"

namespace peclet::engine {

namespace {
struct Avx2 {
  static constexpr int width = 4;
};
}  // namespace

constinit const PeakLoops avx2_peak_loops = peak_loops_of<Lanes<Avx2>>();

}  // namespace peclet::engine
