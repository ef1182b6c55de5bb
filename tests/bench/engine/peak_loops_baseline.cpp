#include "tests/bench/engine/peak_loops.h"

namespace peclet::engine {

constinit const PeakLoops baseline_peak_loops = peak_loops_of<double>();

}  // namespace peclet::engine
