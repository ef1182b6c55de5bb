#include "engine/kernels/lanes/lane_access.h"
#include "engine/kernels/lanes/lanes_math.h"
#include "engine/kernels/links/link_assembly.h"
#include "engine/kernels/links/link_blocks.h"
#include "engine/kernels/links/link_solver.h"

namespace peclet::engine {

constinit const LinkKernels avx512_link_kernels = {&assemble_links<Lanes<CompiledSet>>,
                                                   &invert_blocks,
                                                   &multiply,
                                                   &set_residual,
                                                   &squared_motion,
                                                   &add_motion,
                                                   &squared_norm,
                                                   &solve};

}  // namespace peclet::engine
