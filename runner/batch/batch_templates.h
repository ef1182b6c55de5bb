// The templates of templates/, compiled in.
#pragma once

#include "runner/batch/batch_system.h"

namespace peclet::runner {

BatchTemplate slurm_template();

}  // namespace peclet::runner
