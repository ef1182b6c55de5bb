#include "engine/kernels/links/link_assembly.h"
#include "engine/kernels/links/link_blocks.h"
#include "engine/kernels/links/link_solver.h"

namespace peclet::engine {

constinit const LinkKernels baseline_link_kernels = {&assemble_links<double>, &invert_blocks,  &multiply,
                                                     &set_residual,           &squared_motion, &add_motion,
                                                     &squared_norm,           &solve};

}  // namespace peclet::engine
