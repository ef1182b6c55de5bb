#include "engine/kernels/lane_access.h"
#include "tests/bench/engine/peak_loops.h"

namespace peclet::engine {

constinit const PeakLoops avx512_peak_loops = peak_loops_of<Lanes<CompiledSet>>();

}  // namespace peclet::engine
