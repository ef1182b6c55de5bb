#include "engine/kernels/lanes/lane_access.h"
#include "engine/kernels/lanes/lanes_math.h"
#include "engine/kernels/links/link_assembly.h"
#include "engine/kernels/links/link_pivots.h"
#include "engine/kernels/links/link_solver.h"

namespace peclet::engine {

constinit const LinkKernels avx512_link_kernels = {&assemble_links<Lanes<CompiledSet>>,
                                                   &leave_change<Lanes<CompiledSet>>,
                                                   &factorise,
                                                   &multiply,
                                                   &set_residual,
                                                   &squared_motion,
                                                   &add_motion,
                                                   &begin,
                                                   &solve};

}  // namespace peclet::engine
