#include "engine/kernels/link_assembly.h"
#include "engine/kernels/link_pivots.h"
#include "engine/kernels/link_solver.h"

namespace peclet::engine {

constinit const LinkKernels baseline_link_kernels = {
    &assemble_links<double>, &leave_change<double>, &factorise, &multiply, &set_residual,
    &squared_motion,         &add_motion,           &begin,     &solve};

}  // namespace peclet::engine
