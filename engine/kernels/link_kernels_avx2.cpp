#include "engine/kernels/lane_access.h"
#include "engine/kernels/lanes.h"
#include "engine/kernels/link_assembly.h"
#include "engine/kernels/link_pivots.h"
#include "engine/kernels/link_solver.h"

namespace peclet::engine {

constinit const LinkKernels avx2_link_kernels = {&assemble_links<Lanes<CompiledSet>>,
                                                 &leave_change<Lanes<CompiledSet>>,
                                                 &factorise,
                                                 &multiply,
                                                 &set_residual,
                                                 &squared_motion,
                                                 &add_motion,
                                                 &begin,
                                                 &solve};

}  // namespace peclet::engine
