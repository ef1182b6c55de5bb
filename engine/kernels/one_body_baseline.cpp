#include "engine/kernels/one_body.h"

namespace peclet::engine {

constinit const OneBodyKernels baseline_one_body_kernels = {&kick, &kick_and_drift<false>, &set_drag,
                                                            &kick_and_drift<true>};

}  // namespace peclet::engine
