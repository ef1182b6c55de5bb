// A vector in memory: four doubles, the fourth always zero.
#pragma once

namespace peclet::engine {

typedef double Row __attribute__((vector_size(32)));

}  // namespace peclet::engine
